// Maps from the unit square: samples against the density (chi-square), the Jacobian of the map
// against the density (finite differences), and what happens at the square's edges.
#include "core/warp.h"

#include "tests/chi_square.h"
#include "tests/widths.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include <cmath>

namespace lockstep::test_warp {
namespace {

constexpr int chi_square_tests = 12;  // in this file
constexpr std::uint32_t sample_count = 1 << 18;
constexpr float cones[] = {2.0f, 1.0f, 0.1f, 1e-3f, 1e-7f};  // 1 - cos of the half angle
constexpr float last = one_minus_epsilon;

void expect_density(const char* name, const CellCounts& counts, const SquareDensity& density) {
  const DensityTest test = counts.test(density);
  EXPECT_GT(test.chi_square.p_value, sidak_significance(chi_square_tests))
      << name << ": chi-square " << test.chi_square.statistic << " with " << test.chi_square.degrees
      << " degrees of freedom";
  EXPECT_NEAR(test.mass, 1.0, 1e-4) << name;
}

double turn(double x, double y) {
  const double t = std::atan2(y, x) / (2.0 * double(pi));
  return t < 0.0 ? t + 1.0 : t;
}

TEST(Warp, ConcentricDiskIsUniform) {
  CellCounts counts(32, 32);
  for (std::uint32_t i = 0; i < sample_count; ++i) {
    const glm::dvec2 d(concentric_disk(uniform2(i, 1)));
    counts.add({glm::dot(d, d), turn(d.x, d.y)});
  }
  expect_density("disk", counts, [](glm::dvec2) { return 1.0; });
}

TEST(Warp, UniformPolygonIsUniformInEachOfItsTriangles) {
  for (const int corners : {3, 8, 128}) {
    const double sector = 2.0 * double(pi) / corners;
    CellCounts counts(32, 128);
    for (std::uint32_t i = 0; i < sample_count; ++i) {
      const glm::dvec2 d(uniform_polygon(uniform2(i, 9), float(corners)));
      const double place = turn(d.x, d.y) * corners, first = std::floor(place);
      // Along and across the triangle: distance from the centre over that of the edge, squared.
      const double middle = (first + 0.5) * sector;
      const double across = d.x * std::cos(middle) + d.y * std::sin(middle);
      const double along = d.y * std::cos(middle) - d.x * std::sin(middle);
      const double r = across / std::cos(0.5 * sector);
      const double share = 0.5 + 0.5 * along / (r * std::sin(0.5 * sector));
      counts.add({r * r, (first + share) / corners});
    }
    expect_density("polygon", counts, [](glm::dvec2) { return 1.0; });
  }
}

TEST(Warp, UniformPolygonIsContinuous) {
  constexpr int n = 256;
  const auto at = [](int i, int k) {
    return uniform_polygon(Vec2<float>(float(i) / n, float(k) / n), 128.0f);
  };
  for (int i = 0; i < n; ++i) {
    for (int k = 0; k < n; ++k) {
      EXPECT_LT(glm::distance(at(i, k), at(i + 1, k)), 3.0f / n) << i << " " << k;
      EXPECT_LT(glm::distance(at(i, k), at(i, k + 1)), 3.0f / n) << i << " " << k;
    }
  }
}

TEST(Warp, CosineHemisphereHasItsDensity) {
  const DirectionMap map(glm::dvec3(0.0, 0.0, 1.0));
  CellCounts counts(32, 32);
  for (std::uint32_t i = 0; i < sample_count; ++i) {
    counts.add(map.to_square(cosine_hemisphere(uniform2(i, 2))));
  }
  expect_density("cosine hemisphere", counts, [&](glm::dvec2 p) {
    const float pdf = cosine_hemisphere_pdf(float(map.to_direction(p).z));
    return double(pdf) * map.solid_angle_per_area(p);
  });
}

TEST(Warp, UniformSphereIsUniform) {
  const DirectionMap map(glm::dvec3(0.2, 0.5, -0.3));
  CellCounts counts(32, 32);
  for (std::uint32_t i = 0; i < sample_count; ++i) {
    counts.add(map.to_square(uniform_sphere(uniform2(i, 3))));
  }
  expect_density("sphere", counts, [](glm::dvec2) { return 1.0; });
}

// 1 - cos of the angle to +z, from x and y: z itself has lost it in a tiny cone.
double one_minus_cos_of(glm::dvec3 w) {
  const double sin2 = w.x * w.x + w.y * w.y;
  return w.z > 0.0 ? sin2 / (1.0 + std::sqrt(std::max(0.0, 1.0 - sin2))) : 1.0 - w.z;
}

TEST(Warp, UniformConeIsUniformHoweverTiny) {
  for (const float cone : cones) {
    CellCounts counts(32, 32);
    for (std::uint32_t i = 0; i < sample_count; ++i) {
      const glm::dvec3 w(uniform_cone(uniform2(i, 4), cone));
      counts.add({one_minus_cos_of(w) / double(cone), turn(w.x, w.y)});
    }
    const double solid_angle = 2.0 * double(pi) * double(cone);
    expect_density("cone", counts,
                   [&](glm::dvec2) { return double(uniform_cone_pdf(cone)) * solid_angle; });
  }
}

TEST(Warp, UniformTriangleIsUniform) {
  CellCounts counts(32, 32);
  for (std::uint32_t i = 0; i < sample_count; ++i) {
    const glm::dvec2 b(uniform_triangle(uniform2(i, 5)));
    const double sum = b.x + b.y;
    counts.add({sum * sum, sum > 0.0 ? b.x / sum : 0.0});
  }
  expect_density("triangle", counts, [](glm::dvec2) { return 1.0; });
}

// Area (on the map's surface) per area of the square around u, by central differences.
template <class F>
double jacobian(F map, Vec2<float> u) {
  constexpr float h = 0x1p-8f;
  const auto at = [&](float x, float y) { return glm::dvec3(map(Vec2<float>(u.x + x, u.y + y))); };
  const glm::dvec3 dx = (at(h, 0.0f) - at(-h, 0.0f)) / double(2.0f * h);
  const glm::dvec3 dy = (at(0.0f, h) - at(0.0f, -h)) / double(2.0f * h);
  return glm::length(glm::cross(dx, dy));
}

template <class F, class Pdf>
void expect_jacobian(const char* name, F map, Pdf pdf) {
  for (std::uint32_t i = 0; i < 2000; ++i) {
    const Vec2<float> u = uniform2(i, 6) * 0.9f + 0.05f;
    // Away from the folds of the piecewise maps.
    if (std::abs(u.x - u.y) < 0.01f || std::abs(u.x + u.y - 1.0f) < 0.01f) continue;
    EXPECT_NEAR(jacobian(map, u) * double(pdf(map(u))), 1.0, 4e-3)
        << name << " at " << u.x << ", " << u.y;
  }
}

TEST(Warp, JacobiansAreTheInverseDensities) {
  const auto flat = [](Vec2<float> p) { return glm::vec3(p.x, p.y, 0.0f); };
  expect_jacobian(
      "disk", [&](Vec2<float> u) { return flat(concentric_disk(u)); },
      [](glm::vec3) { return inv_pi; });
  expect_jacobian(
      "hemisphere", [](Vec2<float> u) { return cosine_hemisphere(u); },
      [](glm::vec3 w) { return cosine_hemisphere_pdf(w.z); });
  expect_jacobian(
      "sphere", [](Vec2<float> u) { return uniform_sphere(u); },
      [](glm::vec3) { return 0.25f * inv_pi; });
  expect_jacobian(
      "triangle", [&](Vec2<float> u) { return flat(uniform_triangle(u)); },
      [](glm::vec3) { return 2.0f; });
  for (const float cone : cones) {
    expect_jacobian(
        "cone", [&](Vec2<float> u) { return uniform_cone(u, cone); },
        [&](glm::vec3) { return uniform_cone_pdf(cone); });
  }
}

TEST(Warp, StaysInRangeOnTheWholeSquare) {
  std::vector<Vec2<float>> points;
  for (const float x : {0.0f, 0x1p-24f, 0.5f, last}) {
    for (const float y : {0.0f, 0x1p-24f, 0.25f, 0.5f, 0.75f, last}) points.push_back({x, y});
  }
  for (std::uint32_t i = 0; i < 20000; ++i) points.push_back(uniform2(i, 7));
  for (const Vec2<float> u : points) {
    const Vec2<float> d = concentric_disk(u);
    EXPECT_LE(std::hypot(d.x, d.y), 1.0f + 2e-7f);
    const glm::vec3 hemisphere = cosine_hemisphere(u);
    EXPECT_GE(hemisphere.z, 0.0f);
    // At the rim z is the root of a rounding error.
    EXPECT_NEAR(length(hemisphere), 1.0f, 3e-7f) << u.x << ", " << u.y;
    EXPECT_NEAR(length(uniform_sphere(u)), 1.0f, 6e-7f) << u.x << ", " << u.y;
    const Vec2<float> b = uniform_triangle(u);
    EXPECT_GE(std::min(b.x, b.y), 0.0f);
    EXPECT_LE(b.x + b.y, 1.0f);
    for (const float cone : cones) {
      const glm::vec3 w = uniform_cone(u, cone);
      EXPECT_NEAR(length(w), 1.0f, 6e-7f);
      EXPECT_GE(w.z, 1.0f - cone - 1e-6f);
      EXPECT_LE(one_minus_cos_of(w), double(cone) * (1.0 + 1e-6));
    }
  }
}

// Largest step of the map between points of the square that lie 2^-20 apart, along lines across it.
template <class F>
float largest_step(F map) {
  constexpr float h = 0x1p-20f;
  float worst = 0.0f;
  for (std::uint32_t i = 0; i < 4000; ++i) {
    const float t = uniform3(i, 8).x * 0.98f + 0.01f;
    for (const Vec2<float> u : {Vec2<float>(t, t), Vec2<float>(t, 1.0f - t), Vec2<float>(t, 0.5f),
                                Vec2<float>(0.5f, t)}) {
      worst = std::max(worst, length(map({u.x - h, u.y}) - map({u.x + h, u.y})));
      worst = std::max(worst, length(map({u.x, u.y - h}) - map({u.x, u.y + h})));
    }
  }
  return worst;
}

TEST(Warp, LowDistortionMapsAreContinuous) {
  const auto flat = [](Vec2<float> p) { return glm::vec3(p.x, p.y, 0.0f); };
  EXPECT_LT(largest_step([&](Vec2<float> u) { return flat(concentric_disk(u)); }), 1e-5f);
  EXPECT_LT(largest_step([&](Vec2<float> u) { return flat(uniform_triangle(u)); }), 1e-5f);
  const Vec2<float> centre = concentric_disk(Vec2<float>(0.5f, 0.5f));
  EXPECT_EQ(centre.x, 0.0f);
  EXPECT_EQ(centre.y, 0.0f);
}

TEST(Warp, AnglesWrapAround) {
  EXPECT_LT(length(uniform_sphere<float>({0.3f, 0.0f}) - uniform_sphere<float>({0.3f, last})),
            1e-6f);
  EXPECT_LT(
      length(uniform_cone<float>({0.3f, 0.0f}, 0.5f) - uniform_cone<float>({0.3f, last}, 0.5f)),
      1e-6f);
}

TEST(Warp, HasTheSameBitsAtEveryWidth) {
  for_each_width([](auto width) {
    constexpr int W = width();
    using V = Float<W>;
    for (std::uint32_t i = 0; i < 4096; i += W) {
      float x[W], y[W];
      for (int k = 0; k < W; ++k) {
        x[k] = uniform3(i + std::uint32_t(k), 9).x;
        y[k] = k == 1 ? x[k] : uniform3(i + std::uint32_t(k), 9).y;
      }
      x[0] = 0.0f;
      y[W - 1] = last;
      const Vec2<V> u(load<V>(x), load<V>(y));
      const auto disk = concentric_disk(u), triangle = uniform_triangle(u);
      const auto hemisphere = cosine_hemisphere(u), sphere = uniform_sphere(u);
      const auto cone = uniform_cone(u, V(0.01f));
      for (int k = 0; k < W; ++k) {
        const Vec2<float> s(x[k], y[k]);
        ASSERT_TRUE(same_value(disk.x[k], concentric_disk(s).x));
        ASSERT_TRUE(same_value(disk.y[k], concentric_disk(s).y));
        ASSERT_TRUE(same_value(triangle.x[k], uniform_triangle(s).x));
        ASSERT_TRUE(same_value(triangle.y[k], uniform_triangle(s).y));
        ASSERT_TRUE(same_value(lane(hemisphere, k), cosine_hemisphere(s)));
        ASSERT_TRUE(same_value(lane(sphere, k), uniform_sphere(s)));
        ASSERT_TRUE(same_value(lane(cone, k), uniform_cone(s, 0.01f)));
      }
    }
  });
}

}  // namespace
}  // namespace lockstep::test_warp
