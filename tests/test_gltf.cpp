// The glTF reader: geometry, nodes, view, lights and containers.
#include "tests/t_gltf.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <string>
#include <variant>
#include <vector>

namespace lockstep::test_gltf {
namespace {

namespace fs = std::filesystem;

// --- Containers and buffers

TEST_F(Gltf, BuffersInsideBesideAndInContainers) {
  GltfBuffer buffer;
  buffer.add("VEC3", corner_positions);
  const std::string rest = one_mesh("\"attributes\":{\"POSITION\":0}");
  write("a b+c.bin", buffer.bytes + "longer than byteLength");
  const std::string percent = [&] {
    std::string text;
    constexpr std::string_view digits = "0123456789abcdef";
    for (const char c : buffer.bytes) {
      const auto byte = static_cast<unsigned char>(c);
      text += {'%', digits[byte >> 4], digits[byte & 15]};
    }
    return text;
  }();
  for (const std::string& bytes :
       {buffer.embedded(rest), buffer.json(rest, "a%20b+c.bin"), buffer.container(rest),
        buffer.json(rest, "data:," + percent),
        buffer.json(rest, "data:application/gltf-buffer;base64," + base64(buffer.bytes))}) {
    const SceneDescription scene = read(bytes);
    EXPECT_EQ(scene.name, "scene");
    ASSERT_EQ(scene.shapes.size(), 1u);
    ASSERT_EQ(mesh_of(scene).triangles.size(), 1u);
    const std::vector<glm::vec3> corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    EXPECT_EQ(mesh_of(scene).positions, corners);
    EXPECT_TRUE(mesh_of(scene).normals.empty());
    EXPECT_TRUE(mesh_of(scene).uvs.empty());
  }
}

// --- Accessors and primitives

TEST_F(Gltf, IndicesOfAllSizes) {
  const auto indexed = [&](auto index) {
    GltfBuffer buffer;
    buffer.add("VEC3", corner_positions);
    using Index = decltype(index);
    buffer.add("SCALAR", std::vector<Index>{2, 0, 1});
    return read(buffer.embedded(one_mesh("\"attributes\":{\"POSITION\":0},\"indices\":1")));
  };
  for (const SceneDescription& scene :
       {indexed(std::uint8_t{}), indexed(std::uint16_t{}), indexed(std::uint32_t{})}) {
    EXPECT_EQ(mesh_of(scene).triangles.at(0), glm::uvec3(2, 0, 1));
  }
}

TEST_F(Gltf, IntegerPositionsPlainAndNormalised) {
  const auto at = [&](auto first, bool normalized) {
    GltfBuffer buffer;
    using T = decltype(first);
    buffer.add("VEC3", std::vector<T>{first, 0, 0, 1, 1, 0, 0, 1, 0}, normalized);
    return mesh_of(read(buffer.embedded(one_mesh("\"attributes\":{\"POSITION\":0}"))))
        .positions[0]
        .x;
  };
  EXPECT_EQ(at(std::int8_t(-128), false), -128.0f);
  EXPECT_EQ(at(std::int8_t(-128), true), -1.0f);
  EXPECT_FLOAT_EQ(at(std::int8_t(64), true), 64.0f / 127.0f);
  EXPECT_EQ(at(std::uint8_t(255), true), 1.0f);
  EXPECT_EQ(at(std::int16_t(-32768), false), -32768.0f);
  EXPECT_FLOAT_EQ(at(std::int16_t(-16384), true), -16384.0f / 32767.0f);
  EXPECT_EQ(at(std::uint16_t(65535), true), 1.0f);
  EXPECT_EQ(at(std::uint32_t(70000), false), 70000.0f);
}

TEST_F(Gltf, InterleavedVertices) {
  GltfBuffer buffer;
  std::vector<float> vertices;
  for (int i = 0; i < 3; ++i) {
    const auto f = static_cast<float>(i);
    vertices.insert(vertices.end(), {f, f * f, 0, 0, 0, 2, 0.25f * f, 1 - f});
  }
  buffer.add_view(raw(vertices), ",\"byteStride\":32");
  for (const char* members :
       {"\"type\":\"VEC3\",\"byteOffset\":0", "\"type\":\"VEC3\",\"byteOffset\":12",
        "\"type\":\"VEC2\",\"byteOffset\":24"}) {
    buffer.add_accessor(std::string(members) +
                        ",\"bufferView\":0,\"componentType\":5126,\"count\":3");
  }
  const SceneDescription scene = read(
      buffer.embedded(one_mesh("\"attributes\":{\"POSITION\":0,\"NORMAL\":1,\"TEXCOORD_0\":2}")));
  EXPECT_EQ(mesh_of(scene).positions[2], glm::vec3(2, 4, 0));
  EXPECT_EQ(mesh_of(scene).normals[2], glm::vec3(0, 0, 1));  // made unit
  EXPECT_EQ(mesh_of(scene).uvs[2], glm::vec2(0.5f, -1.0f));
}

TEST_F(Gltf, SparseAccessorsReplaceElements) {
  for (const bool with_view : {true, false}) {
    GltfBuffer buffer;
    const int view = buffer.add_view(raw(corner_positions));
    const int indices = buffer.add_view(raw(std::vector<std::uint16_t>{0, 2}));
    const int values = buffer.add_view(raw(std::vector<float>{5, 6, 7, 8, 9, 10}));
    buffer.add_accessor(
        (with_view ? "\"bufferView\":" + std::to_string(view) + "," : "") +
        "\"componentType\":5126,\"count\":3,\"type\":\"VEC3\",\"sparse\":{\"count\":2,"
        "\"indices\":{\"bufferView\":" +
        std::to_string(indices) + ",\"componentType\":5123},\"values\":{" +
        "\"bufferView\":" + std::to_string(values) + "}}");
    const auto positions =
        mesh_of(read(buffer.embedded(one_mesh("\"attributes\":{\"POSITION\":0}")))).positions;
    EXPECT_EQ(positions[0], glm::vec3(5, 6, 7));
    EXPECT_EQ(positions[1], glm::vec3(with_view ? 1.0f : 0.0f, 0, 0));
    EXPECT_EQ(positions[2], glm::vec3(8, 9, 10));
  }
}

TEST_F(Gltf, StripsAndFansKeepTheirWinding) {
  GltfBuffer strip;
  strip.add("VEC3", std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0});
  const SceneDescription a =
      read(strip.embedded(one_mesh("\"attributes\":{\"POSITION\":0},\"mode\":5")));
  ASSERT_EQ(mesh_of(a).triangles.size(), 3u);
  for (size_t i = 0; i < 3; ++i) expect_near(normal_of(mesh_of(a), i), {0, 0, 1});

