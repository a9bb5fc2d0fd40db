// Renders without the experiments, and prints the mean radiance.
#include "core/read_scene.h"
#include "packets/render.h"

#include <cstdio>

int main() {
  lockstep::SceneDescription description = lockstep::read_scene("cornell");
  description.film.width = description.film.height = 16;
  lockstep::RenderSettings settings;
  settings.spp = 4;
  const lockstep::Scene scene(description, lockstep::embree_isa(settings.isa));
  const auto result = lockstep::render(scene, lockstep::parse_sampler("owen"), settings);
  double sum = 0.0;
  for (const float value : result.image.pixels) sum += double(value);
  std::printf("%.3f\n", sum / double(result.image.pixels.size()));
}
