#include "experiments/reference.h"

#include "core/error.h"
#include "experiments/machine.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

namespace lockstep {
namespace {

namespace fs = std::filesystem;

constexpr int kFewestSamples = 1024;
constexpr int kSamplesPerRungSample = 16;
constexpr std::uint32_t kHalfSeeds[2] = {0x5eed'0001u, 0x5eed'0002u};  // no run uses these
constexpr double kDarkest = 0.01;                                      // as in relMSE

std::string reference_path(const CompareSettings& settings, const SceneComparison& comparison) {
  return (fs::path(settings.directory) / fmt::format("reference-{}.exr", comparison.label))
      .string();
}

// Everything the image depends on, in one line; a scene file counts with its size and age.
std::string reference_key(const CompareSettings& settings, const SceneComparison& comparison,
                          const Scene& scene) {
  return fmt::format("scene {:016x} {}x{} depth {} roulette {} spp {} isa {} version {}",
                     scene.fingerprint(), comparison.width, comparison.height, comparison.depth,
                     settings.render.roulette_depth, reference_spp(settings),
                     name(settings.render.isa), version());
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
    sum += 0.25 * d * d / (m * m + kDarkest);
  }
  return {std::move(mean), sum / double(mean.pixels.size())};
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
  if (const auto depth = metadata.find("depth");
      depth != metadata.end() && depth->second != std::to_string(comparison.depth)) {
    throw Error(fmt::format(
        "{}: the reference was rendered with depth {}, the comparison has {}; give --depth {}",
        reference.file, depth->second, comparison.depth, depth->second));
  }
  return reference;
}

std::string rendered_origin(int spp, bool cached) {
  return fmt::format("{} owen, {} samples per pixel as two independent halves",
                     cached ? "from an earlier run:" : "rendered:", spp);
}

}  // namespace

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
  const std::string path = reference_path(settings, comparison);
  if (!fs::exists(path)) return false;
  const Metadata metadata = read_metadata(path);
  const auto key = metadata.find("reference_key");
  return key != metadata.end() && key->second == reference_key(settings, comparison, scene);
}

Reference make_reference(const CompareSettings& settings, const SceneComparison& comparison,
                         const Scene& scene, RenderSettings render_settings,
                         const Progress& progress) {
  if (!settings.reference_file.empty()) return read_given(settings, comparison);

  Reference reference;
  reference.file = reference_path(settings, comparison);
  reference.spp = reference_spp(settings);
  const bool cached = has_reference(settings, comparison, scene);
  reference.origin = rendered_origin(reference.spp, cached);
  if (cached) {
    reference.image = read_image(reference.file);
    reference.relmse = std::stod(read_metadata(reference.file).at("reference_relmse"));
    return reference;
  }

  render_settings.spp = reference.spp / 2;
  Image halves[2];
  for (int half = 0; half < 2; ++half) {
    render_settings.seed = kHalfSeeds[half];
    const auto show = [&](double f) { return !progress || progress(0.5 * (half + f)); };
    halves[half] = render(scene, parse_sampler("owen"), render_settings, show).image;
  }
  auto [image, relmse] = average(halves[0], halves[1]);
  Metadata metadata{{"reference_key", reference_key(settings, comparison, scene)},
                    {"reference_relmse", fmt::format("{:.9g}", relmse)},
                    {"scene", comparison.scene},
                    {"sampler", "owen"},
                    {"spp", std::to_string(reference.spp)},
                    {"depth", std::to_string(comparison.depth)},
                    {"version", std::string(version())}};
  metadata.merge(override_metadata(settings.overrides));
  write_image(reference.file, image, metadata);
  reference.image = std::move(image);
  reference.relmse = relmse;
  return reference;
}

}  // namespace lockstep