  GltfBuffer fan;
  fan.add("VEC3", std::vector<float>{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0});
  const SceneDescription b =
      read(fan.embedded(one_mesh("\"attributes\":{\"POSITION\":0},\"mode\":6")));
  ASSERT_EQ(mesh_of(b).triangles.size(), 2u);
  for (size_t i = 0; i < 2; ++i) expect_near(normal_of(mesh_of(b), i), {0, 0, 1});

  // Strips joined by repeated indices.
  strip.add("SCALAR", std::vector<std::uint8_t>{0, 1, 2, 2, 2, 3, 4});
  const SceneDescription c =
      read(strip.embedded(one_mesh("\"attributes\":{\"POSITION\":0},\"mode\":5,\"indices\":1")));
  EXPECT_EQ(mesh_of(c).triangles.size(), 2u);
}

TEST_F(Gltf, PointsAndEmptyPrimitivesAreLeftOut) {
  GltfBuffer buffer;
  buffer.add("VEC3", corner_positions);
  for (const char* primitive :
       {"\"attributes\":{\"POSITION\":0},\"mode\":0", "\"attributes\":{\"POSITION\":0},\"mode\":3",
        "\"attributes\":{}"}) {
    const SceneDescription scene = read(buffer.embedded(one_mesh(primitive)));
    EXPECT_TRUE(scene.shapes.empty());
    EXPECT_TRUE(warns(scene, "scene.gltf: mesh 0 primitive 0: ")) << primitive;
    EXPECT_TRUE(warns(scene, "left out")) << primitive;
    EXPECT_TRUE(warns(scene, "no triangles"));
  }
  const SceneDescription empty = read("{\"asset\":{\"version\":\"2.0\"}}");
  EXPECT_TRUE(empty.shapes.empty());
}

TEST_F(Gltf, SharedVertexArraysAreNotCopiedWhole) {
  GltfBuffer buffer;
  std::vector<float> positions(3 * 1000);
  for (size_t i = 0; i < positions.size(); ++i) positions[i] = static_cast<float>(i * i % 101);
  buffer.add("VEC3", positions);
  buffer.add("SCALAR", std::vector<std::uint16_t>{900, 7, 500});
  const SceneDescription scene =
      read(buffer.embedded(one_mesh("\"attributes\":{\"POSITION\":0},\"indices\":1")));
  ASSERT_EQ(mesh_of(scene).positions.size(), 3u);
  const glm::uvec3 t = mesh_of(scene).triangles.at(0);
  for (int c = 0; c < 3; ++c) {
    const size_t vertex = c == 0 ? 900 : c == 1 ? 7 : 500;
    EXPECT_EQ(
        mesh_of(scene).positions[t[c]],
        glm::vec3(positions[3 * vertex], positions[3 * vertex + 1], positions[3 * vertex + 2]));
  }
}

TEST_F(Gltf, BadNormalsAndUvsAreReplaced) {
  GltfBuffer buffer;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  buffer.add("VEC3", corner_positions);
  buffer.add("VEC3", std::vector<float>{0, 0, 0, nan, 0, 0, 1, 0, 0});
  buffer.add("VEC2", std::vector<float>{nan, 0, 1, 0, 0, 1});
  const SceneDescription scene = read(buffer.embedded(
      one_mesh("\"attributes\":{\"POSITION\":0,\"NORMAL\":1,\"TEXCOORD_0\":2,\"COLOR_0\":1}")));
  expect_near(mesh_of(scene).normals[0], {0, 0, 1});
  expect_near(mesh_of(scene).normals[1], {0, 0, 1});
  expect_near(mesh_of(scene).normals[2], {1, 0, 0});
  EXPECT_EQ(mesh_of(scene).uvs[0], glm::vec2(0.0f));
  EXPECT_TRUE(warns(scene, "normals without a direction"));
  EXPECT_TRUE(warns(scene, "COLOR_0"));
}

// --- Nodes

TEST_F(Gltf, HierarchyOfMatricesAndTrs) {
  // A turn by 90 degrees about z, from x to y, of unnormalised length.
  const SceneDescription scene = read(triangle_file(
      "\"nodes\":[{\"children\":[1],\"matrix\":[2,0,0,0, 0,2,0,0, 0,0,2,0, 10,0,0,1]},"
      "{\"mesh\":0,\"translation\":[0,1,0],\"rotation\":[0,0,2,2],\"scale\":[3,1,1]}],"
      "\"scenes\":[{\"nodes\":[0]}]"));
  expect_near(mesh_of(scene).positions[0], {10, 2, 0});
  expect_near(mesh_of(scene).positions[1], {10, 8, 0});
  expect_near(mesh_of(scene).positions[2], {8, 2, 0});
}

TEST_F(Gltf, MirrorsKeepTheFrontInFront) {
  GltfBuffer buffer;
  buffer.add("VEC3", corner_positions);
  buffer.add("VEC3", std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1});
  const SceneDescription scene =
      read(buffer.embedded("\"nodes\":[{\"mesh\":0,\"scale\":[-1,1,1]}],\"meshes\":[" +
                           mesh("\"attributes\":{\"POSITION\":0,\"NORMAL\":1}") + "]"));
  expect_near(normal_of(mesh_of(scene)), {0, 0, 1});
  expect_near(mesh_of(scene).normals[0], {0, 0, 1});
}

