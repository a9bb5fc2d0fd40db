// Disks and instances as meshes.
#include "core/expand_shapes.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <cmath>
#include <numbers>

namespace lockstep::test_expand_shapes {
namespace {

SceneDescription scene_of(Material material, Geometry geometry = Sphere{}) {
  SceneDescription scene;
  scene.name = "scene";
  scene.materials.push_back(std::move(material));
  scene.shapes.push_back({std::move(geometry), 0, {}});
  return scene;
}

TEST(ExpandShapes, DisksKeepTheirAreaAndSide) {
  const glm::vec3 normal = glm::normalize(glm::vec3(1, -2, 0.5f)), centre(3, 4, 5);
  SceneDescription scene = scene_of(DiffuseMaterial{}, Disk{centre, normal, 2.0f});
  expand_shapes(scene);
  const auto& mesh = std::get<TriangleMesh>(scene.shapes[0].geometry);
  double area = 0.0;
  for (const glm::uvec3 t : mesh.triangles) {
    const glm::vec3 p = mesh.positions[t.x];
    const glm::vec3 n = glm::cross(mesh.positions[t.y] - p, mesh.positions[t.z] - p);
    area += 0.5 * double(glm::length(n));
    EXPECT_NEAR(glm::dot(glm::normalize(n), normal), 1.0f, 1e-4f);
  }
  EXPECT_NEAR(area, 4.0 * std::numbers::pi, 1e-4);
  for (const glm::vec3 p : mesh.positions) {
    EXPECT_NEAR(glm::dot(p - centre, normal), 0.0f, 1e-5f);
    EXPECT_LT(glm::distance(p, centre), 2.002f);
  }
}

ObjectDescription ball_and_triangle() {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}};
  return {{{mesh, 0, {}}, {Sphere{{1, 0, 0}, 0.5f}, 0, {}}}};
}

TEST(ExpandShapes, WhatIsPlacedOnceBecomesAShape) {
  SceneDescription scene = scene_of(DiffuseMaterial{});
  scene.objects = {ball_and_triangle(), ball_and_triangle()};
  scene.instances.push_back({0, glm::translate(glm::mat4(1.0f), glm::vec3(0, 0, 7))});
  scene.instances.push_back({1, glm::scale(glm::mat4(1.0f), glm::vec3(-2.0f, 1.0f, 1.0f))});
  expand_shapes(scene);
  EXPECT_TRUE(scene.instances.empty());
  ASSERT_EQ(scene.shapes.size(), 5u);
  EXPECT_EQ(std::get<TriangleMesh>(scene.shapes[1].geometry).positions[1], glm::vec3(1, 0, 7));
  const auto& ball = std::get<TriangleMesh>(scene.shapes[2].geometry);
  for (const glm::vec3 p : ball.positions) {
    EXPECT_NEAR(glm::distance(p, glm::vec3(1, 0, 7)), 0.5f, 1e-5f);
  }
  // Mirrored: the winding turns, so that the normal keeps to its side.
  const auto& mirrored = std::get<TriangleMesh>(scene.shapes[3].geometry);
  const glm::uvec3 t = mirrored.triangles[0];
  const glm::vec3 p = mirrored.positions[t.x];
  EXPECT_GT(glm::cross(mirrored.positions[t.y] - p, mirrored.positions[t.z] - p).z, 0.0f);
}

TEST(ExpandShapes, WhatIsPlacedOftenStaysOneObject) {
  SceneDescription scene = scene_of(DiffuseMaterial{});
  scene.objects = {ball_and_triangle()};
  const auto flat = glm::scale(glm::mat4(1.0f), glm::vec3(1.0f, 1.0f, 0.0f));
  scene.instances = {{0, glm::mat4(1.0f)}, {0, flat}, {0, glm::mat4(2.0f)}};
  expand_shapes(scene);
  // But for the one that has no inverse.
  EXPECT_EQ(scene.instances.size(), 2u);
  EXPECT_EQ(scene.shapes.size(), 3u);
  ASSERT_EQ(scene.objects[0].shapes.size(), 2u);
  EXPECT_TRUE(std::holds_alternative<TriangleMesh>(scene.objects[0].shapes[1].geometry));
}

}  // namespace
}  // namespace lockstep::test_expand_shapes
