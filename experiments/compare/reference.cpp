#include "experiments/compare/reference.h"

#include "core/error.h"
#include "core/fingerprint.h"
#include "experiments/metrics/metrics.h"
#include "experiments/output/machine.h"
#include "experiments/output/output_file.h"
#include "experiments/output/render_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

namespace lockstep {
namespace {

namespace fs = std::filesystem;

constexpr int kFewestSamples = 1024;
constexpr int kSamplesPerRungSample = 100;
constexpr std::uint32_t kHalfSeeds[2] = {0x5eed'0001u, 0x5eed'0002u};  // no run uses these
constexpr double kDarkestSquare = 0.01;                                // as in relMSE

// Everything the image depends on, in one line; a scene counts with all its numbers.
std::string reference_key(const CompareSettings& settings, const SceneComparison& comparison,
                          const Scene& scene) {
  return fmt::format("scene {:016x} {}x{} depth {} roulette {} spp {} isa {} version {}",
                     scene.fingerprint(), comparison.width, comparison.height, comparison.depth,
                     settings.render.roulette_depth, reference_spp(settings),
                     name(settings.render.isa), version());
}

// Named by the key, too: references of several settings lie beside each other.
std::string reference_path(const CompareSettings& settings, const SceneComparison& comparison,
                           const Scene& scene) {
  Fingerprint print;
  for (char c : reference_key(settings, comparison, scene)) print.add(std::uint32_t(c));
  const std::string& folder =
      settings.reference_folder.empty() ? settings.directory : settings.reference_folder;
  return (fs::path(folder) / fmt::format("reference-{}-{:016x}.exr",
                                         file_name_safe(fs::path(comparison.scene).stem().string()),
                                         print.value()))
      .string();
}

// The mean of two independent images, and the relMSE that the mean has left: the squared
// difference has expectation 2 v for halves of variance v, the mean's variance is v / 2.
std::pair<Image, double> average(const Image& a, const Image& b) {
  Image mean = a;
  double sum = 0.0;
  for (std::size_t i = 0; i < mean.pixels.size(); ++i) {
    mean.pixels[i] = 0.5f * (a.pixels[i] + b.pixels[i]);
    const double d = double(a.pixels[i]) - double(b.pixels[i]);
    const double m = mean.pixels[i];
    sum += 0.25 * d * d / (m * m + kDarkestSquare);
  }
  return {std::move(mean), sum / double(mean.pixels.size())};
}

// The share of a metric's value between the two halves that is the mean's own error, whose variance
// is a quarter of that of their difference. Empty where the metric is neither an error nor its
// square.
std::optional<double> share_of_mean(const Metric& metric) {
  const std::string_view name = metric.name;
  if (!metric.lower_is_better || name.starts_with("yee")) return {};
  const bool squared = name.find("mse") != name.npos && name.find("rmse") == name.npos;
  return squared ? 0.25 : 0.5;
}

std::map<std::string, double> own_errors(const Image& a, const Image& b) {
  std::map<std::string, double> errors;
  const std::vector<double> values = evaluate_metrics(a, b);
  for (std::size_t m = 0; m < values.size(); ++m) {
    const Metric& metric = metrics()[m];
    const std::optional<double> share = share_of_mean(metric);
    if (share) errors[std::string(metric.name)] = *share * values[m];
  }
  return errors;
}

constexpr std::string_view kErrorPrefix = "reference_error_";

// What the file's header says about the image's own error.
void read_errors(const Metadata& metadata, Reference& reference) {
  const auto number = [](const std::string& text) { return std::strtod(text.c_str(), nullptr); };
  for (const auto& [key, value] : metadata) {
    if (key == "reference_relmse") reference.relmse = number(value);
    if (key.starts_with(kErrorPrefix)) {
      reference.errors[key.substr(kErrorPrefix.size())] = number(value);
    }
  }
}

Reference read_given(const CompareSettings& settings, const SceneComparison& comparison) {
  Reference reference;
  reference.file = settings.reference_file;
  reference.image = read_image(reference.file);
  const Image& image = reference.image;
  if (image.width != comparison.width || image.height != comparison.height) {
    throw Error(
        fmt::format("{}: the reference is {}x{}, the renders are {}x{}; give --resolution {}x{}",
                    reference.file, image.width, image.height, comparison.width, comparison.height,
                    image.width, image.height));
  }
  reference.origin = "given: " + reference.file;
  const Metadata metadata = read_metadata(reference.file);
  read_errors(metadata, reference);
  if (const auto depth = metadata.find("depth");
      depth != metadata.end() && depth->second != std::to_string(comparison.depth)) {
    throw Error(fmt::format(
        "{}: the reference was rendered with depth {}, the comparison has {}; give --depth {}",
        reference.file, depth->second, comparison.depth, depth->second));
  }
  return reference;
}

void write_reference(const CompareSettings& settings, const SceneComparison& comparison,
                     const Reference& reference, const std::string& key) {
  // All digits: what is read back is what was computed.
  Metadata metadata{{"reference_key", key},
                    {"reference_relmse", fmt::format("{}", *reference.relmse)},
                    {"scene", comparison.scene},
                    {"sampler", "owen"},
                    {"spp", std::to_string(reference.spp)},
                    {"depth", std::to_string(comparison.depth)},
                    {"version", std::string(version())}};
  for (const auto& [metric, error] : reference.errors) {
    metadata[std::string(kErrorPrefix) + metric] = fmt::format("{}", error);
  }
  metadata.merge(override_metadata(settings.overrides));
  write_image(reference.file, reference.image, metadata);
}

std::string rendered_origin(int spp, bool cached) {
  return fmt::format("{} owen, {} samples per pixel as two independent halves",
                     cached ? "from an earlier run:" : "rendered:", spp);
}

}  // namespace

SamplerSpec reference_sampler() { return parse_sampler("owen"); }

RenderSettings half_settings(const CompareSettings& settings, RenderSettings render_settings,
                             int half) {
  render_settings.spp = reference_spp(settings) / 2;
  render_settings.clamp.reset();  // the truth is not biased
  render_settings.seed = kHalfSeeds[half];
  return render_settings;
}

int reference_spp(const CompareSettings& settings) {
  const int longest = *std::max_element(settings.rungs.begin(), settings.rungs.end());
  const int spp = settings.reference_spp > 0
                      ? settings.reference_spp
                      : std::max(kFewestSamples, kSamplesPerRungSample * longest);
  return std::max(2, spp + spp % 2);
}

bool has_reference(const CompareSettings& settings, const SceneComparison& comparison,
                   const Scene& scene) {
  if (!settings.reference_file.empty()) return true;
  const std::string path = reference_path(settings, comparison, scene);
  if (!fs::exists(path)) return false;
  const Metadata metadata = read_metadata(path);
  const auto key = metadata.find("reference_key");
  return key != metadata.end() && key->second == reference_key(settings, comparison, scene);
}

Reference make_reference(const CompareSettings& settings, const SceneComparison& comparison,
                         const Scene& scene, RenderSettings render_settings,
                         const Progress& progress, const RenderHalf& render_half) {
  if (!settings.reference_file.empty()) return read_given(settings, comparison);

  Reference reference;
  reference.file = reference_path(settings, comparison, scene);
  reference.spp = reference_spp(settings);
  const bool cached = has_reference(settings, comparison, scene);
  reference.origin = rendered_origin(reference.spp, cached);
  if (cached) {
    reference.image = read_image(reference.file);
    read_errors(read_metadata(reference.file), reference);
    return reference;
  }

  Image halves[2];
  const auto state_file = [&](int half) {
    return fmt::format("{}.half{}.state", reference.file, half);
  };
  for (int half = 0; half < 2; ++half) {
    RenderSettings own = half_settings(settings, render_settings, half);
    own.resume_file = state_file(half);
    const SamplerSpec sampler = reference_sampler();
    own.scene_name = comparison.scene;
    own.command = render_command(comparison.scene, sampler, own, comparison.width,
                                 comparison.height, override_metadata(settings.overrides));
    const auto show = [&](double f) { return !progress || progress(0.5 * (half + f)); };
    halves[half] = (render_half ? render_half(scene, sampler, own, half, show)
                                : render(scene, sampler, own, show))
                       .image;
  }
  auto [image, relmse] = average(halves[0], halves[1]);
  reference.image = std::move(image);
  reference.relmse = relmse;
  reference.errors = own_errors(halves[0], halves[1]);
  write_reference(settings, comparison, reference, reference_key(settings, comparison, scene));
  std::error_code ignored;
  for (int half : {0, 1}) fs::remove(state_file(half), ignored);
  return reference;
}

std::uint64_t content_fingerprint(const Image& image) {
  Fingerprint print;
  print.add(std::int32_t(image.width));
  print.add_all(image.pixels);
  return print.value();
}

}  // namespace lockstep