TEST_F(Gltf, ScenesAndRoots) {
  const std::string nodes =
      "\"nodes\":[{\"mesh\":0},{\"mesh\":0,\"translation\":[0,0,5],\"children\":[2]},{}]";
  const auto depth = [&](const std::string& rest) {
    return mesh_of(read(triangle_file(nodes + rest))).positions[0].z;
  };
  EXPECT_EQ(depth(",\"scenes\":[{\"nodes\":[0]},{\"nodes\":[1]}]"), 0.0f);
  EXPECT_EQ(depth(",\"scenes\":[{\"nodes\":[0]},{\"nodes\":[1]}],\"scene\":1"), 5.0f);
  EXPECT_EQ(read(triangle_file(nodes)).instances.size(), 2u);  // all trees without scenes
}

TEST_F(Gltf, MeshesOfSeveralNodesBecomeInstances) {
  const SceneDescription scene = read(triangle_file(
      "\"nodes\":[{\"mesh\":0,\"translation\":[1,2,3]},{\"mesh\":0,\"scale\":[1,1,-2]},"
      "{\"mesh\":0,\"scale\":[0,0,0]}]"));
  EXPECT_TRUE(scene.shapes.empty());
  ASSERT_EQ(scene.objects.size(), 1u);
  EXPECT_EQ(std::get<TriangleMesh>(scene.objects[0].shapes.at(0).geometry).positions[1],
            glm::vec3(1, 0, 0));
  ASSERT_EQ(scene.instances.size(), 2u);  // a scale of 0 hides
  EXPECT_EQ(scene.instances[0].to_world[3], glm::vec4(1, 2, 3, 1));
  EXPECT_EQ(scene.instances[1].to_world[2][2], -2.0f);
}

