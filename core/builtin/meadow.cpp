// The scene without a lamp: rolling hills, bushes and boulders under a bright even sky.
#include "core/builtin/noise.h"
#include "core/builtin/parts.h"
#include "core/builtin/scenes.h"

#include <array>
#include <cmath>
#include <utility>

namespace lockstep::builtin {
namespace {

float hill_height(float x, float z) {
  const glm::vec3 p(x, 0.0f, z);
  const float hills = 1.6f * noise(0.13f * p + glm::vec3(0.4f, 2.5f, 0.1f));
  const float rise = 0.012f * z * z * (z < 0.0f ? 1.0f : 0.0f);  // the far side stands up
  return hills + rise + 0.08f * fractal_noise(0.9f * p + glm::vec3(0, 6.5f, 0), 4);
}

// Rounded tops between creases that are narrow, but not infinitely steep.
float bulge(glm::vec3 p) {
  const float n = noise(p);
  return std::pow(n * n + 0.002f, 0.25f);
}

// Foliage as clumps on clumps.
TriangleMesh bush(unsigned seed, int levels) {
  TriangleMesh mesh = icosphere(levels);
  const glm::vec3 origin(50.0f * random_number(seed), 50.0f * random_number(seed + 1), 0.5f);
  displace(mesh, [origin](glm::vec3 p) {
    const glm::vec3 q = p + 0.1f * fractal_noise(5.0f * p - origin, 2);
    const float clumps = bulge(2.4f * q + origin);
    const float leaves = bulge(6.5f * q + origin);
    return 0.60f + 0.42f * clumps + 0.20f * leaves;
  });
  return mesh;
}

TriangleMesh boulder(unsigned seed) {
  TriangleMesh mesh = icosphere(4);
  const glm::vec3 origin(50.0f * random_number(seed), 0.2f, 50.0f * random_number(seed + 1));
  displace(mesh, [origin](glm::vec3 p) {
    return 0.85f + 0.25f * noise(1.2f * p + origin) + 0.12f * ridges(2.0f * p + origin, 4);
  });
  return mesh;
}

}  // namespace

SceneDescription make_meadow() {
  SceneDescription scene;
  scene.name = "meadow";
  scene.environment = glm::vec3(0.75f, 0.92f, 1.1f);
  const int grass = add_material(scene, DiffuseMaterial{glm::vec3(0.30f, 0.38f, 0.12f)});
  const int rock = add_material(scene, DiffuseMaterial{glm::vec3(0.46f, 0.43f, 0.40f)});
  const std::array greens{add_material(scene, DiffuseMaterial{glm::vec3(0.12f, 0.26f, 0.07f)}),
                          add_material(scene, DiffuseMaterial{glm::vec3(0.20f, 0.30f, 0.06f)}),
                          add_material(scene, DiffuseMaterial{glm::vec3(0.42f, 0.24f, 0.06f)})};
  add_mesh(scene, terrain(240, 16.0f, hill_height), grass);

  // Bushes and boulders on a jittered grid, so that they crowd nowhere.
  unsigned index = 0;
  for (int row = 0; row < 7; ++row) {
    for (int column = 0; column < 8; ++column, ++index) {
      const auto random = [index](unsigned i) { return random_number(8 * index + i); };
      const float x = 2.6f * (float(column) - 3.5f) + 1.9f * (random(0) - 0.5f);
      const float z = 2.2f * (float(row) - 5.0f) + 1.6f * (random(1) - 0.5f);
      const bool is_rock = random(2) < 0.3f;
      const float size = is_rock ? 0.25f + 0.45f * random(3) : 0.45f + 0.65f * random(3);
      TriangleMesh mesh =
          is_rock ? boulder(1000 + 2 * index) : bush(2000 + 2 * index, row < 4 ? 4 : 5);
      place(mesh, {x, hill_height(x, z) + (is_rock ? 0.2f : 0.6f) * size, z},
            size * glm::vec3(1.1f, is_rock ? 0.8f : 1.0f + 0.5f * random(4), 1.0f),
            360.0f * random(5));
      add_mesh(scene, std::move(mesh),
               is_rock ? rock
                       : greens[random(6) < 0.45f   ? 0
                                : random(6) < 0.85f ? 1
                                                    : 2]);
    }
  }

  scene.camera.camera_to_world = look_at({0, 4.2f, 9.5f}, {0, 0.6f, -2.5f});
  scene.camera.fov_degrees = 40.0f;
  scene.film.width = 640;
  scene.film.height = 427;
  scene.defaults = {64, 4};
  return scene;
}

}  // namespace lockstep::builtin
