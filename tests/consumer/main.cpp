// consumer SAMPLER OUTPUT: renders the built-in scene cornell with 16 samples per pixel, writes the
// image, and prints the mean radiance and the error against another render of four times as many.
#include "core/error.h"
#include "core/image.h"
#include "core/read_scene.h"
#include "experiments/metrics/metrics.h"
#include "packets/render.h"

#include <cstdio>
#include <exception>

namespace {

double mean(const lockstep::Image& image) {
  double sum = 0.0;
  for (const float value : image.pixels) sum += double(value);
  return sum / double(image.pixels.size());
}

void run(const char* sampler_text, const char* output) {
  const lockstep::SamplerSpec sampler = lockstep::parse_sampler(sampler_text);
  lockstep::SceneDescription description = lockstep::read_scene("cornell");
  description.film.width = 48;
  description.film.height = 48;

  lockstep::RenderSettings settings;
  settings.spp = 16;
  settings.threads = 1;
  settings.depth = 3;
  const lockstep::Scene scene(description, lockstep::embree_isa(settings.isa));
  const lockstep::RenderResult result = lockstep::render(scene, sampler, settings);
  lockstep::write_image(output, result.image, {{"sampler", lockstep::to_string(sampler)}});

  settings.spp = 64;
  settings.seed = 1;
  const lockstep::RenderResult reference = lockstep::render(scene, sampler, settings);
  const std::vector<double> errors =
      lockstep::evaluate_metrics(reference.image, result.image, "64 spp", output);
  std::printf("mean %.4f\n", mean(result.image));
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const std::string_view name = lockstep::metrics()[i].name;
    std::printf("%.*s %.4g\n", int(name.size()), name.data(), errors[i]);
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: consumer SAMPLER OUTPUT\n");
    return 2;
  }
  try {
    run(argv[1], argv[2]);
    return 0;
  } catch (const lockstep::UsageError& error) {
    std::fprintf(stderr, "consumer: %s\n", error.what());
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "consumer: %s\n", error.what());
    return 1;
  }
}
