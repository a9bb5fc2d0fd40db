#include "core/mitsuba/primitives.h"

#include <glm/geometric.hpp>

#include <cmath>
#include <numbers>

namespace lockstep::mitsuba {
namespace {

constexpr int around = 128;

struct Vertex {
  glm::vec3 position, normal;
};

// The surface `at(u, v)` over [0, 1]^2 as a grid of quads, halved; corners that coincide, as at
// poles, leave a single triangle. The winding follows the normals.
template <class Surface>
TriangleMesh grid_mesh(int columns, int rows, const Surface& at) {
  TriangleMesh mesh;
  for (int row = 0; row <= rows; ++row) {
    for (int column = 0; column <= columns; ++column) {
      const float u = float(column) / float(columns), v = float(row) / float(rows);
      const Vertex vertex = at(u, v);
      mesh.positions.push_back(vertex.position);
      mesh.normals.push_back(vertex.normal);
      mesh.uvs.emplace_back(u, v);
    }
  }
  const auto add_triangle = [&](unsigned a, unsigned b, unsigned c) {
    const glm::vec3 p = mesh.positions[a], q = mesh.positions[b], r = mesh.positions[c];
    if (p == q || q == r || r == p) return;
    if (glm::dot(glm::cross(q - p, r - p), mesh.normals[a] + mesh.normals[b]) < 0.0f) {
      std::swap(b, c);
    }
    mesh.triangles.emplace_back(a, b, c);
  };
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const auto a = unsigned(row * (columns + 1) + column);
      const unsigned b = a + 1, c = a + unsigned(columns) + 2, d = c - 1;
      add_triangle(a, b, c);
      add_triangle(a, c, d);
    }
  }
  return mesh;
}

// The point at `turns` of the unit circle; whole turns meet exactly.
glm::vec2 on_circle(float turns) {
  const double angle = 2.0 * std::numbers::pi * double(turns == 1.0f ? 0.0f : turns);
  return {float(std::cos(angle)), float(std::sin(angle))};
}

}  // namespace

TriangleMesh rectangle_mesh() {
  TriangleMesh mesh;
  mesh.uvs.reserve(4);
  mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

TriangleMesh cube_mesh() {
  TriangleMesh mesh;
  // The normals of the sides, and where u grows.
  constexpr glm::vec3 sides[6][2] = {{{0, -1, 0}, {0, 0, 1}}, {{0, 1, 0}, {-1, 0, 0}},
                                     {{1, 0, 0}, {0, 1, 0}},  {{0, 0, 1}, {0, 1, 0}},
                                     {{-1, 0, 0}, {0, 1, 0}}, {{0, 0, -1}, {0, -1, 0}}};
  for (const auto& [normal, u] : sides) {
    const auto first = unsigned(mesh.positions.size());
    const glm::vec3 v = glm::cross(u, normal);  // downwards, against the winding
    for (const glm::vec2 uv :
         {glm::vec2(0, 1), glm::vec2(1, 1), glm::vec2(1, 0), glm::vec2(0, 0)}) {
      mesh.positions.push_back(normal + (2.0f * uv.x - 1.0f) * u + (2.0f * uv.y - 1.0f) * v);
      mesh.uvs.push_back(uv);
    }
    mesh.triangles.emplace_back(first, first + 1, first + 2);
    mesh.triangles.emplace_back(first + 3, first, first + 2);
  }
  return mesh;
}

TriangleMesh sphere_mesh() {
  return grid_mesh(around, around / 2, [](float u, float v) {
    const glm::vec2 c = on_circle(u);
    const float height = on_circle(0.5f * v).x;
    const float ring = v == 0.0f || v == 1.0f ? 0.0f : on_circle(0.5f * v).y;
    const glm::vec3 p(ring * c.x, ring * c.y, height);
    return Vertex{p, p};
  });
}

TriangleMesh disk_mesh() {
  TriangleMesh mesh = grid_mesh(1, around, [](float u, float v) {
    const glm::vec2 c = u * on_circle(v);
    return Vertex{glm::vec3(c.x, c.y, 0.0f), glm::vec3(0.0f, 0.0f, 1.0f)};
  });
  mesh.normals.clear();
  return mesh;
}

TriangleMesh cylinder_mesh(glm::vec3 p0, glm::vec3 p1, float radius) {
  const glm::vec3 axis = glm::normalize(p1 - p0);
  const glm::vec3 other = std::abs(axis.x) < 0.5f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0);
  const glm::vec3 x = glm::normalize(glm::cross(other, axis)), y = glm::cross(axis, x);
  return grid_mesh(around, 1, [&](float u, float v) {
    const glm::vec2 c = on_circle(u);
    const glm::vec3 outwards = c.x * x + c.y * y;
    return Vertex{p0 + v * (p1 - p0) + radius * outwards, outwards};
  });
}

}  // namespace lockstep::mitsuba
