// Objects that are placed several times: the image of copies, and the same bytes however traced.
#include "tests/t_scenes.h"

#include <gtest/gtest.h>
#include <glm/gtc/matrix_transform.hpp>

#include <cmath>

namespace lockstep::test_instances {
namespace {

// A smooth ball and a flat quad that overhangs it.
ObjectDescription ball_under_quad(int ball_material, int quad_material) {
  TriangleMesh quad;
  add_quad(quad, {-0.6f, 0.7f, -0.6f}, {-0.6f, 0.7f, 0.3f}, {0.3f, 0.9f, 0.3f},
           {0.3f, 0.9f, -0.6f});
  return {{{tessellated_sphere(0.5f, 24), ball_material, {}}, {quad, quad_material, {}}}};
}

// Turned, stretched and mirrored ones before a grey wall, under a sky and a distant light.
SceneDescription instanced_scene() {
  SceneDescription scene;
  scene.name = "instances";
  scene.materials = {DiffuseMaterial{glm::vec3(0.7f, 0.5f, 0.3f)}, ConductorMaterial{},
                     DielectricMaterial{}};
  TriangleMesh wall;
  add_quad(wall, {-4, -4, 3}, {4, -4, 3}, {4, 4, 3}, {-4, 4, 3});
  scene.shapes.push_back({wall, 0, {}});
  scene.objects = {ball_under_quad(0, 1), ball_under_quad(2, 0)};
  const glm::mat4 one(1.0f);
  const auto at = [&](float x, float y) { return glm::translate(one, glm::vec3(x, y, 0)); };
  scene.instances = {
      {0, at(-1.2f, 0.8f)},
      {0, glm::scale(at(0.9f, 0.9f), glm::vec3(-1.0f, 1.2f, 0.7f))},
      {0, glm::rotate(at(-1.0f, -0.9f), 1.0f, glm::vec3(1, 2, 3))},
      {1, glm::scale(at(1.0f, -1.0f), glm::vec3(1.3f, 0.6f, 1.0f))},
      {1, glm::translate(one, glm::vec3(0, 0, 1.2f))},
  };
  scene.environment = Environment(glm::vec3(0.4f, 0.5f, 0.7f));
  scene.lights.emplace_back(
      DistantLight{glm::normalize(glm::vec3(0.3f, -1.0f, 0.8f)), glm::vec3(2.0f)});
  scene.camera.camera_to_world = builtin::look_at({0, 0, -5}, {0, 0, 0});
  scene.camera.fov_degrees = 45.0f;
  scene.film.width = 45, scene.film.height = 39;
  return scene;
}

SceneDescription copied_scene() {
  SceneDescription scene = instanced_scene();
  for (const Instance& instance : scene.instances) {
    for (Shape shape : scene.objects[std::size_t(instance.object)].shapes) {
      apply_transform(std::get<TriangleMesh>(shape.geometry), instance.to_world);
      scene.shapes.push_back(std::move(shape));
    }
  }
  scene.instances.clear();
  scene.objects.clear();
  return scene;
}

RenderSettings settings(Isa isa = choose_isa()) {
  RenderSettings s;
  s.seed = 4;
  s.spp = 64;
  s.depth = 6;
  s.threads = 2;
  s.isa = isa;
  return s;
}

TEST(Instances, LookLikeCopies) {
  const Scene instanced = build(instanced_scene()), copied = build(copied_scene());
  EXPECT_TRUE(instanced.features() & bit(Feature::Instances));
  EXPECT_FALSE(copied.features() & bit(Feature::Instances));
  EXPECT_LT(instanced.triangle_count(), copied.triangle_count());
  const SamplerSpec owen = parse_sampler("owen");
  const Image a = render(instanced, owen, settings()).image;
  const Image b = render(copied, owen, settings()).image;
  // The same paths but for rounding, which sends few of them elsewhere.
  double difference = 0.0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    difference += std::abs(double(a.pixels[i]) - double(b.pixels[i]));
  }
  EXPECT_LT(difference / double(a.pixels.size()), 2e-3 * mean_of(b));
  EXPECT_GT(mean_of(b), 0.1);
}

TEST(Instances, HaveTheSameBytesAtEveryWidthAndMode) {
  for (const Isa isa : available_isas()) {
    const Scene scene = build(instanced_scene(), isa);
    RenderSettings s = settings(isa);
    s.spp = 4;
    const SamplerSpec strata = parse_sampler("strata");
    const Image expected = render(scene, strata, s).image;
    for (const int width : {1, 4, 8, 16}) {
      s.width = width;
      EXPECT_TRUE(same_bytes(render(scene, strata, s).image, expected)) << width;
    }
    s.width = 0;
    for (int mode = 0; mode < traversal_modes; ++mode) {
      s.traversal = traversal_mode(mode);
      EXPECT_TRUE(same_bytes(render(scene, strata, s).image, expected)) << to_string(*s.traversal);
    }
  }
}

}  // namespace
}  // namespace lockstep::test_instances
