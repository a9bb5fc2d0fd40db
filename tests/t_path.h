// Scenes of known radiance for tests of the path integrator: a box whose walls shine, and a floor
// under lamps.
#pragma once

#include "tests/t_images.h"

#include <cmath>
#include <numbers>
#include <utility>

namespace lockstep {

struct PathPlan {
  const char* sampler = "random";
  int spp = 16;
  int depth = 1;
  int roulette_depth = 100;
  int seeds = 32;
};

// One channel's image mean, one entry per seed.
inline Moments channel_means(const Scene& scene, const PathPlan& plan, int channel = 0) {
  Moments m;
  RenderSettings s;
  s.spp = plan.spp;
  s.depth = plan.depth;
  s.roulette_depth = plan.roulette_depth;
  s.threads = 2;
  for (int seed = 0; seed < plan.seeds; ++seed) {
    s.seed = std::uint32_t(seed);
    m.add(channel_mean(render(scene, parse_sampler(plan.sampler), s).image, channel));
  }
  return m;
}

// Edges of the box are of unequal length. Walls face inwards.
inline SceneDescription closed_box(float emission, float albedo, bool split_walls = false) {
  SceneDescription d;
  d.name = "closed box";
  const int wall = builtin::add_material(d, DiffuseMaterial{glm::vec3(albedo)});
  const Emission light{glm::vec3(emission)};
  const glm::vec3 x(1, 0, 0), y(0, 1.5f, 0), z(0, 0, 2);
  builtin::add_rectangle(d, -x, y, z, wall, light);
  builtin::add_rectangle(d, x, z, y, wall, light);
  builtin::add_rectangle(d, -y, z, x, wall, light);
  builtin::add_rectangle(d, y, x, z, wall, light);
  builtin::add_rectangle(d, -z, x, y, wall, light);
  builtin::add_rectangle(d, z, y, x, wall, light);
  if (split_walls) {  // a rectangle's halves as meshes of their own: triangular lights
    const std::size_t n = d.shapes.size();
    for (std::size_t i = 0; i < n; ++i) {
      Shape half = d.shapes[i];
      auto& mesh = std::get<TriangleMesh>(half.geometry);
      mesh.triangles.erase(mesh.triangles.begin());
      std::get<TriangleMesh>(d.shapes[i].geometry).triangles.pop_back();
      d.shapes.push_back(half);
    }
  }
  d.camera.camera_to_world = builtin::look_at({0.2f, -0.3f, 0.1f}, {1, 1, 1});
  d.camera.fov_degrees = 100.0f;
  d.film.width = d.film.height = 16;
  return d;
}

inline constexpr float floor_albedo = 0.6f;

// A floor in y = 0, of which the camera sees the origin, from the side.
inline SceneDescription lit_floor(
    const Material& material = DiffuseMaterial{glm::vec3(floor_albedo)}, glm::vec3 eye = {3, 2, 1},
    float half_size = 50) {
  SceneDescription d;
  d.name = "floor";
  builtin::add_rectangle(d, {0, 0, 0}, {0, 0, half_size}, {half_size, 0, 0},
                         builtin::add_material(d, material));
  look_closely(d, eye, {0, 0, 0});
  return d;
}

inline int lamp(SceneDescription& d) {
  return builtin::add_material(d, DiffuseMaterial{glm::vec3(0.0f)});
}

// A lamp of half sizes a and b at height h over the origin, facing down.
inline void add_lamp(SceneDescription& d, float a, float b, float h, Emission emission) {
  builtin::add_rectangle(d, {0, h, 0}, {a, 0, 0}, {0, 0, b}, lamp(d), emission);
}

// Form factor from a point to a parallel rectangle of half sizes a and b, centred h above it: four
// times that of the quarter with a corner above the point (Howell, catalogue of configuration
// factors, B-3).
inline double rectangle_form_factor(double a, double b, double h) {
  const double x = a / h, y = b / h, sx = std::sqrt(1 + x * x), sy = std::sqrt(1 + y * y);
  return 4.0 / (2.0 * std::numbers::pi) * (x / sx * std::atan(y / sx) + y / sy * std::atan(x / sy));
}

}  // namespace lockstep
