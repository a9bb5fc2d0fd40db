// Elementary functions: the error bounds that core/simd_math.h states, and equal bits at every
// width. Hashes, vectors and frames likewise.
#include "core/simd_math.h"

#include "core/frame.h"
#include "core/simd_exp.h"
#include "tests/widths.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace lockstep::test_simd_math {
namespace {

double error_of_eighth(float x) {
  const SinCos<float> r = sincos_eighth(x);
  return std::max(std::abs(double(r.sin) - std::sin(double(x))),
                  std::abs(double(r.cos) - std::cos(double(x))));
}

double error_of_turns(float u) {
  const SinCos<float> r = sincos_turns(u);
  const double angle = 2.0 * std::numbers::pi * double(u);
  return std::max(std::abs(double(r.sin) - std::sin(angle)),
                  std::abs(double(r.cos) - std::cos(angle)));
}

TEST(SimdMath, SincosEighthKeepsItsBound) {
  constexpr int steps = 1 << 20;
  constexpr float end = 0.785398185f;
  double worst = std::max(error_of_eighth(-end), error_of_eighth(end));
  for (int i = 0; i < steps; ++i) {
    worst = std::max(worst, error_of_eighth(end * (float(i) * (2.0f / steps) - 1.0f)));
  }
  EXPECT_LT(worst, 1.2e-7);
  EXPECT_EQ(sincos_eighth(0.0f).sin, 0.0f);
  EXPECT_EQ(sincos_eighth(0.0f).cos, 1.0f);
  EXPECT_EQ(sincos_eighth(0x1p-40f).sin, 0x1p-40f);
}

TEST(SimdMath, SincosTurnsKeepsItsBound) {
  constexpr int steps = 1 << 20;
  double worst = 0.0;
  for (int i = 0; i <= steps; ++i) worst = std::max(worst, error_of_turns(float(i) / steps));
  // On both sides of every eighth of a turn, where the polynomials change roles.
  for (int i = 0; i <= 8; ++i) {
    const float u = float(i) / 8.0f;
    worst = std::max(worst, error_of_turns(std::nextafter(u, 0.0f)));
    worst = std::max(worst, error_of_turns(std::min(std::nextafter(u, 1.0f), 1.0f)));
  }
  for (std::uint32_t i = 0; i < steps; ++i)
    worst = std::max(worst, error_of_turns(uniform3(i, 1).x));
  EXPECT_LT(worst, 2e-7);
  EXPECT_EQ(sincos_turns(0.0f).cos, 1.0f);
  EXPECT_EQ(sincos_turns(0.25f).sin, 1.0f);
  EXPECT_EQ(sincos_turns(0.5f).cos, -1.0f);
  EXPECT_EQ(sincos_turns(1.0f).cos, 1.0f);
}

TEST(SimdMath, SincosHasTheSameBitsAtEveryWidth) {
  for_each_width([](auto width) {
    constexpr int W = width();
    for (std::uint32_t i = 0; i < 1 << 14; i += W) {
      float u[W];
      for (int k = 0; k < W; ++k) u[k] = uniform3(i + std::uint32_t(k), 2).x;
      u[0] = i % 64 ? u[0] : float(i % 512) / 512.0f;
      const auto turns = sincos_turns(load<Float<W>>(u));
      const auto eighth = sincos_eighth(load<Float<W>>(u) * Float<W>(0.785f));
      for (int k = 0; k < W; ++k) {
        ASSERT_TRUE(same_value(turns.sin[k], sincos_turns(u[k]).sin));
        ASSERT_TRUE(same_value(turns.cos[k], sincos_turns(u[k]).cos));
        ASSERT_TRUE(same_value(eighth.sin[k], sincos_eighth(u[k] * 0.785f).sin));
        ASSERT_TRUE(same_value(eighth.cos[k], sincos_eighth(u[k] * 0.785f).cos));
      }
    }
  });
}

TEST(SimdMath, RsqrtKeepsItsBound) {
  const auto error_of = [](float x) { return std::abs(rsqrt(x) * std::sqrt(double(x)) - 1.0); };
  double worst = 0.0;
  for (std::uint32_t i = 0; i < 1 << 20; ++i) {
    worst = std::max(worst, error_of(1.0f + 3.0f * uniform3(i, 3).x));
  }
  for (int n = -126; n <= 127; ++n) worst = std::max(worst, error_of(std::ldexp(1.3f, n)));
  EXPECT_LT(worst, 0x1p-22);
  constexpr float infinity = std::numeric_limits<float>::infinity();
  EXPECT_EQ(rsqrt(0.0f), infinity);
  EXPECT_EQ(rsqrt(infinity), 0.0f);
  EXPECT_TRUE(std::isnan(rsqrt(-1.0f)));
  EXPECT_TRUE(std::isnan(rsqrt(std::numeric_limits<float>::quiet_NaN())));
}

TEST(SimdMath, RsqrtHasTheSameBitsAtEveryWidth) {
  for_each_width([](auto width) {
    constexpr int W = width();
    for (std::uint32_t i = 0; i < 1 << 14; i += W) {
      float x[W];
      for (int k = 0; k < W; ++k) {
        x[k] = std::ldexp(uniform3(i + std::uint32_t(k), 4).x, int(i % 250) - 125);
      }
      x[0] = i % 64 ? x[0] : 0.0f;
      const auto wide = rsqrt(load<Float<W>>(x));
      for (int k = 0; k < W; ++k) ASSERT_TRUE(same_value(wide[k], rsqrt(x[k])));
    }
  });
}

TEST(Hash, HasTheSameBitsAtEveryWidth) {
  for_each_width([](auto width) {
    constexpr int W = width();
    const UInt<W> x = as_uint(lane_indices<W>());
    const auto h3 = pcg3d(x, UInt<W>(5u), UInt<W>(9u));
    const auto h4 = pcg4d(x, UInt<W>(5u), UInt<W>(9u), UInt<W>(~0u));
    for (int k = 0; k < W; ++k) {
      const auto i = std::uint32_t(k);
      const auto n3 = pcg3d(i, 5u, 9u);
      const auto n4 = pcg4d(i, 5u, 9u, ~0u);
      EXPECT_TRUE(h3.x[k] == n3.x && h3.y[k] == n3.y && h3.z[k] == n3.z);
      EXPECT_TRUE(h4.x[k] == n4.x && h4.y[k] == n4.y && h4.z[k] == n4.z && h4.w[k] == n4.w);
    }
  });
}

TEST(Hash, UnitFloatStaysBelowOne) {
  EXPECT_EQ(unit_float(0u), 0.0f);
  EXPECT_EQ(unit_float(255u), 0.0f);
  EXPECT_EQ(unit_float(~0u), 1.0f - 0x1p-24f);
  EXPECT_EQ(one_minus_epsilon, std::nextafter(1.0f, 0.0f));
}

TEST(SimdMath, Log2KeepsItsBound) {
  const auto expect_near = [](float x) {
    const double expected = std::log2(double(x));
    const double bound = 2e-7 + std::ldexp(std::abs(expected), -24);
    ASSERT_LT(std::abs(double(log2(x)) - expected), bound) << x;
  };
  constexpr int steps = 1 << 20;
  for (int i = 0; i < steps; ++i) expect_near(0.5f + 2.0f * float(i) / steps);
  for (int n = -126; n <= 127; ++n) {
    const float power = std::ldexp(1.0f, n);
    EXPECT_EQ(log2(power), float(n));
    for (const float m : {1.0f, 1.41421354f, 1.41421366f, 1.7f}) expect_near(m * power);
    expect_near(std::nextafter(power, 1.0f));
  }
  expect_near(std::numeric_limits<float>::max());
  for_each_width([&](auto width) {
    constexpr int W = width();
    for (std::uint32_t first = 0; first < 4096; first += W) {
      float x[W];
      for (int k = 0; k < W; ++k) {
        x[k] = std::exp2(200.0f * uniform2(first + std::uint32_t(k), 9).x - 100.0f);
      }
      const Float<W> wide = log2(load<Float<W>>(x));
      for (int k = 0; k < W; ++k) ASSERT_TRUE(same_value(wide[k], log2(x[k])));
    }
  });
}

TEST(Vec, ProductsMatchGlmAndAreTheSameAtEveryWidth) {
  for (std::uint32_t i = 0; i < 1000; ++i) {
    const glm::vec3 a = uniform3(i, 3) - 0.5f, b = uniform3(i, 4) - 0.5f;
    const glm::dvec3 da(a), db(b);
    EXPECT_NEAR(dot(a, b), glm::dot(da, db), 1e-7);
    EXPECT_NEAR(glm::length(glm::dvec3(cross(a, b)) - glm::cross(da, db)), 0.0, 1e-7);
    EXPECT_NEAR(length(a), glm::length(da), 1e-7);
    EXPECT_NEAR(glm::length(glm::dvec3(normalize(a)) - glm::normalize(da)), 0.0, 3e-7);
    for_each_width([&](auto width) {
      using V = Float<width()>;
      const Vec3<V> wa = splat<V>(a), wb = splat<V>(b);
      EXPECT_TRUE(same_value(dot(wa, wb)[1], dot(a, b)));
      EXPECT_TRUE(same_value(lane(cross(wa, wb), 2), cross(a, b)));
      EXPECT_TRUE(same_value(lane(normalize(wa), 3), normalize(a)));
      EXPECT_TRUE(same_value(luminance(wa)[0], luminance(a)));
      EXPECT_TRUE(same_value(max_component(wa)[0], max_component(a)));
    });
  }
}

// Largest deviation of the frame from an orthonormal right-handed one around n.
double frame_error(glm::vec3 n) {
  const Frame<float> f = frame_around(n);
  const glm::dvec3 x(f.x), y(f.y), z(f.z);
  const double lengths = std::max(std::abs(glm::length(x) - 1.0), std::abs(glm::length(y) - 1.0));
  const double angles =
      std::max({std::abs(glm::dot(x, y)), std::abs(glm::dot(y, z)), std::abs(glm::dot(z, x))});
  return std::max(
      {lengths, angles, glm::length(glm::cross(x, y) - z), glm::length(z - glm::dvec3(n))});
}

TEST(Vec, NormalizeAnyTakesAnyLength) {
  for (int n = -126; n <= 127; ++n) {
    const float x = std::ldexp(1.5f, n);
    EXPECT_GE(x * power_of_two_scale(x), 0.5f);
    EXPECT_LT(x * power_of_two_scale(x), 4.0f);
    const Vec3<float> unit = normalize_any(Vec3<float>(x, -x, 0.5f * x));
    EXPECT_NEAR(unit.x, 2.0f / 3.0f, 1e-6f) << n;
    EXPECT_NEAR(unit.y, -2.0f / 3.0f, 1e-6f) << n;
    EXPECT_NEAR(unit.z, 1.0f / 3.0f, 1e-6f) << n;
  }
}

TEST(Frame, IsOrthonormalAroundAnyNormal) {
  double worst = 0.0;
  for (std::uint32_t i = 0; i < 20000; ++i) {
    const glm::vec3 n = normalize(uniform3(i, 5) * 2.0f - 1.0f);
    worst = std::max(worst, frame_error(n));
    const glm::vec3 near_pole = normalize(glm::vec3(1e-4f * n.x, 1e-4f * n.y, n.z));
    worst = std::max(worst, frame_error(near_pole));
  }
  for (const float z : {1.0f, -1.0f}) worst = std::max(worst, frame_error({0.0f, 0.0f, z}));
  for (const float z : {0.0f, -0.0f}) worst = std::max(worst, frame_error({1.0f, 0.0f, z}));
  EXPECT_LT(worst, 5e-7);
}

TEST(Frame, ToLocalUndoesToWorld) {
  for (std::uint32_t i = 0; i < 1000; ++i) {
    const Frame<float> f = frame_around(normalize(uniform3(i, 6) * 2.0f - 1.0f));
    const glm::vec3 v = uniform3(i, 7) - 0.5f;
    EXPECT_LT(length(f.to_local(f.to_world(v)) - v), 1e-6f);
    EXPECT_NEAR(f.to_local(f.z).z, 1.0f, 1e-6f);
  }
}

}  // namespace
}  // namespace lockstep::test_simd_math
