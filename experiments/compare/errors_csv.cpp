#include "experiments/compare/errors_csv.h"

#include "experiments/metrics/metrics.h"

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
  return line + ",depth,pilot_spp,mean_weight,lanes,lanes_active,nonfinite,width,threads,cpu";
}

std::string errors_csv_row(std::string_view scene, int depth, std::string_view sampler,
                           const Measurement& run) {
  std::string line = fmt::format("{},{},{},{},{},{}", csv_field(scene), csv_field(sampler),
                                 run.seed, run.spp, run.cpu_seconds, run.wall_seconds);
  for (double error : run.errors) line += fmt::format(",{}", error);
  return line + fmt::format(",{},{},{},{},{},{},{},{},{}", depth, run.pilot_spp, run.mean_weight,
                            to_string(run.lanes), run.lanes_active, run.nonfinite, run.packet_width,
                            run.threads, csv_field(run.cpu));
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

ErrorsCsv::ErrorsCsv(const std::string& directory, std::string_view rows)
    : file_([&] {
        const std::string path = (fs::path(directory) / "errors.csv").string();
        write_text_file(path, errors_csv_header() + '\n' + std::string(rows));
        return path;
      }()) {}

void ErrorsCsv::append(std::string_view scene, int depth, std::string_view sampler,
                       const Measurement& run) {
  file_.append(errors_csv_row(scene, depth, sampler, run) + '\n');
}

}  // namespace lockstep
