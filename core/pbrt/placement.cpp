#include "core/pbrt/placement.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace lockstep::pbrt {

namespace {

bool is_unit(glm::vec3 n) { return std::abs(glm::dot(n, n) - 1.0f) < 1e-3f; }

// Files have normals of no length; those become smooth ones.
void repair_normals(TriangleMesh& mesh) {
  if (std::all_of(mesh.normals.begin(), mesh.normals.end(), is_unit)) return;
  std::vector<glm::vec3> given = std::move(mesh.normals);
  set_smooth_normals(mesh);
  for (size_t i = 0; i < given.size(); ++i) {
    if (is_unit(given[i])) mesh.normals[i] = given[i];
  }
}

void agree_with_normals(TriangleMesh& mesh) {
  if (mesh.normals.empty()) return;
  for (glm::uvec3& t : mesh.triangles) {
    const glm::vec3 a = mesh.positions[t.x];
    const glm::vec3 face = glm::cross(mesh.positions[t.y] - a, mesh.positions[t.z] - a);
    const glm::vec3 shading = mesh.normals[t.x] + mesh.normals[t.y] + mesh.normals[t.z];
    if (glm::dot(face, shading) < 0.0f) std::swap(t.y, t.z);
  }
}

}  // namespace

void turn_over(TriangleMesh& mesh) {
  for (glm::uvec3& t : mesh.triangles) std::swap(t.y, t.z);
  for (glm::vec3& n : mesh.normals) n = -n;
}

TriangleMesh to_world(TriangleMesh mesh, const Placement& placement) {
  apply_transform(mesh, placement.to_world);
  const auto is_finite = [](glm::vec3 p) {
    return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
  };
  if (!std::all_of(mesh.positions.begin(), mesh.positions.end(), is_finite)) {
    fail(placement.where,
         placement.owner + " has points that leave the range of float in world space");
  }
  repair_normals(mesh);
  if (placement.reverse_orientation) turn_over(mesh);
  agree_with_normals(mesh);
  return mesh;
}

TriangleMesh to_world(TriangleMesh mesh, const ParameterSet& set, const ShapeContext& context) {
  return to_world(std::move(mesh), placement_of(set, context));
}

}  // namespace lockstep::pbrt
