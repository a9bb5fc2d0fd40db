#include "core/builtin/branches.h"

#include "core/builtin/noise.h"
#include "core/builtin/parts.h"

#include <glm/geometric.hpp>

#include <array>
#include <utility>

namespace lockstep::builtin {
namespace {

// The control mesh while it grows; a branch owns the triangle that caps it.
class Colony {
 public:
  explicit Colony(const BranchStyle& style) : style_(style), mesh_(icosphere(0)) {
    for (glm::vec3& p : mesh_.positions) p *= 1.3f * style.radius;
  }

  TriangleMesh grow() {
    const size_t base_faces = mesh_.triangles.size();
    for (size_t face = 0; face < base_faces; ++face) {
      const glm::vec3 direction = glm::normalize(center(face));
      if (direction.y > 0.15f) grow_branch(face, direction, style_.length, style_.radius, 1);
    }
    return std::move(mesh_);
  }

 private:
  glm::vec3& corner(size_t face, int i) { return mesh_.positions[mesh_.triangles[face][i]]; }
  glm::vec3 center(size_t face) {
    return (corner(face, 0) + corner(face, 1) + corner(face, 2)) / 3.0f;
  }
  glm::vec3 normal(size_t face) {
    return glm::normalize(
        glm::cross(corner(face, 1) - corner(face, 0), corner(face, 2) - corner(face, 0)));
  }
  float jitter() { return 2.0f * random_number(style_.seed + next_random_++) - 1.0f; }
  glm::vec3 random_offset() { return {jitter(), jitter(), jitter()}; }

  // Replaces the cap by a prism that ends at `end`, across `direction`, and is capped there.
  void extrude(size_t cap, glm::vec3 end, glm::vec3 direction, float radius) {
    const glm::uvec3 from = mesh_.triangles[cap];
    const glm::vec3 start = center(cap);
    const auto first = uint32_t(mesh_.positions.size());
    for (int i = 0; i < 3; ++i) {
      const glm::vec3 arm = mesh_.positions[from[i]] - start;
      const glm::vec3 across = arm - direction * glm::dot(arm, direction);
      mesh_.positions.push_back(end + radius * glm::normalize(across));
    }
    for (uint32_t i = 0; i < 3; ++i) {
      const uint32_t j = (i + 1) % 3;
      mesh_.triangles.push_back({from[i], from[j], first + j});
      mesh_.triangles.push_back({from[i], first + j, first + i});
    }
    mesh_.triangles[cap] = {first, first + 1, first + 2};
  }

  // Raises a point over the cap; returns the three faces around it.
  std::array<size_t, 3> fork(size_t cap, glm::vec3 point) {
    const glm::uvec3 t = mesh_.triangles[cap];
    const auto apex = uint32_t(mesh_.positions.size());
    mesh_.positions.push_back(point);
    mesh_.triangles[cap] = {t.x, t.y, apex};
    mesh_.triangles.push_back({t.y, t.z, apex});
    mesh_.triangles.push_back({t.z, t.x, apex});
    return {cap, mesh_.triangles.size() - 2, mesh_.triangles.size() - 1};
  }

  void grow_branch(size_t cap, glm::vec3 direction, float length, float radius, int generation) {
    const int segments = 3;
    for (int s = 0; s < segments; ++s) {
      direction = glm::normalize(direction + glm::vec3(0, 0.12f, 0) + 0.12f * random_offset());
      const float taper = s + 1 == segments && generation == style_.generations ? 0.6f : 1.0f;
      extrude(cap, center(cap) + direction * (length / float(segments)), direction, radius * taper);
    }
    if (generation == style_.generations) return;
    const auto faces = fork(cap, center(cap) + 0.6f * radius * direction);
    for (const size_t face : faces) {
      if (generation > 1 && jitter() > 0.6f) continue;  // some buds never grow
      const glm::vec3 outwards = normal(face) - direction * glm::dot(normal(face), direction);
      const glm::vec3 lean = style_.spread * glm::normalize(outwards) + 0.2f * random_offset();
      grow_branch(face, glm::normalize(direction + lean), length * style_.shrink,
                  radius * style_.shrink, generation + 1);
    }
  }

  BranchStyle style_;
  TriangleMesh mesh_;
  unsigned next_random_ = 0;
};

}  // namespace

TriangleMesh branches(const BranchStyle& style) { return Colony(style).grow(); }

}  // namespace lockstep::builtin
