// Triangles that overlap in one plane: which are found, and which neighbours are left alone.
#include "core/coincidence.h"
#include "core/mesh.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <utility>
#include <vector>

namespace lockstep::test_coincidence {
namespace {

using Flags = std::vector<std::uint8_t>;

// The flags of a mesh's triangles; checks that they are left out exactly where none is set.
Flags flags_of(const TriangleMesh& mesh) {
  std::vector<std::int32_t> indices;
  for (const glm::uvec3& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) indices.push_back(static_cast<std::int32_t>(t[k]));
  }
  const Flags flags =
      find_coincident_triangles(&mesh.positions.data()->x, indices.data(), mesh.triangles.size());
  if (flags.empty()) return Flags(mesh.triangles.size(), 0);
  EXPECT_EQ(flags.size(), mesh.triangles.size());
  EXPECT_NE(std::count(flags.begin(), flags.end(), 1), 0);
  return flags;
}

auto flagged(const Flags& flags) { return std::count(flags.begin(), flags.end(), 1); }

void add_triangle(TriangleMesh& mesh, glm::vec3 a, glm::vec3 b, glm::vec3 c) {
  const auto first = static_cast<unsigned>(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), {a, b, c});
  mesh.triangles.push_back({first, first + 1, first + 2});
}

// A rectangle in the plane z, both corners given.
void add_rectangle(TriangleMesh& mesh, glm::vec2 low, glm::vec2 high, float z) {
  add_quad(mesh, {low.x, low.y, z}, {high.x, low.y, z}, {high.x, high.y, z}, {low.x, high.y, z});
}

// n x m quads of shared vertices over a unit square in the plane z = 0.
TriangleMesh grid(unsigned n, unsigned m) {
  TriangleMesh mesh;
  for (unsigned y = 0; y <= m; ++y) {
    for (unsigned x = 0; x <= n; ++x) {
      mesh.positions.push_back({static_cast<float>(x) / static_cast<float>(n),
                                static_cast<float>(y) / static_cast<float>(m), 0.0f});
    }
  }
  for (unsigned y = 0; y < m; ++y) {
    for (unsigned x = 0; x < n; ++x) {
      const unsigned a = y * (n + 1) + x, b = a + n + 1;
      mesh.triangles.push_back({a, a + 1, b + 1});
      mesh.triangles.push_back({a, b + 1, b});
    }
  }
  return mesh;
}

void append(TriangleMesh& mesh, const TriangleMesh& other) {
  const auto first = static_cast<unsigned>(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), other.positions.begin(), other.positions.end());
  for (const glm::uvec3& t : other.triangles) mesh.triangles.push_back(t + first);
}