TEST_F(Gltf, WhatEmitsIsPlacedForEachNode) {
  GltfBuffer buffer;
  buffer.add("VEC3", corner_positions);
  const SceneDescription scene = read(buffer.embedded(
      "\"materials\":[{\"emissiveFactor\":[1,1,1]}],\"meshes\":[{\"primitives\":["
      "{\"attributes\":{\"POSITION\":0},\"material\":0},{\"attributes\":{\"POSITION\":0}}]}],"
      "\"nodes\":[{\"mesh\":0},{\"mesh\":0,\"translation\":[0,0,7]}]"));
  ASSERT_EQ(scene.shapes.size(), 2u);
  EXPECT_TRUE(scene.shapes[0].emission && scene.shapes[1].emission);
  EXPECT_EQ(mesh_of(scene, 0).positions[0].z, 0.0f);
  EXPECT_EQ(mesh_of(scene, 1).positions[0].z, 7.0f);
  ASSERT_EQ(scene.objects.size(), 1u);
  EXPECT_EQ(scene.objects[0].shapes.size(), 1u);
  EXPECT_FALSE(scene.objects[0].shapes[0].emission);
  EXPECT_EQ(scene.instances.size(), 2u);
}

TEST_F(Gltf, LongChainsAreErrorsAndDoNotOverflow) {
  const auto chain = [&](int length) {
    std::string nodes = "\"nodes\":[";
    for (int i = 0; i < length; ++i) {
      nodes += "{\"children\":[" + std::to_string(i + 1) + "]},";
    }
    return triangle_file(nodes + "{\"mesh\":0}],\"scenes\":[{\"nodes\":[0]}]");
  };
  EXPECT_EQ(read(chain(900)).shapes.size(), 1u);
  expect_error(chain(20000), "more than 1000 levels");
}

// --- Camera and lights

TEST_F(Gltf, PerspectiveCameras) {
  const auto camera = [&](const std::string& values) {
    return read(triangle_file(
        "\"cameras\":[{\"type\":\"perspective\",\"perspective\":{\"znear\":0.1," + values +
        "}}],\"nodes\":[{\"mesh\":0},{\"camera\":0,"
        "\"translation\":[1,2,3],\"scale\":[5,5,5]}]"));
  };
  const SceneDescription wide = camera("\"yfov\":1,\"aspectRatio\":2");
  EXPECT_EQ(wide.film.width, 768);
  EXPECT_EQ(wide.film.height, 384);
  EXPECT_NEAR(wide.camera.fov_degrees, 57.29578f, 1e-4f);
  const glm::mat4& m = wide.camera.camera_to_world;
  expect_near(glm::vec3(m[0]), {1, 0, 0});
  expect_near(glm::vec3(m[1]), {0, 1, 0});
  expect_near(glm::vec3(m[2]), {0, 0, -1});
  expect_near(glm::vec3(m[3]), {1, 2, 3});
  EXPECT_FALSE(warns(wide, "no camera"));

  const SceneDescription tall = camera("\"yfov\":1,\"aspectRatio\":0.5");
  EXPECT_EQ(tall.film.width, 384);
  EXPECT_EQ(tall.film.height, 768);
  EXPECT_NEAR(tall.camera.fov_degrees, 2.0 * std::atan(0.5 * std::tan(0.5)) * 57.29577951, 1e-4);
  EXPECT_EQ(camera("\"yfov\":1").film.height, 768);
}

