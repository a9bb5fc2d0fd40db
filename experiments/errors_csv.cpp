#include "experiments/errors_csv.h"

#include "core/error.h"
#include "experiments/metrics.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

namespace lockstep {

namespace fs = std::filesystem;

std::string csv_field(std::string_view text) {
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(text);
  std::string quoted = "\"";
  for (char c : text) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + '"';
}

std::string errors_csv_header() {
  std::string line = "scene,sampler,seed,spp,cpu_seconds,wall_seconds";
  for (const Metric& metric : metrics()) line += fmt::format(",{}", metric.name);
  return line;
}

std::string errors_csv_row(std::string_view scene, std::string_view sampler,
                           const Measurement& run) {
  std::string line = fmt::format("{},{},{},{},{:.6g},{:.6g}", csv_field(scene), csv_field(sampler),
                                 run.seed, run.spp, run.cpu_seconds, run.wall_seconds);
  for (double error : run.errors) line += fmt::format(",{:.9g}", error);
  return line;
}

std::string spectra_csv(const Comparison& comparison) {
  std::string text = "scene,depth,sampler,spp,frequency,power\n";
  for (const SceneComparison& scene : comparison.scenes) {
    std::vector<RunSpectrum> spectra = scene.spectra;
    std::sort(spectra.begin(), spectra.end(), [](const RunSpectrum& a, const RunSpectrum& b) {
      return std::pair(a.sampler, a.spp) < std::pair(b.sampler, b.spp);
    });
    for (const RunSpectrum& spectrum : spectra) {
      const std::string sampler =
          to_string(comparison.settings.samplers[std::size_t(spectrum.sampler)]);
      for (const SpectrumRing& ring : spectrum.mean.rings) {
        text += fmt::format("{},{},{},{},{:.7g},{:.9g}\n", csv_field(scene.scene), scene.depth,
                            csv_field(sampler), spectrum.spp, ring.frequency, ring.power);
      }
    }
  }
  return text;
}

ErrorsCsv::ErrorsCsv(const std::string& directory)
    : path_((fs::path(directory) / "errors.csv").string()) {
  std::error_code error;
  if (fs::exists(path_, error)) {
    fs::rename(path_, fs::path(directory) / "errors-previous.csv", error);
  }
  file_.open(path_);
  file_ << errors_csv_header() << std::endl;
  if (!file_) throw Error(path_ + ": cannot be written; choose another folder");
}

void ErrorsCsv::append(std::string_view scene, std::string_view sampler, const Measurement& run) {
  file_ << errors_csv_row(scene, sampler, run) << std::endl;
  if (!file_) throw Error(path_ + ": cannot be written; is the disk full?");
}

}  // namespace lockstep
