#include "core/pbrt/revolution.h"

#include <glm/geometric.hpp>

#include <cmath>

namespace lockstep::pbrt {

namespace {

void add_column(const std::vector<ProfilePoint>& profile, double phi, float u, TriangleMesh& mesh) {
  const auto c = static_cast<float>(std::cos(phi)), s = static_cast<float>(std::sin(phi));
  for (const ProfilePoint& p : profile) {
    mesh.positions.emplace_back(p.radius * c, p.radius * s, p.z);
    const glm::vec3 n(p.normal_out * c, p.normal_out * s, p.normal_up);
    mesh.normals.push_back(glm::normalize(n));
    mesh.uvs.emplace_back(u, p.v);
  }
}

// Leaves out what has no area, at the poles, and turns the rest to the normals' side.
void add_triangle(unsigned a, unsigned b, unsigned c, TriangleMesh& mesh) {
  const std::vector<glm::vec3>& p = mesh.positions;
  const glm::vec3 face = glm::cross(p[b] - p[a], p[c] - p[a]);
  const float side = glm::dot(face, mesh.normals[a] + mesh.normals[b] + mesh.normals[c]);
  if (side > 0.0f) mesh.triangles.emplace_back(a, b, c);
  if (side < 0.0f) mesh.triangles.emplace_back(a, c, b);
}

}  // namespace

TriangleMesh revolve(const std::vector<ProfilePoint>& profile, float phi_max, int segments) {
  TriangleMesh mesh;
  for (int i = 0; i <= segments; ++i) {
    const double share = static_cast<double>(i) / segments;
    add_column(profile, share * static_cast<double>(phi_max), static_cast<float>(share), mesh);
  }
  const auto rows = static_cast<unsigned>(profile.size());
  for (unsigned column = 0; column < static_cast<unsigned>(segments); ++column) {
    for (unsigned row = 0; row + 1 < rows; ++row) {
      const unsigned p00 = column * rows + row, p01 = p00 + 1;
      const unsigned p10 = p00 + rows, p11 = p10 + 1;
      add_triangle(p00, p10, p11, mesh);
      add_triangle(p00, p11, p01, mesh);
    }
  }
  return mesh;
}

}  // namespace lockstep::pbrt
