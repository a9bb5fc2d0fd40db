#include "core/builtin/parts.h"

#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <utility>

namespace lockstep::builtin {
namespace {

// Index of the point half way along edge a-b of a sphere's mesh, added where it is new.
uint32_t midpoint(TriangleMesh& mesh, std::unordered_map<uint64_t, uint32_t>& known, uint32_t a,
                  uint32_t b) {
  const uint64_t edge = uint64_t(std::min(a, b)) << 32 | std::max(a, b);
  const auto [entry, is_new] = known.try_emplace(edge, uint32_t(mesh.positions.size()));
  if (is_new) {
    mesh.positions.push_back(glm::normalize(mesh.positions[a] + mesh.positions[b]));
  }
  return entry->second;
}

TriangleMesh icosahedron() {
  const float g = 0.5f * (1.0f + std::sqrt(5.0f));
  TriangleMesh mesh;
  mesh.positions = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                    {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  for (glm::vec3& p : mesh.positions) p = glm::normalize(p);
  mesh.triangles = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                    {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                    {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                    {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
  return mesh;
}

}  // namespace

glm::mat4 look_at(glm::vec3 eye, glm::vec3 target) {
  const glm::vec3 forward = glm::normalize(target - eye);
  const glm::vec3 right = glm::normalize(glm::cross(forward, glm::vec3(0, 1, 0)));
  const glm::vec3 up = glm::cross(right, forward);
  return glm::mat4(glm::vec4(right, 0), glm::vec4(up, 0), glm::vec4(forward, 0), glm::vec4(eye, 1));
}

int add_material(SceneDescription& scene, const Material& material) {
  scene.materials.push_back(material);
  return int(scene.materials.size()) - 1;
}

void add_mesh(SceneDescription& scene, TriangleMesh mesh, int material) {
  scene.shapes.push_back({std::move(mesh), material, {}});
}

void add_sphere(SceneDescription& scene, glm::vec3 center, float radius, int material,
                std::optional<Emission> emission) {
  scene.shapes.push_back({Sphere{center, radius}, material, emission});
}

void add_rectangle(SceneDescription& scene, glm::vec3 center, glm::vec3 a, glm::vec3 b,
                   int material, std::optional<Emission> emission) {
  TriangleMesh mesh;
  add_quad(mesh, center - a - b, center + a - b, center + a + b, center - a + b);
  scene.shapes.push_back({std::move(mesh), material, emission});
}

void add_box(SceneDescription& scene, glm::vec3 base, glm::vec3 size, float degrees, int material) {
  TriangleMesh mesh;
  // Each side: the axis it faces and the two that span it, in right-handed order.
  for (int axis = 0; axis < 3; ++axis) {
    for (const float side : {-0.5f, 0.5f}) {
      glm::vec3 n(0), a(0), b(0);
      n[axis] = side;
      a[(axis + 1) % 3] = side;  // its sign turns the winding with the side
      b[(axis + 2) % 3] = 0.5f;
      add_quad(mesh, n - a - b, n + a - b, n + a + b, n - a + b);
    }
  }
  place(mesh, base + glm::vec3(0, 0.5f * size.y, 0), size, degrees);
  add_mesh(scene, std::move(mesh), material);
}

TriangleMesh icosphere(int levels) {
  TriangleMesh mesh = icosahedron();
  for (int level = 0; level < levels; ++level) {
    std::unordered_map<uint64_t, uint32_t> known;
    known.reserve(mesh.triangles.size() * 3 / 2);
    std::vector<glm::uvec3> finer;
    finer.reserve(mesh.triangles.size() * 4);
    for (const glm::uvec3& t : mesh.triangles) {
      const uint32_t ab = midpoint(mesh, known, t.x, t.y);
      const uint32_t bc = midpoint(mesh, known, t.y, t.z);
      const uint32_t ca = midpoint(mesh, known, t.z, t.x);
      finer.insert(finer.end(), {{t.x, ab, ca}, {ab, t.y, bc}, {ca, bc, t.z}, {ab, bc, ca}});
    }
    mesh.triangles = std::move(finer);
  }
  return mesh;
}

TriangleMesh terrain(int n, float half, const std::function<float(float, float)>& height) {
  TriangleMesh mesh;
  for (int j = 0; j <= n; ++j) {
    for (int i = 0; i <= n; ++i) {
      const float x = half * (2.0f * float(i) / float(n) - 1.0f);
      const float z = half * (2.0f * float(j) / float(n) - 1.0f);
      mesh.positions.push_back({x, height(x, z), z});
    }
  }
  const auto vertex = [n](int i, int j) { return uint32_t(j * (n + 1) + i); };
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      mesh.triangles.push_back({vertex(i, j), vertex(i, j + 1), vertex(i + 1, j + 1)});
      mesh.triangles.push_back({vertex(i, j), vertex(i + 1, j + 1), vertex(i + 1, j)});
    }
  }
  set_smooth_normals(mesh);
  return mesh;
}

void displace(TriangleMesh& mesh, const std::function<float(glm::vec3)>& radius) {
  for (glm::vec3& p : mesh.positions) p *= radius(p);
  set_smooth_normals(mesh);
}

void place(TriangleMesh& mesh, glm::vec3 position, glm::vec3 scale, float degrees) {
  const glm::mat4 moved = glm::translate(glm::mat4(1.0f), position);
  const glm::mat4 turned = glm::rotate(moved, glm::radians(degrees), glm::vec3(0, 1, 0));
  apply_transform(mesh, glm::scale(turned, scale));
}

}  // namespace lockstep::builtin