TEST_F(Gltf, OrthographicCameraAndTheFirstOfSeveral) {
  const SceneDescription scene = read(triangle_file(
      "\"cameras\":[{\"type\":\"orthographic\",\"orthographic\":{\"xmag\":3,\"ymag\":-1.5,"
      "\"znear\":0,\"zfar\":9}},{\"type\":\"perspective\",\"perspective\":{\"yfov\":1,\"znear\":1}}"
      "],"
      "\"nodes\":[{\"mesh\":0,\"children\":[2]},{\"camera\":1},{\"camera\":0}]"));
  EXPECT_EQ(scene.camera.projection, CameraDescription::Projection::Orthographic);
  EXPECT_FLOAT_EQ(scene.camera.extent, 3.0f);
  EXPECT_EQ(scene.film.width, 768);
  EXPECT_EQ(scene.film.height, 384);
  EXPECT_TRUE(warns(scene, "several cameras"));
}

TEST_F(Gltf, FilesWithoutCameraOrLightGetBoth) {
  const SceneDescription scene = read(triangle_file("\"nodes\":[{\"mesh\":0}]"));
  EXPECT_TRUE(warns(scene, "no camera"));
  EXPECT_TRUE(warns(scene, "no lamps"));
  ASSERT_TRUE(scene.environment);
  EXPECT_EQ(scene.environment->radiance, glm::vec3(1.0f));
  const glm::vec3 eye(scene.camera.camera_to_world[3]);
  EXPECT_GT(glm::length(eye), 1.0f);
}

TEST_F(Gltf, PunctualLights) {
  const SceneDescription scene = read(triangle_file(
      "\"extensionsUsed\":[\"KHR_lights_punctual\"],\"extensions\":{\"KHR_lights_punctual\":{"
      "\"lights\":["
      "{\"type\":\"point\",\"color\":[1,0.5,0],\"intensity\":20,\"range\":3},"
      "{\"type\":\"spot\",\"intensity\":4,\"spot\":{\"innerConeAngle\":0.2,\"outerConeAngle\":0.4}}"
      ","
      "{\"type\":\"directional\",\"intensity\":3},{\"type\":\"spot\",\"spot\":{}}]}},"
      "\"nodes\":[{\"mesh\":0},"
      "{\"translation\":[1,2,3],\"extensions\":{\"KHR_lights_punctual\":{\"light\":0}}},"
      "{\"rotation\":[-0.70710678,0,0,0.70710678],\"scale\":[9,9,9],"
      "\"extensions\":{\"KHR_lights_punctual\":{\"light\":1}}},"
      "{\"extensions\":{\"KHR_lights_punctual\":{\"light\":2}}},"
      "{\"extensions\":{\"KHR_lights_punctual\":{\"light\":3}}}]"));
  ASSERT_EQ(scene.lights.size(), 4u);
  const auto& point = std::get<PointLight>(scene.lights[0]);
  EXPECT_EQ(point.position, glm::vec3(1, 2, 3));
  EXPECT_EQ(point.intensity, glm::vec3(20, 10, 0));
  EXPECT_TRUE(warns(scene, "range of lights"));
  const auto& spot = std::get<SpotLight>(scene.lights[1]);
  expect_near(spot.direction, {0, -1, 0});
  EXPECT_FLOAT_EQ(spot.cos_inner, std::cos(0.2f));
  EXPECT_FLOAT_EQ(spot.cos_outer, std::cos(0.4f));
  EXPECT_EQ(spot.falloff, SpotLight::Falloff::Squared);
  EXPECT_EQ(spot.intensity, glm::vec3(4.0f));
  const auto& sun = std::get<DistantLight>(scene.lights[2]);
  expect_near(sun.direction, {0, 0, -1});
  EXPECT_EQ(sun.irradiance, glm::vec3(3.0f));
  const auto& defaults = std::get<SpotLight>(scene.lights[3]);
  EXPECT_EQ(defaults.cos_inner, 1.0f);
  EXPECT_FLOAT_EQ(defaults.cos_outer, std::sqrt(0.5f));
  EXPECT_FALSE(scene.environment);
}