// A closed box; triangles 0 and 1 are its bottom.
TriangleMesh box(glm::vec3 low, glm::vec3 high) {
  TriangleMesh mesh;
  for (unsigned i = 0; i < 8; ++i) {
    mesh.positions.push_back(
        {i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z});
  }
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

// Triangles 0 and 1: the floor. 2 and 3: the bottom of a box that stands on both of them.
TriangleMesh box_on_floor() {
  TriangleMesh mesh;
  add_rectangle(mesh, {-2.0f, -1.5f}, {3.0f, 2.5f}, 0.25f);
  append(mesh, box({-0.5f, -0.25f, 0.25f}, {0.7f, 0.75f, 1.5f}));
  return mesh;
}

Flags first_four_of(std::size_t count) {
  Flags flags(count, 0);
  std::fill_n(flags.begin(), 4, std::uint8_t{1});
  return flags;
}

// A random rotation, scale in 1e-3..1e3 and move by a few times the size, all in float.
glm::mat4 random_transform(std::mt19937& random) {
  std::uniform_real_distribution<float> uniform(-1.0f, 1.0f);
  const float scale = std::pow(10.0f, 3.0f * uniform(random));
  glm::mat4 transform(1.0f);
  transform = glm::translate(
      transform, 4.0f * scale * glm::vec3(uniform(random), uniform(random), uniform(random)));
  transform = glm::scale(transform, glm::vec3(scale));
  const glm::vec3 axis(uniform(random), uniform(random), uniform(random));
  return glm::rotate(transform, 3.14f * uniform(random), glm::normalize(axis));
}

TEST(Coincidence, NothingInNothing) {
  EXPECT_TRUE(find_coincident_triangles(nullptr, nullptr, 0).empty());
}

TEST(Coincidence, ABoxAndTheFloorUnderIt) {
  EXPECT_EQ(flags_of(box_on_floor()), first_four_of(14));
  // The same with the floor looking down: orientation is no matter.
  TriangleMesh mesh = box_on_floor();
  for (unsigned i = 0; i < 2; ++i) std::swap(mesh.triangles[i].x, mesh.triangles[i].y);
  EXPECT_EQ(flags_of(mesh), first_four_of(14));
}

TEST(Coincidence, PlanesOfEveryTiltSizeAndPlace) {
  std::mt19937 random(7);
  for (int i = 0; i < 2000; ++i) {
    TriangleMesh mesh = box_on_floor();
    apply_transform(mesh, random_transform(random));
    ASSERT_EQ(flags_of(mesh), first_four_of(14)) << "transform " << i;
  }
}

// Where two axes are equally dominant, or three, rounding decides between them.
TEST(Coincidence, PlanesHalfwayBetweenAxes) {
  for (const glm::vec3 axis : {glm::vec3(1, 0, 0), glm::vec3(0, 1, 0), glm::vec3(1, -1, 0)}) {
    const float angle = axis.x * axis.y == 0.0f ? std::atan(1.0f) : std::atan(std::sqrt(2.0f));
    TriangleMesh mesh = box_on_floor();
    apply_transform(mesh, glm::rotate(glm::mat4(1.0f), angle, glm::normalize(axis)));
    EXPECT_EQ(flags_of(mesh), first_four_of(14));
  }
}

TEST(Coincidence, ASmallBoxOnAHugeFloor) {
  std::mt19937 random(8);
  for (int i = 0; i < 200; ++i) {
    TriangleMesh mesh;
    add_rectangle(mesh, {-500.0f, -700.0f}, {600.0f, 500.0f}, 0.0f);
    // Astride the diagonal, which the floor's triangles share.
    append(mesh, box({49.99f, -99.99f + 0.01f, 0.0f}, {50.01f, -99.97f + 0.01f, 0.02f}));
    const Flags upright = flags_of(mesh);
    EXPECT_EQ(flagged(upright), upright[0] + upright[1] + 2);
    EXPECT_EQ(upright[2] + upright[3], 2);
    apply_transform(mesh, random_transform(random));
    const Flags tilted = flags_of(mesh);
    EXPECT_EQ(tilted[2] + tilted[3], 2) << "transform " << i;
  }
}

TEST(Coincidence, OverlappingSheets) {
  TriangleMesh mesh;
  add_rectangle(mesh, {0, 0}, {1, 1}, 0.1f);
  add_rectangle(mesh, {0.75f, 0.25f}, {1.5f, 0.5f}, 0.1f);
  // Only the lower right triangle of the first sheet reaches the second one.
  EXPECT_EQ(flags_of(mesh), (Flags{1, 0, 1, 1}));
}

TEST(Coincidence, OneSheetInsideAnother) {
  TriangleMesh mesh;
  add_triangle(mesh, {0, 0, 0}, {4, 0, 4}, {0, 4, 4});
  add_triangle(mesh, {1, 1, 2}, {1, 1.5f, 2.5f}, {1.5f, 1, 2.5f});
  EXPECT_EQ(flags_of(mesh), (Flags{1, 1}));
}

TEST(Coincidence, Duplicates) {
  TriangleMesh mesh = tessellated_sphere(1.0f, 12);
  const std::size_t count = mesh.triangles.size();
  mesh.triangles.push_back(mesh.triangles[17]);
  const glm::uvec3 t = mesh.triangles[40];
  add_triangle(mesh, mesh.positions[t.z], mesh.positions[t.y], mesh.positions[t.x]);
  Flags expected(count, 0);
  expected[17] = expected[40] = 1;
  expected.insert(expected.end(), {1, 1});
  EXPECT_EQ(flags_of(mesh), expected);
}

TEST(Coincidence, DuplicatesThinnerThanRounding) {
  TriangleMesh mesh;
  for (int i = 0; i < 2; ++i) add_triangle(mesh, {-1, 0, 1}, {1, 0, 1}, {0, 1e-8f, 1});
  EXPECT_EQ(flags_of(mesh), (Flags{1, 1}));
}

TEST(Coincidence, SheetsApartOrTouchingAreLeftAlone) {
  TriangleMesh mesh;
  add_rectangle(mesh, {0, 0}, {1, 1}, 0.0f);
  add_rectangle(mesh, {0, 0}, {1, 1}, 1e-4f);        // above it
  add_rectangle(mesh, {1, 0.3f}, {2, 0.7f}, 0.0f);   // along a part of an edge
  add_rectangle(mesh, {-1, -1}, {0, 0}, 0.0f);       // at a corner
  add_rectangle(mesh, {0.2f, 1}, {0.8f, 3}, 1e-4f);  // along an edge of the second
  std::mt19937 random(9);
  for (int i = 0; i < 500; ++i) {
    TriangleMesh moved = mesh;
    if (i > 0) apply_transform(moved, random_transform(random));
    ASSERT_EQ(flagged(flags_of(moved)), 0) << "transform " << i;
  }
}

TEST(Coincidence, NarrowOverlapsCount) {
  TriangleMesh mesh;
  add_rectangle(mesh, {0, 0}, {1, 1}, 0.0f);
  add_rectangle(mesh, {1 - 1e-4f, 0.25f}, {2, 0.75f}, 0.0f);
  std::mt19937 random(10);
  for (int i = 0; i < 500; ++i) {
    TriangleMesh moved = mesh;
    if (i > 0) apply_transform(moved, random_transform(random));
    const Flags flags = flags_of(moved);
    ASSERT_EQ(flags[0] + flags[2] + flags[3], 2 + flags[2] * flags[3]) << "transform " << i;
    ASSERT_EQ(flags[1], 0) << "transform " << i;
  }
}

TEST(Coincidence, GridsAreLeftAlone) {
  std::mt19937 random(11);
  for (const glm::uvec2 size : {glm::uvec2(3, 2), glm::uvec2(40, 70), glm::uvec2(300, 300)}) {
    TriangleMesh mesh = grid(size.x, size.y);
    EXPECT_EQ(flagged(flags_of(mesh)), 0);
    apply_transform(mesh, random_transform(random));
    EXPECT_EQ(flagged(flags_of(mesh)), 0);
  }
}

TEST(Coincidence, ClosedMeshesAreLeftAlone) {
  EXPECT_EQ(flagged(flags_of(box({-1, -2, -3}, {3, 2, 1}))), 0);
  EXPECT_EQ(flagged(flags_of(tessellated_sphere(2.0f, 64))), 0);
  std::mt19937 random(12);
  TriangleMesh mesh = box({-1, -2, -3}, {3, 2, 1});
  apply_transform(mesh, random_transform(random));
  EXPECT_EQ(flagged(flags_of(mesh)), 0);
}

TEST(Coincidence, APatchOnAGrid) {
  const unsigned n = 100;
  TriangleMesh mesh = grid(n, n);
  add_rectangle(mesh, {0.205f, 0.405f}, {0.295f, 0.495f}, 0.0f);
  const Flags flags = flags_of(mesh);
  for (unsigned i = 0; i < 2 * n * n; ++i) {
    const unsigned x = i / 2 % n, y = i / 2 / n;
    // At two corners of the patch, only one triangle of a quad reaches under it.
    if ((x == 20 && y == 49) || (x == 29 && y == 40)) continue;
    EXPECT_EQ(flags[i], x >= 20 && x < 30 && y >= 40 && y < 50) << x << " " << y;
  }
  EXPECT_EQ(flags[2 * n * n] + flags[2 * n * n + 1], 2);
}

// Small triangles define a tilted plane badly; sheets of them must still be found.
TEST(Coincidence, AFineSheetOnAnother) {
  std::mt19937 random(13);
  for (int i = 0; i < 20; ++i) {
    TriangleMesh mesh = grid(150, 140);
    const std::size_t below = mesh.triangles.size();
    TriangleMesh sheet = grid(77, 81);
    apply_transform(
        sheet, glm::scale(glm::translate(glm::mat4(1.0f), {0.3f, 0.2f, 0.0f}), glm::vec3(0.5f)));
    append(mesh, sheet);
    apply_transform(mesh, random_transform(random));
    const Flags flags = flags_of(mesh);
    EXPECT_EQ(std::count(flags.begin() + static_cast<std::ptrdiff_t>(below), flags.end(), 0), 0);
  }
}

// Twice the area that two triangles with integer corners share, by clipping one at the other.
double shared_area(const std::array<glm::dvec2, 3>& a, const std::array<glm::dvec2, 3>& b) {
  const auto side = [](glm::dvec2 p, glm::dvec2 q, glm::dvec2 r) {
    return (q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x);
  };
  const double sign = side(b[0], b[1], b[2]) > 0.0 ? 1.0 : -1.0;
  std::vector<glm::dvec2> polygon(a.begin(), a.end());
  for (std::size_t e = 0; e < 3; ++e) {
    std::vector<glm::dvec2> kept;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const glm::dvec2 p = polygon[i], q = polygon[(i + 1) % polygon.size()];
      const double at_p = sign * side(b[e], b[(e + 1) % 3], p);
      const double at_q = sign * side(b[e], b[(e + 1) % 3], q);
      if (at_p >= 0.0) kept.push_back(p);
      if (at_p * at_q < 0.0) kept.push_back(p + (q - p) * (at_p / (at_p - at_q)));
    }
    polygon = kept;
  }
  double area = 0.0;
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    area += side(polygon[0], polygon[i - 1], polygon[i]);
  }
  return std::abs(area);
}

