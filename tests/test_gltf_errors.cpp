// The glTF reader: broken files.
#include "tests/t_gltf.h"

#include <algorithm>
#include <limits>
#include <random>
#include <string>
#include <variant>
#include <vector>

namespace lockstep::test_gltf_errors {
namespace {

// --- Broken files

TEST_F(Gltf, FilesThatAreNotGltf) {
  expect_error("", "not a glTF file");
  expect_error("[]", "not a glTF file");
  expect_error("{\"asset\":{\"version\":\"2.0\"", "not a glTF file, or damaged");
  expect_error("{}", "\"asset\" is missing");
  expect_error("{\"asset\":{\"version\":\"1.0\"}}", "glTF version 1.0 is not understood");
  expect_error("{\"asset\":{\"version\":\"2.0\",\"minVersion\":\"2.1\"}}", "glTF version 2.1");
  expect_error("{\"asset\":{\"version\":\"2.0\"},\"nodes\":[1]}", "nodes");
  expect_error("{\"asset\":{\"version\":\"2.0\"},\"buffers\":[1]}", "buffers");
  const std::string deep(100000, '[');
  expect_error("{\"asset\":{\"version\":\"2.0\",\"extras\":" + deep, "nested more than 100 deep");
  EXPECT_THROW(read_gltf(path("missing.gltf")), Error);
  EXPECT_THROW(read_gltf(directory_.string()), Error);
}

TEST_F(Gltf, BuffersThatAreMissingOrShort) {
  const auto with_buffer = [](const std::string& members) {
    return "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{" + members + "}]}";
  };
  expect_error(with_buffer("\"byteLength\":8,\"uri\":\"no.bin\""), "buffer 0: cannot read no.bin");
  expect_error(with_buffer("\"byteLength\":8"), "buffer 0 has no URI");
  expect_error(with_buffer("\"uri\":\"no.bin\""), "buffer 0 needs a byteLength");
  expect_error(with_buffer("\"byteLength\":-1,\"uri\":\"no.bin\""), "buffer 0 needs a byteLength");
  expect_error(with_buffer("\"byteLength\":8,\"uri\":\"data:;base64,AAAA\""),
               "buffer 0 has 3 bytes, but its byteLength is 8");
  expect_error(with_buffer("\"byteLength\":99999999999999,\"uri\":\"data:;base64,AAAA\""),
               "byteLength is 99999999999999");
  expect_error(with_buffer("\"byteLength\":3,\"uri\":\"data:;base64,A*AA\""), "malformed data URI");
  expect_error(with_buffer("\"byteLength\":3,\"uri\":\"data:nothing\""), "malformed data URI");
  write("short.bin", "123");
  expect_error(with_buffer("\"byteLength\":4,\"uri\":\"short.bin\""), "buffer 0 has 3 bytes");
  expect_error(with_buffer("\"byteLength\":4,\"uri\":\"/dev/zero\""), "cannot read /dev/zero");
}

TEST_F(Gltf, AccessorsThatDoNotFit) {
  const auto file = [](const std::string& views, const std::string& accessor,
                       const std::string& primitive = "\"attributes\":{\"POSITION\":0}") {
    return "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"byteLength\":36,\"uri\":\"data:;"
           "base64," +
           base64(raw(corner_positions)) + "\"}],\"bufferViews\":[" + views + "],\"accessors\":[{" +
           accessor + "}]," + one_mesh(primitive) + "}";
  };
  const std::string view = "{\"buffer\":0,\"byteLength\":36}";
  const std::string vec3 = "\"componentType\":5126,\"type\":\"VEC3\",\"count\":";
  const std::string here = "mesh 0 primitive 0: POSITION: accessor 0";
  expect_error(file(view, "\"bufferView\":0," + vec3 + "4"), here);
  expect_error(file(view, "\"bufferView\":0," + vec3 + "4"),
               "needs 4 elements, but bufferView 0 holds 3");
  expect_error(file(view, "\"bufferView\":0," + vec3 + "18446744073709551615"), "holds 3");
  expect_error(file(view, "\"bufferView\":0,\"byteOffset\":12," + vec3 + "3"), "holds 2");
  expect_error(file(view, "\"bufferView\":0,\"byteOffset\":18446744073709551604," + vec3 + "3"),
               "holds 0");
  expect_error(file(view, "\"bufferView\":1," + vec3 + "3"), "bufferView 1 does not exist");
  expect_error(file(view, "\"bufferView\":-7," + vec3 + "300000000"), "without a bufferView");
  expect_error(file("{\"buffer\":0,\"byteLength\":37}", "\"bufferView\":0," + vec3 + "3"),
               "reaches past the end of its buffer");
  expect_error(file("{\"buffer\":0,\"byteLength\":36,\"byteOffset\":18446744073709551600}",
                    "\"bufferView\":0," + vec3 + "3"),
               "reaches past the end of its buffer");
  expect_error(file("{\"buffer\":2,\"byteLength\":36}", "\"bufferView\":0," + vec3 + "3"),
               "refers to a buffer that does not exist");
  expect_error(
      file("{\"buffer\":0,\"byteLength\":36,\"byteStride\":16}", "\"bufferView\":0," + vec3 + "3"),
      "holds 2");
  expect_error(file(view, "\"bufferView\":0,\"componentType\":5124,\"type\":\"VEC3\",\"count\":3"),
               "unknown componentType 5124");
  expect_error(file(view, "\"bufferView\":0,\"componentType\":5126,\"type\":\"VEC2\",\"count\":3"),
               "should have 3 components");
  expect_error(file(view, "\"bufferView\":0," + vec3 + "3", "\"attributes\":{\"POSITION\":9}"),
               "accessor 9 does not exist");
  expect_error(
      file(view, "\"bufferView\":0," + vec3 + "3", "\"attributes\":{\"POSITION\":0},\"indices\":0"),
      "indices: accessor 0 should have 1 components");
  for (const char* sparse : {"\"count\":4,\"indices\":{\"bufferView\":0,\"componentType\":5125}",
                             "\"count\":-1,\"indices\":{\"bufferView\":0,\"componentType\":5125}",
                             "\"count\":2,\"indices\":{\"bufferView\":0,\"componentType\":5126}",
                             "\"count\":2,\"indices\":{\"bufferView\":0,\"componentType\":5125}",
                             "\"count\":1,\"indices\":{\"bufferView\":0,\"byteOffset\":-4,"
                             "\"componentType\":5125}"}) {
    expect_error(file(view, vec3 + "3,\"sparse\":{" + std::string(sparse) +
                                ",\"values\":{\"bufferView\":0}}"),
                 here);
  }
}

TEST_F(Gltf, MeshesThatAreWrong) {
  GltfBuffer buffer;
  buffer.add("VEC3", corner_positions);
  buffer.add("SCALAR", std::vector<std::uint16_t>{0, 1, 3});
  buffer.add("SCALAR", std::vector<std::uint16_t>{0, 1, 2, 0});
  buffer.add("VEC3",
             std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, std::numeric_limits<float>::infinity()});
  buffer.add("VEC2", std::vector<float>{0, 0, 1, 1});
  buffer.add("SCALAR", std::vector<float>{0, 1, 2});
  const auto expect = [&](const std::string& primitive, const std::string& part) {
    expect_error(buffer.embedded(one_mesh(primitive)), part);
    expect_error(buffer.embedded(one_mesh(primitive)), "mesh 0 primitive 0");
  };
  expect("\"attributes\":{\"POSITION\":0},\"indices\":1",
         "index 3 is out of range; there are 3 vertices");
  expect("\"attributes\":{\"POSITION\":0},\"indices\":2", "has 4 corners");
  expect("\"attributes\":{\"POSITION\":3}", "POSITION has a value that is not finite");
  expect("\"attributes\":{\"POSITION\":0,\"TEXCOORD_0\":4}",
         "TEXCOORD_0 has 2 elements for 3 vertices");
  expect("\"attributes\":{\"POSITION\":0},\"indices\":5", "indices must be unsigned integers");
  expect("\"attributes\":{\"POSITION\":0},\"mode\":9", "unknown mode 9");
  expect_error(buffer.embedded(one_mesh("\"attributes\":{\"POSITION\":0},\"material\":0")),
               "material 0 does not exist");
  // Without attributes a primitive would be dropped and the others renumbered.
  expect_error(buffer.embedded(one_mesh("\"indices\":1")), "attributes");
}

TEST_F(Gltf, NodesThatAreWrong) {
  const auto expect = [&](const std::string& rest, const std::string& part) {
    expect_error(triangle_file(rest), part);
  };
  const std::string scene = ",\"scenes\":[{\"nodes\":[0]}]";
  expect("\"nodes\":[{\"children\":[1]},{\"children\":[0]}]" + scene, "node 0 has two parents");
  expect("\"nodes\":[{\"children\":[0],\"name\":\"a\\nb\"}]" + scene,
         "node 0 (a b) has two parents");
  expect("\"nodes\":[{\"children\":[1,1]},{}]" + scene, "node 1 has two parents");
  expect("\"nodes\":[{\"children\":[5]}]" + scene, "node 5 does not exist");
  expect("\"nodes\":[{\"children\":[-1]}]" + scene, "node -1 does not exist");
  expect("\"nodes\":[{\"mesh\":3}]" + scene, "node 0: mesh 3 does not exist");
  expect("\"nodes\":[{}],\"scene\":4" + scene, "scene 4 does not exist");
  expect("\"nodes\":[{\"matrix\":[1,2]}]" + scene, "node 0 needs 16 numbers as its matrix");
  expect("\"nodes\":[{\"scale\":[1,2]}]" + scene, "node 0 needs 3 numbers as its scale");
  expect("\"nodes\":[{\"rotation\":[0,0,0,0]}]" + scene, "node 0 has a rotation of zeros");
  expect("\"nodes\":[{\"mesh\":0,\"scale\":[1e39,1,1]}]" + scene, "node 0");
  expect(
      "\"nodes\":[{\"mesh\":0,\"scale\":[1e25,1e25,1e25],\"children\":[1]},"
      "{\"scale\":[1e25,1e25,1e25]}]" +
          scene,
      "node 1 leaves the range");
  const std::string lights =
      "\"extensions\":{\"KHR_lights_punctual\":{\"lights\":[{\"type\":\"spot\","
      "\"spot\":{\"innerConeAngle\":2}}]}},";
  const auto light = [](int i) {
    return "\"nodes\":[{\"extensions\":{\"KHR_lights_punctual\":{\"light\":" + std::to_string(i) +
           "}}}]";
  };
  expect(lights + light(0), "light 0 needs cone angles");
  expect(lights + light(1), "node 0: light 1 does not exist");
  const auto camera = [](const std::string& values) {
    return "\"nodes\":[{\"camera\":0}],\"cameras\":[{\"type\":\"perspective\",\"perspective\":{" +
           values + "}}]";
  };
  expect(camera("\"yfov\":4,\"znear\":1"), "camera 0 needs a yfov between 0 and pi");
  expect(camera("\"yfov\":1,\"znear\":1,\"aspectRatio\":1e9"), "times as wide as high");
  expect("\"nodes\":[{\"camera\":2}]", "camera 2 does not exist");
}

// --- Any bytes at all

std::string whole_file() {
  GltfBuffer buffer;
  buffer.add("VEC3", corner_positions);
  buffer.add("SCALAR", std::vector<std::uint16_t>{0, 1, 2});
  buffer.add("VEC2", std::vector<float>{0, 0, 1, 0, 0, 1});
  return buffer.container(
      "\"images\":[{\"bufferView\":0,\"mimeType\":\"image/png\"}],\"samplers\":[{\"wrapS\":33071}],"
      "\"textures\":[{\"source\":0,\"sampler\":0}],\"materials\":[{\"pbrMetallicRoughness\":"
      "{\"baseColorTexture\":{\"index\":0}},\"extensions\":{\"KHR_materials_ior\":{\"ior\":1.3}}}],"
      "\"cameras\":[{\"type\":\"perspective\",\"perspective\":{\"yfov\":1,\"znear\":1}}]," +
      std::string(
          "\"nodes\":[{\"mesh\":0,\"children\":[1]},{\"camera\":0}],\"scenes\":[{\"nodes\":[0]}],"
          "\"meshes\":[") +
      mesh("\"attributes\":{\"POSITION\":0,\"TEXCOORD_0\":2},\"indices\":1,\"material\":0") + "]");
}

TEST_F(Gltf, CutFilesGiveErrors) {
  const std::string bytes = whole_file();
  EXPECT_EQ(read(bytes).shapes.size(), 1u);
  for (size_t size = 0; size < bytes.size(); size += 3) {
    EXPECT_THROW(read(bytes.substr(0, size)), Error) << size;
  }
  expect_error(bytes.substr(0, 10), "header is cut short");
  expect_error(bytes.substr(0, 100), "but its header says");
}

TEST_F(Gltf, DamagedFilesGiveErrorsOrScenes) {
  const std::string bytes = whole_file();
  std::mt19937 random(7);
  int errors = 0;
  constexpr int files = 600;
  for (int i = 0; i < files; ++i) {
    std::string damaged = bytes;
    for (int k = 0; k <= i % 3; ++k) {
      const size_t at = random() % damaged.size();
      // Digits elsewhere keep the JSON whole more often than any byte would.
      const bool is_digit = damaged[at] >= '0' && damaged[at] <= '9';
      damaged[at] = static_cast<char>(is_digit ? '0' + random() % 10 : random() % 256);
    }
    try {
      const SceneDescription scene = read(damaged);
      for (const Shape& shape : scene.shapes) {
        const auto& m = std::get<TriangleMesh>(shape.geometry);
        for (const glm::uvec3 t : m.triangles) {
          ASSERT_LT(std::max({t.x, t.y, t.z}), m.positions.size());
        }
      }
    } catch (const Error& error) {
      ++errors;
      ASSERT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    }
  }
  EXPECT_GT(errors, files / 4);
  EXPECT_LT(errors, files);
}

}  // namespace
}  // namespace lockstep::test_gltf_errors
