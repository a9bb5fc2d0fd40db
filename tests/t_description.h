// What tests of readers ask of the scene descriptions they get.
#pragma once

#include "core/scene_description.h"

#include <glm/geometric.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <variant>

namespace lockstep {

inline const TriangleMesh& mesh_of(const SceneDescription& scene, size_t shape = 0) {
  return std::get<TriangleMesh>(scene.shapes.at(shape).geometry);
}

inline const Sphere& sphere_of(const SceneDescription& scene, size_t shape = 0) {
  return std::get<Sphere>(scene.shapes.at(shape).geometry);
}

inline const Material& material_of(const SceneDescription& scene, size_t shape = 0) {
  return scene.materials.at(size_t(scene.shapes.at(shape).material));
}

template <class T>
const T& model_of(const SceneDescription& scene, size_t shape = 0) {
  return std::get<T>(material_of(scene, shape).model);
}

inline const ImageTexture& image_of(const SceneDescription& scene, int texture = 0) {
  return std::get<ImageTexture>(scene.textures.at(size_t(texture)));
}

inline bool warns(const SceneDescription& scene, const std::string& text) {
  return std::any_of(scene.warnings.begin(), scene.warnings.end(),
                     [&](const std::string& w) { return w.find(text) != w.npos; });
}

inline glm::vec3 normal_of(const TriangleMesh& mesh, size_t triangle = 0) {
  const glm::uvec3 t = mesh.triangles.at(triangle);
  const glm::vec3 a = mesh.positions[t.x];
  return glm::normalize(glm::cross(mesh.positions[t.y] - a, mesh.positions[t.z] - a));
}

inline void expect_near(glm::vec3 a, glm::vec3 b, float tolerance = 1e-5f) {
  EXPECT_LT(glm::distance(a, b), tolerance)
      << a.x << " " << a.y << " " << a.z << " against " << b.x << " " << b.y << " " << b.z;
}

}  // namespace lockstep
