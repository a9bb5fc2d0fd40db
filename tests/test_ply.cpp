// PLY files: each format, what is skipped, and what broken files give.
#include "core/ply.h"

#include "tests/t_files.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace lockstep::test_ply {
namespace {

class Ply : public TestWithFiles {
 protected:
  TriangleMesh read(const std::string& bytes) const { return read_ply(write("mesh.ply", bytes)); }
};

template <class T>
void append(std::string& bytes, T value, bool big_endian) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  if (big_endian != (std::endian::native == std::endian::big)) {
    std::reverse(raw, raw + sizeof(T));
  }
  bytes.append(raw, sizeof(T));
}

const std::string triangle_header =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
    "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";

TEST_F(Ply, AsciiWithEverything) {
  const TriangleMesh mesh = read(
      "ply\r\nformat ascii 1.0\r\ncomment made by hand\r\nobj_info none\r\n"
      "element vertex 4\r\nproperty double x\r\nproperty double y\r\nproperty double z\r\n"
      "property float nx\r\nproperty float ny\r\nproperty float nz\r\nproperty uchar red\r\n"
      "property float u\r\nproperty float v\r\n"
      "element edge 2\r\nproperty int a\r\nproperty list uchar short b\r\n"
      "element face 1\r\nproperty uchar flags\r\nproperty list uchar uint vertex_index\r\n"
      "end_header\r\n"
      "0 0 0  0 0 1  255  0 0\r\n1 0 0  0 0 1  255  1 0\r\n+1 1 0  0 0 1  255  1 1\r\n"
      "0 1e0 1e-400  0 0 1  255  0 1\r\n"
      "7 2 1 2\r\n8 0\r\n"
      "3 4 0 1 2 3\r\n");
  ASSERT_EQ(mesh.positions.size(), 4u);
  EXPECT_EQ(mesh.positions[2], glm::vec3(1, 1, 0));
  EXPECT_EQ(mesh.positions[3], glm::vec3(0, 1, 0));
  ASSERT_EQ(mesh.normals.size(), 4u);
  ASSERT_EQ(mesh.uvs.size(), 4u);
  EXPECT_EQ(mesh.uvs[2], glm::vec2(1, 1));
  ASSERT_EQ(mesh.triangles.size(), 2u);
  EXPECT_EQ(mesh.triangles[0], glm::uvec3(0, 1, 2));
  EXPECT_EQ(mesh.triangles[1], glm::uvec3(0, 2, 3));
}

TEST_F(Ply, BinaryOfBothByteOrdersAndCountTypes) {
  for (const bool big : {false, true}) {
    for (const bool wide_count : {false, true}) {
      std::string bytes = std::string("ply\nformat binary_") + (big ? "big" : "little") +
                          "_endian 1.0\nelement vertex 5\nproperty float x\nproperty float y\n"
                          "property float z\nproperty short skipped\nelement face 2\n"
                          "property list " +
                          (wide_count ? "uint ushort" : "uchar int") +
                          " vertex_indices\nend_header\n";
      for (int i = 0; i < 5; ++i) {
        for (int axis = 0; axis < 3; ++axis) {
          append(bytes, static_cast<float>(10 * i + axis) + 0.5f, big);
        }
        append(bytes, std::int16_t{-3}, big);
      }
      const std::vector<std::vector<int>> faces = {{0, 1, 2}, {4, 3, 2, 1, 0}};
      for (const std::vector<int>& face : faces) {
        if (wide_count) {
          append(bytes, static_cast<std::uint32_t>(face.size()), big);
          for (const int i : face) append(bytes, static_cast<std::uint16_t>(i), big);
        } else {
          append(bytes, static_cast<std::uint8_t>(face.size()), big);
          for (const int i : face) append(bytes, static_cast<std::int32_t>(i), big);
        }
      }
      const TriangleMesh mesh = read(bytes);
      ASSERT_EQ(mesh.positions.size(), 5u);
      EXPECT_EQ(mesh.positions[4], glm::vec3(40.5f, 41.5f, 42.5f));
      ASSERT_EQ(mesh.triangles.size(), 4u);
      EXPECT_EQ(mesh.triangles[3], glm::uvec3(4, 1, 0));

      for (size_t cut = bytes.find("end_header") + 11; cut < bytes.size(); ++cut) {
        EXPECT_THROW(read(bytes.substr(0, cut)), Error) << cut;
      }
    }
  }
}