// --- What is not supported

TEST_F(Gltf, UnknownExtensionsAndAnimation) {
  const SceneDescription scene = read(triangle_file(
      "\"extensionsUsed\":[\"EXT_new\",\"KHR_mesh_quantization\"],\"animations\":[{}],"
      "\"skins\":[{\"joints\":[0]}],\"nodes\":[{\"mesh\":0,\"skin\":0,\"weights\":[0.5]}]"));
  EXPECT_TRUE(warns(scene, "\"EXT_new\" is not supported"));
  EXPECT_FALSE(warns(scene, "KHR_mesh_quantization"));
  EXPECT_TRUE(warns(scene, "animations"));
  EXPECT_TRUE(warns(scene, "skins"));
  EXPECT_TRUE(warns(scene, "morph targets"));
  expect_error(triangle_file("\"extensionsRequired\":[\"KHR_draco_mesh_compression\"]"),
               "requires the extension \"KHR_draco_mesh_compression\"");
  read(triangle_file("\"extensionsRequired\":[\"KHR_mesh_quantization\"]"));
}

// --- Real models

struct Model {
  const char* file;
  size_t triangles, materials, textures;
  glm::vec3 low, high;
};

TEST_F(Gltf, SharedModels) {
  const fs::path scenes = fs::path(LOCKSTEP_SHARED_DIR) / "scenes";
  const Model models[] = {
      {"gltf-DamagedHelmet/glTF/DamagedHelmet.gltf",
       15452,
       1,
       4,
       {-0.944977f, -0.900995f, -1.0f},
       {0.944977f, 0.900974f, 1.0f}},
      {"gltf-FlightHelmet/FlightHelmet.gltf",
       94722,
       6,
       15,
       {-0.203643f, -2.14e-5f, -0.171546f},
       {0.162941f, 0.716f, 0.200029f}},
      {"gltf-apple/food_apple_01_4k.gltf",
       7012,
       1,
       3,
       {-0.0483814f, -2.26e-5f, -0.045817f},
       {0.0491798f, 0.0853673f, 0.0500847f}},
  };
  for (const Model& model : models) {
    if (!fs::exists(scenes / model.file)) GTEST_SKIP() << "no " << model.file;
    const SceneDescription scene = read_gltf((scenes / model.file).string());
    size_t triangles = 0;
    glm::vec3 low(1e9f), high(-1e9f);
    for (size_t i = 0; i < scene.shapes.size(); ++i) {
      const TriangleMesh& m = mesh_of(scene, i);
      triangles += m.triangles.size();
      EXPECT_EQ(m.normals.size(), m.positions.size());
      EXPECT_EQ(m.uvs.size(), m.positions.size());
      for (const glm::vec3 p : m.positions) {
        for (int c = 0; c < 3; ++c) {
          low[c] = std::min(low[c], p[c]);
          high[c] = std::max(high[c], p[c]);
        }
      }
    }
    EXPECT_EQ(triangles, model.triangles) << model.file;
    EXPECT_EQ(scene.materials.size(), model.materials) << model.file;
    ASSERT_EQ(scene.textures.size(), model.textures) << model.file;
    for (const Texture& texture : scene.textures) {
      EXPECT_TRUE(fs::exists(std::get<ImageTexture>(texture).file));
    }
    expect_near(low, model.low, 1e-4f);
    expect_near(high, model.high, 1e-4f);
    EXPECT_TRUE(scene.environment);
  }
}

}  // namespace
}  // namespace lockstep::test_gltf
