// Mesh operations: quads, transforms, smooth normals, spheres, Loop subdivision.
#include "core/mesh.h"

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <stdexcept>
#include <utility>

namespace lockstep::test_mesh {
namespace {

glm::vec3 face_normal(const TriangleMesh& mesh, const glm::uvec3& t) {
  const glm::vec3 a = mesh.positions[t.x];
  return glm::normalize(glm::cross(mesh.positions[t.y] - a, mesh.positions[t.z] - a));
}

int euler_characteristic(const TriangleMesh& mesh) {
  std::set<std::pair<unsigned, unsigned>> edges;
  for (const glm::uvec3& t : mesh.triangles) {
    for (int e = 0; e < 3; ++e) edges.insert(std::minmax({t[e], t[(e + 1) % 3]}));
  }
  return static_cast<int>(mesh.positions.size()) - static_cast<int>(edges.size()) +
         static_cast<int>(mesh.triangles.size());
}

double signed_volume(const TriangleMesh& mesh) {
  double volume = 0.0;
  for (const glm::uvec3& t : mesh.triangles) {
    const glm::dvec3 a(mesh.positions[t.x]), b(mesh.positions[t.y]), c(mesh.positions[t.z]);
    volume += glm::dot(a, glm::cross(b, c)) / 6.0;
  }
  return volume;
}

void expect_unit_normals_outward(const TriangleMesh& mesh) {
  ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
  for (size_t i = 0; i < mesh.normals.size(); ++i) {
    EXPECT_NEAR(glm::length(mesh.normals[i]), 1.0f, 1e-5f);
    EXPECT_GT(glm::dot(mesh.normals[i], mesh.positions[i]), 0.0f);
  }
  for (const glm::uvec3& t : mesh.triangles) {
    EXPECT_GT(glm::dot(face_normal(mesh, t), mesh.normals[t.x]), 0.0f);
  }
}

TriangleMesh tetrahedron() {
  TriangleMesh mesh;
  mesh.positions = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
  mesh.triangles = {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}};
  return mesh;
}

TriangleMesh icosahedron() {
  const float g = std::numbers::phi_v<float>;
  TriangleMesh mesh;
  mesh.positions = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                    {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  mesh.triangles = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                    {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                    {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                    {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
  return mesh;
}

// A regular triangle grid of side `n`: every interior vertex has valence six.
TriangleMesh sloping_grid(unsigned n) {
  TriangleMesh mesh;
  for (unsigned y = 0; y <= n; ++y) {
    for (unsigned x = 0; x <= n; ++x) {
      const auto fx = static_cast<float>(x), fy = static_cast<float>(y);
      mesh.positions.emplace_back(fx, fy, 0.5f * fx - 0.25f * fy + 1.0f);
    }
  }
  for (unsigned y = 0; y < n; ++y) {
    for (unsigned x = 0; x < n; ++x) {
      const unsigned a = y * (n + 1) + x, b = a + 1, c = a + n + 1, d = c + 1;
      mesh.triangles.emplace_back(a, b, d);
      mesh.triangles.emplace_back(a, d, c);
    }
  }
  return mesh;
}

TEST(AddQuad, FacesTheSideOfItsCrossProduct) {
  TriangleMesh mesh;
  add_quad(mesh, {0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0});
  add_quad(mesh, {0, 0, 5}, {0, 1, 5}, {1, 1, 5}, {1, 0, 5});
  ASSERT_EQ(mesh.positions.size(), 8u);
  ASSERT_EQ(mesh.triangles.size(), 4u);
  EXPECT_TRUE(mesh.normals.empty());
  EXPECT_EQ(face_normal(mesh, mesh.triangles[0]), glm::vec3(0, 0, 1));
  EXPECT_EQ(face_normal(mesh, mesh.triangles[1]), glm::vec3(0, 0, 1));
  EXPECT_EQ(face_normal(mesh, mesh.triangles[2]), glm::vec3(0, 0, -1));
}

TEST(AddQuad, KeepsAMeshWithNormalsComplete) {
  TriangleMesh mesh = tessellated_sphere(1.0f, 8);
  add_quad(mesh, {0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0});
  ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
  EXPECT_EQ(mesh.normals.back(), glm::vec3(0, 0, 1));
}

TEST(ApplyTransform, NormalsStayPerpendicularUnderUnevenScale) {
  TriangleMesh mesh = tessellated_sphere(1.0f, 64);
  apply_transform(mesh, glm::scale(glm::mat4(1.0f), glm::vec3(1.0f, 3.0f, 0.5f)));
  for (size_t i = 0; i < mesh.positions.size(); ++i) {
    // The gradient of x^2 + (y/3)^2 + (z/.5)^2.
    const glm::vec3 p = mesh.positions[i];
    const glm::vec3 gradient = glm::normalize(glm::vec3(p.x, p.y / 9.0f, p.z / 0.25f));
    EXPECT_NEAR(glm::dot(gradient, mesh.normals[i]), 1.0f, 1e-5f);
  }
}

TEST(ApplyTransform, MirroringKeepsTheSide) {
  TriangleMesh mesh = tessellated_sphere(2.0f, 16);
  apply_transform(mesh, glm::scale(glm::mat4(1.0f), glm::vec3(-1.0f, 1.0f, 1.0f)));
  expect_unit_normals_outward(mesh);
  EXPECT_GT(signed_volume(mesh), 0.0);
}

TEST(ApplyTransform, SurvivesTinyAndHugeScales) {
  for (const float scale : {1e-15f, 1e15f}) {
    TriangleMesh mesh = tessellated_sphere(1.0f, 8);
    apply_transform(mesh, glm::scale(glm::mat4(1.0f), glm::vec3(-scale, scale, 2.0f * scale)));
    for (const glm::vec3& n : mesh.normals) EXPECT_NEAR(glm::length(n), 1.0f, 1e-5f);
    apply_transform(mesh, glm::scale(glm::mat4(1.0f), glm::vec3(1.0f / scale)));
    expect_unit_normals_outward(mesh);
  }
}

TEST(SmoothNormals, OfASphereAreRadial) {
  TriangleMesh mesh = tessellated_sphere(3.0f, 64);
  mesh.normals.clear();
  set_smooth_normals(mesh);
  for (size_t i = 0; i < mesh.positions.size(); ++i) {
    EXPECT_GT(glm::dot(glm::normalize(mesh.positions[i]), mesh.normals[i]), 0.999f);
  }
}

TEST(SmoothNormals, WeightByAngleNotByTriangleCount) {
  // Two faces of a roof; one of them cut in two at the shared vertex 0.
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {0, 0, 1}, {0, 1, 1}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 4}, {0, 4, 3}};
  set_smooth_normals(mesh);
  EXPECT_NEAR(mesh.normals[0].x, mesh.normals[0].z, 1e-6f);
}

TEST(SmoothNormals, LooseVerticesPointUp) {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  mesh.triangles = {{0, 1, 2}};
  set_smooth_normals(mesh);
  for (const glm::vec3& n : mesh.normals) EXPECT_EQ(n, glm::vec3(0, 0, 1));
}

TEST(TessellatedSphere, IsClosedAndOutward) {
  const TriangleMesh mesh = tessellated_sphere(2.0f, 128);
  expect_unit_normals_outward(mesh);
  EXPECT_EQ(euler_characteristic(mesh), 2);
  EXPECT_NEAR(signed_volume(mesh), 4.0 / 3.0 * std::numbers::pi * 8.0, 0.1);
}

TEST(LoopSubdivision, ClosedMeshesStayClosedAndOutward) {
  for (const TriangleMesh& control : {tetrahedron(), icosahedron()}) {
    for (int levels = 0; levels <= 3; ++levels) {
      const TriangleMesh mesh = subdivide_loop(control, levels);
      EXPECT_EQ(mesh.triangles.size(), control.triangles.size() << (2 * levels));
      EXPECT_EQ(euler_characteristic(mesh), 2);
      EXPECT_GT(signed_volume(mesh), 0.0);
      expect_unit_normals_outward(mesh);
    }
  }
}

TEST(LoopSubdivision, IcosahedronGivesItsSymmetricLimit) {
  const TriangleMesh mesh = subdivide_loop(icosahedron(), 2);
  for (int i = 0; i < 12; ++i) {
    EXPECT_NEAR(glm::dot(glm::normalize(mesh.positions[i]), mesh.normals[i]), 1.0f, 1e-5f);
    EXPECT_NEAR(glm::length(mesh.positions[i]), glm::length(mesh.positions[0]), 1e-5f);
  }
}

TEST(LoopSubdivision, PlanesStayPlanar) {
  for (int levels = 0; levels <= 3; ++levels) {
    const TriangleMesh mesh = subdivide_loop(sloping_grid(4), levels);
    const glm::vec3 normal = glm::normalize(glm::vec3(-0.5f, 0.25f, 1.0f));
    for (size_t i = 0; i < mesh.positions.size(); ++i) {
      const glm::vec3 p = mesh.positions[i];
      EXPECT_NEAR(p.z, 0.5f * p.x - 0.25f * p.y + 1.0f, 1e-5f);
      EXPECT_GT(glm::dot(mesh.normals[i], normal), 0.99999f);
    }
  }
}

TEST(LoopSubdivision, RegularInteriorVerticesOfAPlaneStayPut) {
  const TriangleMesh control = sloping_grid(6);
  const TriangleMesh mesh = subdivide_loop(control, 2);
  for (unsigned y = 2; y <= 4; ++y) {
    for (unsigned x = 2; x <= 4; ++x) {
      const unsigned v = y * 7 + x;
      EXPECT_LT(glm::distance(mesh.positions[v], control.positions[v]), 1e-5f);
    }
  }
}

TEST(LoopSubdivision, LimitDoesNotDependOnTheLevels) {
  // Control vertices keep their numbers, and each has one limit, on the boundary too.
  TriangleMesh control = sloping_grid(3);
  for (size_t i = 0; i < control.positions.size(); ++i) {
    control.positions[i].z += std::sin(1.7f * static_cast<float>(i));
  }
  const TriangleMesh limit = subdivide_loop(control, 0);
  const TriangleMesh fine = subdivide_loop(control, 3);
  for (size_t i = 0; i < control.positions.size(); ++i) {
    EXPECT_LT(glm::distance(limit.positions[i], fine.positions[i]), 1e-5f) << "vertex " << i;
  }
}

TEST(LoopSubdivision, LimitNormalsMatchTheFineMesh) {
  TriangleMesh fine = subdivide_loop(tetrahedron(), 6);
  const std::vector<glm::vec3> exact = fine.normals;
  set_smooth_normals(fine);
  for (size_t i = 0; i < exact.size(); ++i) EXPECT_GT(glm::dot(exact[i], fine.normals[i]), 0.999f);
}

TEST(LoopSubdivision, BoundariesAreSplinesOfTheBoundaryAlone) {
  TriangleMesh control = sloping_grid(4);
  const TriangleMesh before = subdivide_loop(control, 2);
  control.positions[2 * 5 + 2].z += 10.0f;  // the centre
  const TriangleMesh after = subdivide_loop(control, 2);
  for (unsigned x = 0; x <= 4; ++x) EXPECT_EQ(before.positions[x], after.positions[x]);
  EXPECT_NE(before.positions[12], after.positions[12]);
}

TEST(LoopSubdivision, FacesThatNameAVertexTwiceAreDropped) {
  TriangleMesh control = tetrahedron();
  control.triangles.emplace_back(0u, 0u, 1u);
  EXPECT_EQ(subdivide_loop(control, 1).triangles.size(), 16u);
}

TEST(LoopSubdivision, RefusesEdgesOfThreeFacesAndMixedWindings) {
  TriangleMesh fin;
  fin.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, -1, 0}};
  fin.triangles = {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}};
  EXPECT_THROW(subdivide_loop(fin, 1), std::invalid_argument);
  fin.triangles = {{0, 1, 2}, {0, 1, 3}};
  EXPECT_THROW(subdivide_loop(fin, 1), std::invalid_argument);
}

}  // namespace
}  // namespace lockstep::test_mesh
