#include "core/pbrt/bilinear.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace lockstep::pbrt {

namespace {

constexpr int curved_segments = 8;

using Corners = std::array<glm::vec3, 4>;  // p00 p10 p01 p11

template <class T>
T bilinear(const std::array<T, 4>& c, float u, float v) {
  return glm::mix(glm::mix(c[0], c[1], u), glm::mix(c[2], c[3], u), v);
}

template <class T>
std::array<T, 4> gather(const std::vector<T>& values, const int* patch) {
  return {values[patch[0]], values[patch[1]], values[patch[2]], values[patch[3]]};
}

bool is_planar(const Corners& p) {
  // The volume of the corners' tetrahedron, against its edges.
  const glm::vec3 a = p[3] - p[0], b = p[2] - p[1], c = p[1] - p[0];
  const float extent = std::max({glm::length(a), glm::length(b), glm::length(c)});
  return std::abs(glm::dot(glm::cross(a / extent, b / extent), c / extent)) < 1e-4f ||
         !(extent > 0.0f);
}

glm::vec3 surface_normal(const Corners& p, float u, float v) {
  const glm::vec3 dpdu = glm::mix(p[1] - p[0], p[3] - p[2], v);
  const glm::vec3 dpdv = glm::mix(p[2] - p[0], p[3] - p[1], u);
  const glm::vec3 n = glm::cross(dpdu, dpdv);
  // Where a side has shrunk to a point: the normal between the diagonals.
  return glm::length(n) > 0.0f ? n : glm::cross(p[3] - p[0], p[2] - p[1]);
}

void append_grid(const TriangleMesh& vertices, const int* patch, int segments, bool own_normals,
                 TriangleMesh& out) {
  const Corners corners = gather(vertices.positions, patch);
  const auto first = static_cast<unsigned>(out.positions.size());
  const auto stride = static_cast<unsigned>(segments + 1);
  for (int row = 0; row <= segments; ++row) {
    for (int column = 0; column <= segments; ++column) {
      const float u = static_cast<float>(column) / static_cast<float>(segments);
      const float v = static_cast<float>(row) / static_cast<float>(segments);
      out.positions.push_back(bilinear(corners, u, v));
      if (own_normals) {
        out.normals.push_back(surface_normal(corners, u, v));
      } else if (!vertices.normals.empty()) {
        out.normals.push_back(bilinear(gather(vertices.normals, patch), u, v));
      }
      out.uvs.push_back(vertices.uvs.empty() ? glm::vec2(u, v)
                                             : bilinear(gather(vertices.uvs, patch), u, v));
    }
  }
  for (unsigned row = 0; row + 1 < stride; ++row) {
    for (unsigned column = 0; column + 1 < stride; ++column) {
      const unsigned p00 = first + row * stride + column;
      const unsigned p10 = p00 + 1, p01 = p00 + stride, p11 = p01 + 1;
      out.triangles.emplace_back(p00, p10, p11);
      out.triangles.emplace_back(p00, p11, p01);
    }
  }
}

}  // namespace

TriangleMesh triangulate_patches(const TriangleMesh& vertices, const std::vector<int>& patches) {
  const size_t count = patches.size() / 4;
  std::vector<bool> planar(count);
  for (size_t i = 0; i < count; ++i) {
    planar[i] = is_planar(gather(vertices.positions, &patches[4 * i]));
  }
  const bool curved = std::find(planar.begin(), planar.end(), false) != planar.end();
  TriangleMesh mesh;
  for (size_t i = 0; i < count; ++i) {
    append_grid(vertices, &patches[4 * i], planar[i] ? 1 : curved_segments,
                curved && vertices.normals.empty(), mesh);
  }
  return mesh;
}

}  // namespace lockstep::pbrt
