#include "core/mesh.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace lockstep {

namespace {

glm::vec3 normalised_or(glm::vec3 v, glm::vec3 fallback) {
  const float length = glm::length(v);
  return length > 0.0f && std::isfinite(length) ? v / length : fallback;
}

// The angle between two directions; stable where they nearly coincide, zero where one has no
// length.
float angle_between(glm::vec3 a, glm::vec3 b) {
  return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

}  // namespace

void add_quad(TriangleMesh& mesh, glm::vec3 p00, glm::vec3 p10, glm::vec3 p11, glm::vec3 p01) {
  const auto first = static_cast<unsigned>(mesh.positions.size());
  const bool with_normals = !mesh.normals.empty();
  const bool with_uvs = !mesh.uvs.empty();

  mesh.positions.insert(mesh.positions.end(), {p00, p10, p11, p01});
  if (with_normals) {
    const glm::vec3 n = normalised_or(glm::cross(p10 - p00, p01 - p00), {0.0f, 0.0f, 1.0f});
    mesh.normals.insert(mesh.normals.end(), 4, n);
  }
  if (with_uvs) {
    mesh.uvs.insert(mesh.uvs.end(), {{0.0f, 0.0f}, {1.0f, 0.0f}, {1.0f, 1.0f}, {0.0f, 1.0f}});
  }
  mesh.triangles.emplace_back(first, first + 1, first + 2);
  mesh.triangles.emplace_back(first, first + 2, first + 3);
}

void apply_transform(TriangleMesh& mesh, const glm::mat4& transform) {
  for (glm::vec3& p : mesh.positions) p = glm::vec3(transform * glm::vec4(p, 1.0f));

  // The inverse transpose, up to a positive factor: cofactors need no division by a small
  // determinant, and its sign keeps mirrored normals on their side. The matrix is scaled first so
  // that neither overflows or vanishes.
  glm::mat3 linear(transform);
  float largest = 0.0f;
  for (int i = 0; i < 9; ++i) largest = std::max(largest, std::abs(linear[i / 3][i % 3]));
  if (largest > 0.0f) linear /= largest;
  const float side = glm::determinant(linear) < 0.0f ? -1.0f : 1.0f;
  const glm::mat3 cofactors(side * glm::cross(linear[1], linear[2]),
                            side * glm::cross(linear[2], linear[0]),
                            side * glm::cross(linear[0], linear[1]));
  for (glm::vec3& n : mesh.normals) n = normalised_or(cofactors * n, n);

  if (side < 0.0f) {
    for (glm::uvec3& t : mesh.triangles) std::swap(t.y, t.z);
  }
}

void set_smooth_normals(TriangleMesh& mesh) {
  mesh.normals.assign(mesh.positions.size(), glm::vec3(0.0f));
  for (const glm::uvec3& t : mesh.triangles) {
    const glm::vec3 p[3] = {mesh.positions[t.x], mesh.positions[t.y], mesh.positions[t.z]};
    const glm::vec3 face = normalised_or(glm::cross(p[1] - p[0], p[2] - p[0]), glm::vec3(0.0f));
    for (int corner = 0; corner < 3; ++corner) {
      const glm::vec3 to_next = p[(corner + 1) % 3] - p[corner];
      const glm::vec3 to_previous = p[(corner + 2) % 3] - p[corner];
      mesh.normals[t[corner]] += angle_between(to_next, to_previous) * face;
    }
  }
  for (glm::vec3& n : mesh.normals) n = normalised_or(n, {0.0f, 0.0f, 1.0f});
}

TriangleMesh tessellated_sphere(float radius, int segments) {
  // Rings of latitude between one vertex at each pole.
  const int columns = std::max(segments, 3);
  const int rings = std::max(columns / 2, 2) - 1;
  TriangleMesh mesh;
  const auto add_vertex = [&](glm::vec3 direction) {
    mesh.positions.push_back(radius * direction);
    mesh.normals.push_back(direction);
  };
  add_vertex({0.0f, 0.0f, 1.0f});
  for (int ring = 0; ring < rings; ++ring) {
    const double theta = std::numbers::pi * (ring + 1) / (rings + 1);
    for (int column = 0; column < columns; ++column) {
      const double phi = 2.0 * std::numbers::pi * column / columns;
      add_vertex(glm::vec3(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                           std::cos(theta)));
    }
  }
  add_vertex({0.0f, 0.0f, -1.0f});

  const auto south = static_cast<unsigned>(mesh.positions.size() - 1);
  const auto vertex = [&](int ring, int column) {
    return static_cast<unsigned>(1 + ring * columns + column % columns);
  };
  for (int column = 0; column < columns; ++column) {
    mesh.triangles.emplace_back(0u, vertex(0, column), vertex(0, column + 1));
    for (int ring = 0; ring + 1 < rings; ++ring) {
      const unsigned upper = vertex(ring, column), upper_next = vertex(ring, column + 1);
      const unsigned lower = vertex(ring + 1, column), lower_next = vertex(ring + 1, column + 1);
      mesh.triangles.emplace_back(upper, lower, lower_next);
      mesh.triangles.emplace_back(upper, lower_next, upper_next);
    }
    mesh.triangles.emplace_back(vertex(rings - 1, column), south, vertex(rings - 1, column + 1));
  }
  return mesh;
}

}  // namespace lockstep
