// Curves of pbrt's files as triangles: areas and lengths of those with a closed form, joints,
// normals, counts, and what is said of bad ones.
#include "tests/t_pbrt.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace lockstep::test_pbrt_curves {
namespace {

constexpr double pi = 3.14159265358979323846;

class Curves : public Pbrt {
 protected:
  static std::string curve(const std::string& parameters) {
    return "Shape \"curve\" " + parameters;
  }
  SceneDescription scene(const std::string& parameters) const {
    return read_world(curve(parameters));
  }
  TriangleMesh mesh(const std::string& parameters) const {
    const SceneDescription d = scene(parameters);
    EXPECT_EQ(d.warnings.size(), 0u);
    return mesh_of(d);
  }
  void expect_error(const std::string& parameters, const std::string& part) const {
    expect_one_line_with(error_of("WorldBegin\n" + curve(parameters)), part);
  }
};

double area_of(const TriangleMesh& mesh) {
  double area = 0.0;
  for (const glm::uvec3 t : mesh.triangles) {
    const glm::dvec3 a(mesh.positions[t.x]), b(mesh.positions[t.y]), c(mesh.positions[t.z]);
    area += 0.5 * glm::length(glm::cross(b - a, c - a));
  }
  return area;
}

// Every triangle's front is where its vertices' normals point, and these have length 1.
void expect_consistent(const TriangleMesh& mesh) {
  ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
  ASSERT_EQ(mesh.uvs.size(), mesh.positions.size());
  for (const glm::vec3 n : mesh.normals) ASSERT_NEAR(glm::length(n), 1.0f, 1e-5f);
  for (size_t i = 0; i < mesh.triangles.size(); ++i) {
    const glm::uvec3 t = mesh.triangles[i];
    const glm::vec3 mean = mesh.normals[t.x] + mesh.normals[t.y] + mesh.normals[t.z];
    ASSERT_GT(glm::dot(normal_of(mesh, i), mean), 1.5f) << "triangle " << i;
  }
}

const std::string straight = "\"point3 P\" [0 0 0  1 0 0  2 0 0  3 0 0] ";

TEST_F(Curves, StraightTubesHaveTheirArea) {
  for (const char* type : {"\"string type\" \"cylinder\" ", "\"string type\" \"flat\" ", ""}) {
    const TriangleMesh m = mesh(straight + type + "\"float width\" 0.2");
    expect_consistent(m);
    EXPECT_NEAR(area_of(m), pi * 0.2 * 3.0, 1e-4) << type;
    for (size_t i = 0; i < m.positions.size(); ++i) {
      const float radius = glm::length(glm::vec2(m.positions[i].y, m.positions[i].z));
      EXPECT_GT(radius, 0.1f);
      EXPECT_LT(radius, 0.105f);
      expect_near(m.normals[i] * radius, {0.0f, m.positions[i].y, m.positions[i].z}, 1e-4f);
    }
  }
}

// A cone's side: the mean circumference times the slant height.
TEST_F(Curves, TubesTaper) {
  const TriangleMesh m =
      mesh(straight + "\"string type\" \"cylinder\" \"float width0\" 0.4 \"float width1\" 0");
  expect_consistent(m);
  EXPECT_NEAR(area_of(m), pi * 0.2 * std::hypot(3.0, 0.2), 0.003);
  EXPECT_GT(m.normals[0].x, 0.05f) << "the side widens away from the tip";
}

TEST_F(Curves, RibbonsLieAcrossTheirNormals) {
  const TriangleMesh m = mesh(straight +
                              "\"string type\" \"ribbon\" \"float width\" 0.5 "
                              "\"normal N\" [0 0 1  0 0 1]");
  expect_consistent(m);
  EXPECT_NEAR(area_of(m), 1.5, 1e-5);
  EXPECT_EQ(m.triangles.size(), 2u);
  for (size_t i = 0; i < m.positions.size(); ++i) {
    expect_near(m.normals[i], {0, 0, 1});
    EXPECT_NEAR(std::abs(m.positions[i].y), 0.25f, 1e-6f);
    EXPECT_EQ(m.positions[i].z, 0.0f);
  }
}

// Half a turn between the ends: a strip of that twist has an area by quadrature.
TEST_F(Curves, RibbonsTwist) {
  const TriangleMesh m = mesh(straight +
                              "\"string type\" \"ribbon\" \"float width\" 0.5 "
                              "\"normal N\" [0 0 1  0 1 0]");
  expect_consistent(m);
  EXPECT_GE(m.triangles.size(), 12u);
  expect_near(m.normals.front(), {0, 0, 1});
  expect_near(m.normals.back(), {0, 1, 0});
  EXPECT_GT(area_of(m), 1.5);
  EXPECT_LT(area_of(m), 1.53);
}

// Four cubic arcs that approximate a circle to 3e-4 of its radius.
TEST_F(Curves, ACircleBecomesATorus) {
  const char* points =
      "\"point3 P\" [1 0 0  1 .5523 0  .5523 1 0  0 1 0  -.5523 1 0  -1 .5523 0  -1 0 0 "
      "-1 -.5523 0  -.5523 -1 0  0 -1 0  .5523 -1 0  1 -.5523 0  1 0 0] ";
  const TriangleMesh m = mesh(std::string(points) + "\"float width\" 0.1");
  expect_consistent(m);
  EXPECT_NEAR(area_of(m), 4.0 * pi * pi * 0.05, 0.02 * 4.0 * pi * pi * 0.05);
  for (const glm::vec3 p : m.positions) {
    const float from_ring = std::hypot(glm::length(glm::vec2(p)) - 1.0f, p.z);
    EXPECT_NEAR(from_ring, 0.05f, 0.004f);
  }
}

// The same parabola in both degrees and bases, to the last bits.
TEST_F(Curves, BasesAndDegreesAgree) {
  const std::string width = "\"float width\" 0.1";
  const TriangleMesh cubic =
      mesh("\"point3 P\" [0 0 0  0.6666667 0.6666667 0  1.3333334 0.6666667 0  2 0 0] " + width);
  const TriangleMesh quadratic =
      mesh("\"integer degree\" 2 \"point3 P\" [0 0 0  1 1 0  2 0 0] " + width);
  // A uniform quadratic spline passes the middles of its polygon's sides.
  const TriangleMesh spline = mesh(
      "\"integer degree\" 2 \"string basis\" \"bspline\" \"point3 P\" [-1 -1 0  1 1 0  3 -1 0] " +
      width);
  for (const TriangleMesh* other : {&quadratic, &spline}) {
    ASSERT_EQ(other->positions.size(), cubic.positions.size());
    for (size_t i = 0; i < cubic.positions.size(); ++i) {
      expect_near(other->positions[i], cubic.positions[i], 2e-6f);
    }
  }
}

// A cubic spline over points on a line at equal distances runs along it evenly.
TEST_F(Curves, SplinesHaveASegmentPerFourPoints) {
  const TriangleMesh m = mesh(
      "\"string basis\" \"bspline\" \"point3 P\" [0 0 0  1 0 0  2 0 0  3 0 0  4 0 0  5 0 0] "
      "\"float width\" 0.1");
  EXPECT_NEAR(area_of(m), pi * 0.1 * 3.0, 1e-4);
  const auto [low, high] = std::minmax_element(m.positions.begin(), m.positions.end(),
                                               [](auto a, auto b) { return a.x < b.x; });
  EXPECT_NEAR(low->x, 1.0f, 1e-5f);
  EXPECT_NEAR(high->x, 4.0f, 1e-5f);
}

// Around a bend in space rings follow each other without a twist: no triangle is stretched.
TEST_F(Curves, TubesDoNotTwist) {
  const TriangleMesh m =
      mesh("\"point3 P\" [0 0 0  0 0 2  2 0 2  2 2 2   2 4 2  0 4 2  0 4 0] \"float width\" 0.3");
  expect_consistent(m);
  EXPECT_GT(m.triangles.size(), 250u);
}

TEST_F(Curves, ThickerAndMoreBentOnesHaveMoreTriangles) {
  const auto count = [&](const std::string& width, const std::string& height) {
    return mesh("\"point3 P\" [0 0 0  1 " + height + " 0  2 -" + height + " 0  3 0 0] " +
                "\"float width\" " + width)
        .triangles.size();
  };
  EXPECT_EQ(count("0.01", "0"), 12u);
  EXPECT_EQ(count("0.5", "0"), 32u);
  EXPECT_GT(count("0.01", "2"), 10 * count("0.01", "0"));
  EXPECT_LE(count("0.0001", "100"), 12u * 64u);
}

// Those of one surface become one mesh; another surface, or light, begins another.
TEST_F(Curves, OnOneSurfaceBecomeOneMesh) {
  const std::string one = curve(straight + "\"float width\" 0.01 ");
  const SceneDescription d =
      read_world(one + one + one + "Material \"diffuse\" " + one + triangle + one + one);
  ASSERT_EQ(d.shapes.size(), 4u);
  EXPECT_EQ(mesh_of(d, 0).triangles.size(), 36u);
  EXPECT_EQ(mesh_of(d, 1).triangles.size(), 12u);
  EXPECT_EQ(mesh_of(d, 3).triangles.size(), 24u);
  expect_consistent(mesh_of(d, 0));
  const SceneDescription lit = read_world("AreaLightSource \"diffuse\" " + one + one);
  EXPECT_EQ(lit.shapes.size(), 2u);
}

TEST_F(Curves, WithoutASurfaceAreLeftOut) {
  EXPECT_TRUE(warns(scene(straight + "\"float width\" 0"), "has no triangles; it is left out"));
  EXPECT_TRUE(warns(scene("\"point3 P\" [1 1 1  1 1 1  1 1 1  1 1 1]"), "has no triangles"));
  // Coinciding control points alone are no reason.
  EXPECT_FALSE(mesh("\"point3 P\" [0 0 0  0 0 0  1 0 0  1 0 0]").triangles.empty());
}

TEST_F(Curves, BadOnesGiveOneLine) {
  expect_error("", "has 0 points; its basis and degree need a multiple of 3 and one more");
  expect_error("\"point3 P\" [0 0 0  1 0 0  2 0 0]", "has 3 points");
  expect_error("\"string basis\" \"bspline\" \"point3 P\" [0 0 0  1 0 0]", "need 4 or more");
  expect_error(straight + "\"integer degree\" 4", "has the degree 4; expected 2 or 3");
  expect_error(straight + "\"string basis\" \"catmull\"", "has the basis \"catmull\"");
  expect_error(straight + "\"string type\" \"round\"", "is of the type \"round\"");
  expect_error(straight + "\"string type\" \"ribbon\"",
               "has 0 values of \"N\"; a ribbon needs one");
  expect_error(straight + "\"float width0\" -1", "has a negative width");
  // 2^26 triangles in all: a long zigzag runs out of them.
  std::string points;
  for (int i = 0; i < 300001; ++i) {
    points += std::to_string(i) + (i % 2 ? " 900 0 " : " -900 0 ");
  }
  expect_error("\"point3 P\" [" + points + "] \"float width\" 1e-3", "no more than 67 million");
}

}  // namespace
}  // namespace lockstep::test_pbrt_curves