// Rows of floats and plain faces are taken whole; what is wrong with one must still be told.
TEST_F(Ply, BrokenBinaryRowsSayWhat) {
  const auto file = [](float coordinate, std::vector<std::int32_t> face) {
    std::string bytes =
        "ply\nformat binary_little_endian 1.0\nelement vertex 4\nproperty float x\n"
        "property float y\nproperty float z\nelement face 2\n"
        "property list uchar int vertex_indices\nend_header\n";
    for (int i = 0; i < 12; ++i) append(bytes, i == 7 ? coordinate : 1.0f, false);
    for (const std::vector<std::int32_t>& corners : {std::vector<std::int32_t>{0, 1, 2}, face}) {
      append(bytes, static_cast<std::uint8_t>(corners.size()), false);
      for (const std::int32_t i : corners) append(bytes, i, false);
    }
    return bytes;
  };
  const auto message = [&](const std::string& bytes) { return error_of([&] { read(bytes); }); };
  EXPECT_EQ(read(file(-1e18f, {3, 2, 1, 0})).triangles.size(), 3u);
  expect_one_line_with(message(file(NAN, {0, 1, 2})), "a coordinate that is not finite");
  expect_one_line_with(message(file(INFINITY, {0, 1, 2})), "a coordinate that is not finite");
  expect_one_line_with(message(file(-2e18f, {0, 1, 2})), "a coordinate beyond 1e18");
  expect_one_line_with(message(file(0.0f, {0, 1, 4})), "face 1 refers to a vertex");
  expect_one_line_with(message(file(0.0f, {0, 1, 2, -1})), "face 1 refers to a vertex");
  expect_one_line_with(message(file(0.0f, {0, 1})), "face 1 has fewer than three vertices");
}

TEST_F(Ply, BrokenFilesSayWhereAndWhat) {
  struct Case {
    std::string bytes, message;
  };
  const auto replaced = [](std::string text, const std::string& from, const std::string& to) {
    return text.replace(text.find(from), from.size(), to);
  };
  const std::string points = "0 0 0\n1 0 0\n0 1 0\n";
  const Case cases[] = {
      {"", "mesh.ply:1: the PLY header has no end_header"},
      {"solid x\n", "mesh.ply:1: not a PLY file"},
      {"ply\nformat ascii 1.0\n", "mesh.ply:3: the PLY header has no end_header"},
      {"ply\nformat ebcdic 1.0\n", "mesh.ply:2: expected \"format"},
      {"ply\nformat ascii 1.0\nelement vertex x\n", ":3: expected \"element NAME COUNT\""},
      {"ply\nproperty float x\n", ":2: unexpected \"property\""},
      {replaced(triangle_header, "float y", "floaty y"), ":5: unknown type \"floaty\""},
      {replaced(triangle_header, "property float z\n", "") + points, "vertices lack x, y or z"},
      {replaced(triangle_header, "vertex_indices", "corners") + points + "3 0 1 2",
       "faces lack the list vertex_indices"},
      {replaced(triangle_header, "element vertex 3", "element vertex 4000000000"), "too short"},
      {triangle_header + "0 0 0\n1 0 zero\n", "mesh.ply:11: expected a number, found \"zero\""},
      {triangle_header + "0 0 0\n1 0 nan\n0 1 0\n3 0 1 2\n", "mesh.ply:11: a vertex has a coord"},
      {triangle_header + "0 0 0\n1 0 1e99\n0 1 0\n3 0 1 2\n", "mesh.ply:11: a vertex has a coord"},
      {triangle_header + points + "3 0 1 3\n", "mesh.ply:13: face 0 refers to a vertex"},
      {triangle_header + points + "3 0 1 -1\n", "mesh.ply:13: face 0 refers to a vertex"},
      {triangle_header + points + "2 0 1\n", "mesh.ply:13: face 0 has fewer than three vertices"},
      {triangle_header + points + "-1 0 1 2\n", "mesh.ply:13: the length of list"},
      {triangle_header + points + "3 0 1\n", "the file ends before its last element"},
  };
  for (const Case& c : cases) expect_one_line_with(error_of([&] { read(c.bytes); }), c.message);
  EXPECT_THROW(read_ply(path("absent.ply")), Error);
}

}  // namespace
}  // namespace lockstep::test_ply
