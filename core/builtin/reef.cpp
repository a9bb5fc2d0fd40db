// The scene for throughput and for show: corals, sponges and stones on sand, one light above.
#include "core/builtin/branches.h"
#include "core/builtin/noise.h"
#include "core/builtin/parts.h"
#include "core/builtin/scenes.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace lockstep::builtin {
namespace {

// Meandering valleys between rounded walls, on a dome with slow swellings.
TriangleMesh brain_coral(unsigned seed, int levels) {
  TriangleMesh mesh = icosphere(levels);
  const glm::vec3 origin = 100.0f * glm::vec3(random_number(seed), random_number(seed + 1), 0.3f);
  displace(mesh, [origin](glm::vec3 p) {
    const glm::vec3 warp(noise(2.3f * p + origin), noise(2.3f * p - origin), noise(2.1f * p));
    const float valley = std::abs(noise(6.5f * (p + 0.16f * warp) + origin));
    const float wall = 1.0f - std::exp(-70.0f * valley * valley);
    return 1.0f + 0.10f * fractal_noise(1.4f * p + origin, 2) + 0.06f * wall;
  });
  return mesh;
}

TriangleMesh staghorn_coral(const BranchStyle& style, int levels) {
  TriangleMesh mesh = subdivide_loop(branches(style), levels);
  for (size_t i = 0; i < mesh.positions.size(); ++i) {
    const float bump = fractal_noise(14.0f * mesh.positions[i], 2);
    mesh.positions[i] += 0.012f * bump * mesh.normals[i];
  }
  set_smooth_normals(mesh);
  return mesh;
}

// A rounded stone with facets and pores.
TriangleMesh stone(unsigned seed, int levels) {
  TriangleMesh mesh = icosphere(levels);
  const glm::vec3 origin = 100.0f * glm::vec3(random_number(seed), 0.7f, random_number(seed + 1));
  displace(mesh, [origin](glm::vec3 p) {
    return 0.9f + 0.22f * noise(1.1f * p + origin) + 0.10f * ridges(1.7f * p + origin, 4) +
           0.03f * fractal_noise(6.0f * p + origin, 4);
  });
  return mesh;
}

// Knobs all over, evenly spread (Fibonacci lattice), as on an urchin.
TriangleMesh urchin() {
  constexpr int knobs = 260;
  std::vector<glm::vec3> tips;
  for (int i = 0; i < knobs; ++i) {
    const float y = 1.0f - 2.0f * (float(i) + 0.5f) / knobs;
    const float turn = 2.39996323f * float(i);
    const float r = std::sqrt(1.0f - y * y);
    tips.push_back({r * std::cos(turn), y, r * std::sin(turn)});
  }
  TriangleMesh mesh = icosphere(6);
  displace(mesh, [&tips](glm::vec3 p) {
    float nearest = -1.0f;
    for (const glm::vec3& tip : tips) nearest = std::max(nearest, glm::dot(tip, p));
    const float distance = std::acos(std::min(nearest, 1.0f));
    return 1.0f + 0.16f * std::exp(-std::pow(distance / 0.062f, 2.0f));
  });
  return mesh;
}

float sand_height(float x, float z) {
  const glm::vec3 p(x, 0.0f, z);
  const float bend = 1.6f * noise(0.45f * p + glm::vec3(0, 3.3f, 0));
  const float ripple = std::sin(11.0f * (0.35f * x + z) + 2.2f * bend);
  return 0.10f * noise(0.5f * p + glm::vec3(0, 8.5f, 0)) + 0.04f * ripple * (0.8f + 0.5f * bend);
}

void add_corals(SceneDescription& scene) {
  const int pink = add_material(
      scene, CoatedMaterial{glm::vec3(0.66f, 0.20f, 0.13f), glm::vec3(1), 0.25f, 1.45f, true});
  const int ochre = add_material(scene, DiffuseMaterial{glm::vec3(0.62f, 0.40f, 0.13f)});
  const int ivory = add_material(scene, DiffuseMaterial{glm::vec3(0.80f, 0.72f, 0.58f)});
  const int violet = add_material(scene, DiffuseMaterial{glm::vec3(0.30f, 0.15f, 0.42f)});

  TriangleMesh brain = brain_coral(3, 7);
  place(brain, {-1.55f, 0.55f, -0.25f}, {1.25f, 1.0f, 1.2f}, 25.0f);
  add_mesh(scene, std::move(brain), pink);
  TriangleMesh small_brain = brain_coral(11, 6);
  place(small_brain, {2.35f, 0.25f, 0.75f}, {0.62f, 0.5f, 0.6f}, 100.0f);
  add_mesh(scene, std::move(small_brain), ochre);

  TriangleMesh stag = staghorn_coral({0.62f, 0.24f, 0.74f, 0.75f, 4, 5}, 2);
  place(stag, {0.75f, 0.25f, -0.75f}, glm::vec3(1.15f), 0.0f);
  add_mesh(scene, std::move(stag), ivory);
  TriangleMesh bush = staghorn_coral({0.34f, 0.17f, 0.75f, 0.9f, 3, 77}, 2);
  place(bush, {-0.15f, 0.08f, 1.05f}, glm::vec3(0.8f), 40.0f);
  add_mesh(scene, std::move(bush), violet);
}

void add_stones(SceneDescription& scene) {
  const int slate = add_material(scene, DiffuseMaterial{glm::vec3(0.22f, 0.24f, 0.26f)});
  const int wet = add_material(
      scene, CoatedMaterial{glm::vec3(0.05f, 0.20f, 0.24f), glm::vec3(1), 0.08f, 1.5f, true});
  ConductorMaterial gold;
  gold.eta = glm::vec3(0.18f, 0.42f, 1.37f);
  gold.k = glm::vec3(3.42f, 2.35f, 1.77f);
  gold.alpha = glm::vec2(0.28f);
  const int pearl = add_material(scene, gold);

  TriangleMesh rock = stone(5, 6);
  place(rock, {3.0f, 0.45f, -1.35f}, {1.2f, 1.3f, 1.0f}, 30.0f);
  add_mesh(scene, std::move(rock), slate);
  TriangleMesh far_rock = stone(23, 5);
  place(far_rock, {-3.4f, 0.3f, -1.5f}, {1.3f, 1.0f, 1.0f}, 200.0f);
  add_mesh(scene, std::move(far_rock), slate);
  TriangleMesh creature = urchin();
  place(creature, {1.25f, 0.42f, 1.05f}, {0.52f, 0.42f, 0.52f}, 0.0f);
  add_mesh(scene, std::move(creature), wet);
  TriangleMesh nugget = stone(41, 5);
  place(nugget, {-1.25f, 0.26f, 1.35f}, {0.34f, 0.30f, 0.34f}, 70.0f);
  add_mesh(scene, std::move(nugget), pearl);

  // Pebbles where nothing else stands.
  for (unsigned i = 0; i < 90; ++i) {
    const float x = 8.0f * random_number(5 * i) - 4.0f;
    const float z = 4.0f * random_number(5 * i + 1) - 1.2f;
    const float size = 0.035f + 0.10f * random_number(5 * i + 2) * random_number(5 * i + 3);
    TriangleMesh pebble = stone(100 + i, 3);
    place(pebble, {x, sand_height(x, z) + 0.3f * size, z}, size * glm::vec3(1.2f, 0.8f, 1.0f),
          360.0f * random_number(5 * i + 4));
    add_mesh(scene, std::move(pebble), i % 5 == 0 ? wet : slate);
  }
}

}  // namespace

SceneDescription make_reef() {
  SceneDescription scene;
  scene.name = "reef";
  const int sand = add_material(scene, DiffuseMaterial{glm::vec3(0.66f, 0.56f, 0.42f)});
  const int wall = add_material(scene, DiffuseMaterial{glm::vec3(0.24f, 0.40f, 0.46f)});
  const int lamp = add_material(scene, DiffuseMaterial{glm::vec3(0.0f)});
  add_mesh(scene, terrain(200, 7.0f, sand_height), sand);
  add_rectangle(scene, {0, 3, -3.2f}, {12, 0, 0}, {0, 5, 0}, wall);
  add_rectangle(scene, {-3.0f, 5.2f, 1.3f}, {1.5f, 0, 0}, {0, 0, 1.2f}, lamp,
                Emission{glm::vec3(18.5f, 17.4f, 15.8f)});
  add_corals(scene);
  add_stones(scene);

  scene.camera.camera_to_world = look_at({0.25f, 2.35f, 6.6f}, {0.25f, 0.85f, 0});
  scene.camera.fov_degrees = 33.0f;
  scene.film.width = 684;
  scene.film.height = 456;
  scene.defaults = {64, 5};
  return scene;
}

}  // namespace lockstep::builtin