// Random triangles on the points of a lattice, in several planes: what touches there touches
// exactly, and what overlaps shares an area that no rounding explains.
TEST(Coincidence, AgreesWithAreasOnALattice) {
  std::mt19937 random(14);
  std::uniform_int_distribution<int> lattice(0, 12), planes(0, 2);
  for (int round = 0; round < 300; ++round) {
    // Few in a plane; more than are compared at a time; more than are searched pair by pair.
    const std::size_t count = round % 50 == 0 ? 450 : round % 5 == 0 ? 120 : 12;
    std::uniform_int_distribution<int> places(0, 2 * static_cast<int>(std::sqrt(count)));
    TriangleMesh mesh;
    std::vector<std::array<glm::dvec2, 3>> corners(count);
    std::vector<int> plane(count);
    for (std::size_t i = 0; i < count; ++i) {
      plane[i] = planes(random);
      std::array<glm::vec3, 3> p;
      const glm::ivec2 place(3 * places(random), 3 * places(random));
      for (std::size_t k = 0; k < 3; ++k) {
        corners[i][k] = place + glm::ivec2(lattice(random) / 2, lattice(random) / 2);
        p[k] = glm::vec3(corners[i][k], plane[i]);
      }
      add_triangle(mesh, p[0], p[1], p[2]);
    }
    std::vector<bool> has_area(count);
    for (std::size_t i = 0; i < count; ++i) {
      has_area[i] = shared_area(corners[i], corners[i]) > 0.5;
    }
    Flags expected(count, 0);
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t j = 0; j < count; ++j) {
        if (i == j || plane[i] != plane[j] || !has_area[i] || !has_area[j]) continue;
        const glm::dvec2 apart = glm::abs(corners[i][0] - corners[j][0]);
        if (apart.x > 12.0 || apart.y > 12.0) continue;  // each is 6 wide and high at most
        if (shared_area(corners[i], corners[j]) > 1e-9) expected[i] = 1;
      }
    }
    ASSERT_EQ(flags_of(mesh), expected) << "round " << round;
    // Lines of no area have one after rounding, so they are left out.
    TriangleMesh tilted = mesh;
    std::erase_if(tilted.triangles, [&](const glm::uvec3& t) { return !has_area[t.x / 3]; });
    apply_transform(tilted, random_transform(random));
    const Flags flags = flags_of(tilted);
    for (std::size_t i = 0; i < flags.size(); ++i) {
      ASSERT_EQ(flags[i], expected[tilted.triangles[i].x / 3]) << "round " << round;
    }
  }
}

