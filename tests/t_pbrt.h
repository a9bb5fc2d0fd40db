// Scenes in pbrt's language for tests of its reader, and what tests ask of the result.
#pragma once

#include "core/error.h"
#include "core/mesh.h"
#include "core/read_scene.h"

#include <glm/geometric.hpp>

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <variant>

namespace lockstep {

namespace fs = std::filesystem;

class Pbrt : public testing::Test {
 protected:
  void SetUp() override {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ =
        fs::temp_directory_path() / ("lockstep_pbrt_" + std::to_string(getpid()) + test->name());
    fs::create_directories(folder_ / "geometry");
  }
  void TearDown() override { fs::remove_all(folder_); }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }
  SceneDescription read(const std::string& text) const {
    write("scene.pbrt", text);
    return read_pbrt((folder_ / "scene.pbrt").string());
  }
  SceneDescription read_world(const std::string& text) const { return read("WorldBegin\n" + text); }

  // The message, with the folder's name taken off.
  std::string error_of(const std::string& text) const {
    try {
      read(text);
    } catch (const Error& error) {
      std::string message = error.what();
      const std::string prefix = folder_.string() + "/";
      for (size_t at; (at = message.find(prefix)) != std::string::npos;) {
        message.erase(at, prefix.size());
      }
      return message;
    }
    return "no error";
  }

  fs::path folder_;
};

inline const TriangleMesh& mesh_of(const SceneDescription& scene, size_t shape = 0) {
  return std::get<TriangleMesh>(scene.shapes.at(shape).geometry);
}

inline const Sphere& sphere_of(const SceneDescription& scene, size_t shape = 0) {
  return std::get<Sphere>(scene.shapes.at(shape).geometry);
}

template <class T>
const T& material_of(const SceneDescription& scene, size_t shape = 0) {
  return std::get<T>(scene.materials.at(scene.shapes.at(shape).material).model);
}

inline bool warns(const SceneDescription& scene, const std::string& text) {
  for (const std::string& warning : scene.warnings) {
    if (warning.find(text) != std::string::npos) return true;
  }
  return false;
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

inline const std::string triangle = "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] ";

}  // namespace lockstep
