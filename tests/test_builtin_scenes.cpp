// Built-in scenes: complete, well-formed, the same every time; and read_scene's
// choice between them and files.
#include "core/error.h"
#include "core/read_scene.h"

#include <gtest/gtest.h>
#include <unistd.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <utility>

namespace lockstep::test_builtin_scenes {
namespace {

size_t triangle_count(const SceneDescription& scene) {
  size_t count = 0;
  for (const Shape& shape : scene.shapes) {
    if (const auto* mesh = std::get_if<TriangleMesh>(&shape.geometry)) {
      count += mesh->triangles.size();
    }
  }
  return count;
}

template <typename Action>
void for_each_mesh(const SceneDescription& scene, Action action) {
  for (const Shape& shape : scene.shapes) {
    if (const auto* mesh = std::get_if<TriangleMesh>(&shape.geometry)) action(*mesh);
  }
}

bool is_finite(glm::vec3 v) { return std::isfinite(v.x + v.y + v.z); }

std::string error_of(const std::string& name) {
  try {
    read_scene(name);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

class BuiltinScenes : public testing::TestWithParam<BuiltinScene> {};

TEST_P(BuiltinScenes, AreComplete) {
  const SceneDescription scene = read_scene(std::string(GetParam().name));
  EXPECT_EQ(scene.name, GetParam().name);
  EXPECT_FALSE(GetParam().summary.empty());
  EXPECT_TRUE(scene.warnings.empty());
  EXPECT_FALSE(scene.shapes.empty());
  const bool lamps = std::any_of(scene.shapes.begin(), scene.shapes.end(),
                                 [](const Shape& shape) { return shape.emission.has_value(); });
  EXPECT_TRUE(lamps || scene.environment) << "nothing shines";
  for (const Shape& shape : scene.shapes) {
    EXPECT_GE(shape.material, 0);
    EXPECT_LT(size_t(shape.material), scene.materials.size());
  }
}

TEST_P(BuiltinScenes, MeshesAreWellFormed) {
  const SceneDescription scene = read_scene(std::string(GetParam().name));
  for_each_mesh(scene, [](const TriangleMesh& mesh) {
    ASSERT_FALSE(mesh.triangles.empty());
    if (!mesh.normals.empty()) {
      ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
    }
    for (const glm::vec3& p : mesh.positions) ASSERT_TRUE(is_finite(p));
    for (const glm::vec3& n : mesh.normals) ASSERT_NEAR(glm::length(n), 1.0f, 1e-4f);
    size_t slivers = 0;
    for (const glm::uvec3& t : mesh.triangles) {
      ASSERT_LT(std::max({t.x, t.y, t.z}), mesh.positions.size());
      const glm::vec3 a = mesh.positions[t.x], b = mesh.positions[t.y], c = mesh.positions[t.z];
      const float doubled_area = glm::length(glm::cross(b - a, c - a));
      const float longest =
          std::max({glm::distance(a, b), glm::distance(b, c), glm::distance(c, a)});
      ASSERT_GT(doubled_area, 0.0f);
      if (doubled_area < 0.05f * longest * longest) ++slivers;
    }
    EXPECT_LE(slivers, mesh.triangles.size() / 1000);
  });
}

// Interpolated normals that disagree with the face would show as black spots.
TEST_P(BuiltinScenes, NormalsAgreeWithFaces) {
  const SceneDescription scene = read_scene(std::string(GetParam().name));
  size_t disagreeing = 0;
  for_each_mesh(scene, [&](const TriangleMesh& mesh) {
    if (mesh.normals.empty()) return;
    for (const glm::uvec3& t : mesh.triangles) {
      const glm::vec3 face = glm::cross(mesh.positions[t.y] - mesh.positions[t.x],
                                        mesh.positions[t.z] - mesh.positions[t.x]);
      if (glm::dot(face, mesh.normals[t.x] + mesh.normals[t.y] + mesh.normals[t.z]) <= 0.0f) {
        ++disagreeing;
      }
    }
  });
  EXPECT_LE(disagreeing, triangle_count(scene) / 10000);
}

// No edge is walked twice in the same direction.
TEST_P(BuiltinScenes, MeshesAreManifold) {
  const SceneDescription scene = read_scene(std::string(GetParam().name));
  for_each_mesh(scene, [](const TriangleMesh& mesh) {
    std::vector<std::pair<uint32_t, uint32_t>> edges;
    for (const glm::uvec3& t : mesh.triangles) {
      for (int i = 0; i < 3; ++i) edges.emplace_back(t[i], t[(i + 1) % 3]);
    }
    std::sort(edges.begin(), edges.end());
    ASSERT_EQ(std::adjacent_find(edges.begin(), edges.end()), edges.end());
  });
}

TEST_P(BuiltinScenes, CameraIsOrthonormalAndLooksAtSomething) {
  const SceneDescription scene = read_scene(std::string(GetParam().name));
  const glm::mat4& m = scene.camera.camera_to_world;
  const glm::vec3 right(m[0]), up(m[1]), forward(m[2]), eye(m[3]);
  EXPECT_NEAR(glm::length(right), 1.0f, 1e-5f);
  EXPECT_NEAR(glm::distance(up, glm::cross(right, forward)), 0.0f, 1e-5f);
  EXPECT_GE(up.y, 0.5f);
  glm::vec3 low(std::numeric_limits<float>::max()), high(-low);
  for (const Shape& shape : scene.shapes) {
    if (const auto* sphere = std::get_if<Sphere>(&shape.geometry)) {
      low = glm::min(low, sphere->center);
      high = glm::max(high, sphere->center);
    } else {
      for (const glm::vec3& p : std::get<TriangleMesh>(shape.geometry).positions) {
        low = glm::min(low, p);
        high = glm::max(high, p);
      }
    }
  }
  EXPECT_GT(glm::dot(0.5f * (low + high) - eye, forward), 0.0f);
  EXPECT_GT(scene.film.width, 0);
  EXPECT_GT(scene.film.height, 0);
  EXPECT_GT(scene.defaults.depth, 0);
}

TEST_P(BuiltinScenes, AreTheSameEveryTime) {
  const SceneDescription first = GetParam().make(), second = GetParam().make();
  ASSERT_EQ(first.shapes.size(), second.shapes.size());
  for (size_t i = 0; i < first.shapes.size(); ++i) {
    const auto* a = std::get_if<TriangleMesh>(&first.shapes[i].geometry);
    const auto* b = std::get_if<TriangleMesh>(&second.shapes[i].geometry);
    ASSERT_EQ(a == nullptr, b == nullptr);
    if (a != nullptr) {
      EXPECT_TRUE(a->positions == b->positions && a->normals == b->normals);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, BuiltinScenes, testing::ValuesIn(builtin_scenes()),
                         [](const auto& scene) { return std::string(scene.param.name); });

TEST(BuiltinSceneList, HasWhatExperimentsNeed) {
  EXPECT_GE(triangle_count(read_scene("reef")), 100000u);
  EXPECT_GE(triangle_count(read_scene("meadow")), 100000u);
  size_t lamps = 0;
  for (const Shape& shape : read_scene("reef").shapes) lamps += shape.emission.has_value();
  EXPECT_EQ(lamps, 1u);
  for (const Shape& shape : read_scene("meadow").shapes) EXPECT_FALSE(shape.emission);
}

// Lamps of the box and the reef hang above and shine down.
TEST(BuiltinSceneList, CeilingLampsShineDown) {
  for (const char* name : {"cornell", "reef"}) {
    const SceneDescription scene = read_scene(name);
    for (const Shape& shape : scene.shapes) {
      if (!shape.emission) continue;
      const auto& mesh = std::get<TriangleMesh>(shape.geometry);
      for (const glm::uvec3& t : mesh.triangles) {
        const glm::vec3 normal = glm::normalize(glm::cross(
            mesh.positions[t.y] - mesh.positions[t.x], mesh.positions[t.z] - mesh.positions[t.x]));
        EXPECT_NEAR(normal.y, -1.0f, 1e-5f) << name;
      }
      EXPECT_FALSE(shape.emission->two_sided);
    }
  }
}

TEST(BuiltinSceneList, FurnaceIsWhiteInWhite) {
  const SceneDescription scene = read_scene("furnace");
  ASSERT_TRUE(scene.environment);
  EXPECT_EQ(scene.environment->radiance, glm::vec3(1.0f));
  for (const Material& material : scene.materials) {
    EXPECT_EQ(std::get<DiffuseMaterial>(material.model).reflectance, glm::vec3(1.0f));
  }
}

TEST(ReadScene, MissingFileNamesTheBuiltinScenes) {
  const std::string message = error_of("no-such-scene.pbrt");
  EXPECT_NE(message.find("no-such-scene.pbrt"), std::string::npos);
  for (const BuiltinScene& scene : builtin_scenes()) {
    EXPECT_NE(message.find(scene.name), std::string::npos);
  }
  EXPECT_EQ(message.find('\n'), std::string::npos);
}

// Whatever their name is.
TEST(ReadScene, FormatsAreToldByContent) {
  namespace fs = std::filesystem;
  const fs::path file =
      fs::temp_directory_path() / ("lockstep-read-format-" + std::to_string(getpid()));
  const char* const contents[] = {
      "# a comment\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
      "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
      "# a comment\nWorldBegin\nShape \"trianglemesh\" \"point P\" [0 0 0 1 0 0 0 1 0] "
      "\"integer indices\" [0 1 2]\n",
      "<scene version=\"3.0.0\"><shape type=\"rectangle\"/></scene>\n"};
  for (const char* const content : contents) {
    std::ofstream(file) << content;
    const SceneDescription scene = read_scene(file.string());
    ASSERT_EQ(scene.shapes.size(), 1u) << content;
    EXPECT_FALSE(std::get<TriangleMesh>(scene.shapes[0].geometry).triangles.empty()) << content;
  }
  std::ofstream(file) << "{\"asset\": {\"version\": \"1.0\"}}";
  EXPECT_NE(error_of(file.string()).find("glTF"), std::string::npos);
  fs::remove(file);
}

TEST(ReadScene, UnknownFormatsAreErrors) {
  namespace fs = std::filesystem;
  const fs::path directory =
      fs::temp_directory_path() / ("lockstep-read-scene-" + std::to_string(getpid()));
  fs::create_directories(directory);
  const std::string text = (directory / "scene.txt").string();
  std::ofstream(text) << "once upon a time\n";
  EXPECT_NE(error_of(text).find("scene.txt: unknown scene format"), std::string::npos);
  const std::string empty = (directory / "empty").string();
  std::ofstream(empty).close();
  EXPECT_NE(error_of(empty).find("unknown scene format"), std::string::npos);
  EXPECT_NE(error_of(directory.string()).find("is a directory"), std::string::npos);
  fs::remove_all(directory);
}

// A pbrt file under another name is known by its first directive.
TEST(ReadScene, PbrtIsKnownByContent) {
  namespace fs = std::filesystem;
  const fs::path path =
      fs::temp_directory_path() / ("lockstep-scene-" + std::to_string(getpid()) + ".txt");
  std::ofstream(path) << "# a comment\n\n  LookAt 0 0 4  0 0 0  0 1 0\n"
                         "Camera \"perspective\" \"float fov\" [40]\nWorldBegin\n"
                         "LightSource \"infinite\"\nShape \"sphere\"\n";
  EXPECT_EQ(read_scene(path.string()).shapes.size(), 1u);
  fs::remove(path);
}

}  // namespace
}  // namespace lockstep::test_builtin_scenes