TEST(Coincidence, TrianglesWithoutAreaOverlapNothing) {
  TriangleMesh mesh;
  add_rectangle(mesh, {-1, -1}, {1, 1}, 0.0f);
  add_triangle(mesh, {0, 0.5f, 0}, {0, 0.5f, 0}, {0, 0.5f, 0});             // a point
  add_triangle(mesh, {0.1f, 0.5f, 0}, {0.7f, 0.2f, 0}, {0.1f, 0.5f, 0});    // a line
  add_triangle(mesh, {-0.5f, -0.5f, 0}, {0, 0, 0}, {0.25f, 0.25f, 0});      // corners in line
  add_triangle(mesh, {-0.5f, -0.5f, 0}, {-0.5f, -0.5f, 0}, {0.25f, 0, 0});  // and once more
  EXPECT_EQ(flagged(flags_of(mesh)), 0);
  mesh.triangles.erase(mesh.triangles.begin(), mesh.triangles.begin() + 2);
  EXPECT_EQ(flagged(flags_of(mesh)), 0);
}

TEST(Coincidence, NonFiniteTrianglesOverlapNothing) {
  const float infinity = std::numeric_limits<float>::infinity();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  TriangleMesh mesh = box_on_floor();
  add_triangle(mesh, {-1, -1, 0.25f}, {nan, -1, 0.25f}, {0, 1, 0.25f});
  add_triangle(mesh, {-1, -1, 0.25f}, {1, -1, 0.25f}, {0, infinity, 0.25f});
  add_triangle(mesh, {-infinity, -1, 0.25f}, {1, -1, 0.25f}, {0, 1, infinity});
  EXPECT_EQ(flags_of(mesh), first_four_of(17));
  mesh.triangles.erase(mesh.triangles.begin(), mesh.triangles.begin() + 14);
  EXPECT_EQ(flagged(flags_of(mesh)), 0);
}

}  // namespace
}  // namespace lockstep::test_coincidence
