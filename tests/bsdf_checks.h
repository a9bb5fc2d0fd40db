// Checks that reflection models share: samples against the density on both sides of the surface,
// weights against values, energy, finiteness, and equal bits at every width.
#pragma once

#include "core/bsdf/scatter.h"
#include "tests/chi_square.h"
#include "tests/widths.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

using MaterialRow = std::vector<float>;  // as the head of the model's file lays it out

// One material, at width 1.
struct BsdfUnderTest {
  std::string name;
  std::function<BsdfValue<float>(glm::vec3 wo, glm::vec3 wi)> eval;
  std::function<ScatterSample<float>(glm::vec3 wo, glm::vec3 u)> sample;  // u.z chooses the lobe
};

inline ScatterSample<float> with_marks(const BsdfSample<float>& s) { return {s, false, 1.0f}; }
inline ScatterSample<float> with_marks(const ScatterSample<float>& s) { return s; }

// What is inlined by force, once for all tests of a model.
template <class Bsdf, class V>
[[gnu::noinline]] auto eval_once(const Bsdf& bsdf, const Vec3<V>& wo, const Vec3<V>& wi) {
  return eval(bsdf, wo, wi);
}
template <class Bsdf, class V>
[[gnu::noinline]] auto sample_once(const Bsdf& bsdf, const Vec3<V>& wo, V lobe, Vec2<V> u) {
  return sample(bsdf, wo, lobe, u);
}

template <class Bsdf>
BsdfUnderTest under_test(std::string name, const Bsdf& bsdf) {
  return {std::move(name), [bsdf](glm::vec3 wo, glm::vec3 wi) { return eval_once(bsdf, wo, wi); },
          [bsdf](glm::vec3 wo, glm::vec3 u) {
            return with_marks(sample_once(bsdf, wo, u.z, Vec2<float>(u.x, u.y)));
          }};
}

// Below the surface for angles above 90 degrees.
inline glm::vec3 view_direction(float degrees) {
  const float a = degrees * pi / 180.0f;
  constexpr float azimuth = 0.6f;
  return {std::sin(a) * std::cos(azimuth), std::sin(a) * std::sin(azimuth), std::cos(a)};
}

inline std::string at_angle(const BsdfUnderTest& bsdf, float degrees) {
  return bsdf.name + " at " + std::to_string(int(degrees)) + " degrees";
}

// Which directions a test of densities looks at; it counts the others as lost.
enum class Side { Both, Same, Other };

inline bool looks_at(Side side, glm::vec3 wo, glm::vec3 wi) {
  return side == Side::Both || (side == Side::Same) == (wo.z * wi.z > 0.0f);
}

// Chi-square test of samples against the density that eval gives; what the density lacks of 1 must
// be what sample() loses. Returns the integral of the density over the directions looked at.
inline double expect_samples_follow_density(const BsdfUnderTest& bsdf, glm::vec3 wo, Side side,
                                            const DirectionMap& map, double significance,
                                            std::uint32_t seed, const std::string& label) {
  constexpr std::uint32_t samples = 1 << 15;
  CellCounts counts(32, 16);
  for (std::uint32_t i = 0; i < samples; ++i) {
    const ScatterSample<float> s = bsdf.sample(wo, uniform3(i, seed));
    const bool counted = s.pdf > 0.0f && looks_at(side, wo, s.wi);
    counted ? counts.add(map.to_square(s.wi)) : counts.add_lost();
  }
  const DensityTest test = counts.test([&](glm::dvec2 p) {
    const glm::vec3 wi(map.to_direction(p));
    if (!looks_at(side, wo, wi)) return 0.0;
    return double(bsdf.eval(wo, wi).pdf) * map.solid_angle_per_area(p);
  });
  EXPECT_GT(test.chi_square.p_value, significance)
      << label << ": chi-square " << test.chi_square.statistic << " with "
      << test.chi_square.degrees << " degrees of freedom";
  EXPECT_LE(test.mass, 1.0 + 1e-3) << label;
  const double sigma = std::sqrt(std::max(1e-9, test.mass * (1.0 - test.mass)) / test.samples);
  EXPECT_NEAR(test.valid_share, test.mass, 5.0 * sigma + 5e-4) << label;
  return test.mass;
}

// f cos / pdf and pdf of samples are those that eval gives for their directions. `tolerance` is
// relative; microfacets seen from outside come from directions, whose digits cancel.
inline void expect_weights_match(const BsdfUnderTest& bsdf, glm::vec3 wo, float tolerance,
                                 std::uint32_t seed, const std::string& label) {
  int failures = 0;
  for (std::uint32_t i = 0; i < 2048 && failures < 3; ++i) {
    const ScatterSample<float> s = bsdf.sample(wo, uniform3(i, seed));
    if (!(s.pdf > 0.0f)) continue;
    const BsdfValue<float> v = bsdf.eval(wo, s.wi);
    const float pdf_error = std::abs(v.pdf / s.pdf - 1.0f);
    const float weight_error = max_component(abs(s.weight * s.pdf - v.f_cos)) / v.pdf;
    if (pdf_error < tolerance && weight_error < tolerance) continue;
    ++failures;
    ADD_FAILURE() << label << ", sample " << i << ": pdf " << s.pdf << " against " << v.pdf
                  << ", weight off by " << weight_error << ", wi.z " << s.wi.z;
  }
}

struct MeanWeight {
  double value = 0.0, sigma = 0.0;  // of the largest channel
};

// What returns of white light from everywhere, as flux: the change of radiance by refraction is
// taken out.
inline MeanWeight albedo(const BsdfUnderTest& bsdf, glm::vec3 wo, std::uint32_t seed,
                         std::uint32_t samples = 1 << 15) {
  double sum = 0.0, squares = 0.0;
  for (std::uint32_t i = 0; i < samples; ++i) {
    const ScatterSample<float> s = bsdf.sample(wo, uniform3(i, seed));
    const double w = s.pdf > 0.0f ? double(max_component(s.weight) / s.scale) : 0.0;
    sum += w, squares += w * w;
  }
  const double mean = sum / samples;
  return {mean, std::sqrt(std::max(squares / samples - mean * mean, 0.0) / samples)};
}

// Finite, not negative, and unit directions: at grazing angles and the edges of the square.
inline void expect_finite_at_extremes(const BsdfUnderTest& bsdf, bool from_below) {
  const auto good = [](float x) { return is_finite(x) && x >= 0.0f; };
  for (const float cos_o : {1e-4f, -1e-4f, 0.0f, 0.5f, -0.5f, 1.0f, -1.0f}) {
    if (cos_o <= 0.0f && !from_below) continue;
    const glm::vec3 wo(std::sqrt(1.0f - cos_o * cos_o), 0.0f, cos_o);
    for (const float x : {0.0f, 0x1p-24f, 0.5f, one_minus_epsilon}) {
      for (const float y : {0.0f, 0.25f, 0.5f, one_minus_epsilon}) {
        for (const float lobe : {0.0f, 0.03f, 0.5f, one_minus_epsilon}) {
          const ScatterSample<float> s = bsdf.sample(wo, {x, y, lobe});
          EXPECT_TRUE(good(s.pdf)) << bsdf.name << " from " << cos_o << ": pdf " << s.pdf;
          if (!(s.pdf > 0.0f)) continue;
          EXPECT_TRUE(good(s.weight.x) && good(s.weight.y) && good(s.weight.z))
              << bsdf.name << " from " << cos_o << " at " << x << ", " << y << ", " << lobe
              << ": weight " << s.weight.x;
          EXPECT_NEAR(length(s.wi), 1.0f, 1e-5f) << bsdf.name << " from " << cos_o;
        }
      }
    }
    for (std::uint32_t i = 0; i < 512; ++i) {
      glm::vec3 wi = uniform_sphere(uniform2(i, 40));
      if (i % 4 == 0) wi = glm::normalize(glm::vec3(wi.x, wi.y, wi.z < 0.0f ? -1e-4f : 1e-4f));
      if (wi.z < 0.0f && !from_below) continue;
      const BsdfValue<float> v = bsdf.eval(wo, wi);
      EXPECT_TRUE(good(v.pdf) && good(v.f_cos.x) && good(v.f_cos.y) && good(v.f_cos.z))
          << bsdf.name << " from " << cos_o << " to " << wi.x << ", " << wi.y << ", " << wi.z
          << ": pdf " << v.pdf << ", f cos " << v.f_cos.x;
    }
  }
}

// Equal bits in every lane of packets that mix the materials, against width 1. load(table, index)
// gives the model.
template <int W, class Load>
void expect_same_bits(const std::vector<MaterialRow>& materials, bool from_below, Load load_bsdf) {
  using V = Float<W>;
  std::vector<float> rows;
  for (MaterialRow row : materials) {
    row.resize(material_stride, 0.0f);
    rows.insert(rows.end(), row.begin(), row.end());
  }
  rows.resize(rows.size() + 3, 0.0f);
  const MaterialTable table{rows.data()};
  for (std::uint32_t first = 0; first < 4096; first += W) {
    std::int32_t index[W];
    float u[3][W], o[3][W], in[3][W];
    for (int k = 0; k < W; ++k) {
      const std::uint32_t i = first + std::uint32_t(k);
      // Half of the packets hold one material: blocks are skipped there.
      const std::uint32_t key = first / 16 % 2 == 0 ? i : first / 16;
      index[k] = std::int32_t(pcg3d(key, 1u, 1u).x % materials.size());
      const glm::vec3 r = uniform3(i, 6), b = uniform_sphere(uniform2(i, 8));
      glm::vec3 a = uniform_sphere(uniform2(i, 7));
      if (!from_below) a.z = std::max(std::abs(a.z), 1e-4f);
      for (int axis = 0; axis < 3; ++axis) {
        u[axis][k] = r[axis], o[axis][k] = a[axis], in[axis][k] = b[axis];
      }
    }
    const Vec3<V> wo(load<V>(o[0]), load<V>(o[1]), load<V>(o[2]));
    const Vec3<V> wi(load<V>(in[0]), load<V>(in[1]), load<V>(in[2]));
    const auto bsdf = load_bsdf(table, load<Int<W>>(index));
    const BsdfValue<V> value = eval_once(bsdf, wo, wi);
    const auto s = sample_once(bsdf, wo, load<V>(u[2]), Vec2<V>(load<V>(u[0]), load<V>(u[1])));
    for (int k = 0; k < W; ++k) {
      const auto one_bsdf = load_bsdf(table, index[k]);
      const glm::vec3 a = lane(wo, k);
      const BsdfValue<float> one = eval_once(one_bsdf, a, lane(wi, k));
      const auto t = sample_once(one_bsdf, a, u[2][k], Vec2<float>(u[0][k], u[1][k]));
      ASSERT_TRUE(same_value(lane(value.f_cos, k), one.f_cos)) << index[k] << " W=" << W;
      ASSERT_TRUE(same_value(value.pdf[k], one.pdf)) << index[k] << " W=" << W;
      ASSERT_TRUE(same_value(lane(s.wi, k), t.wi)) << index[k] << " W=" << W;
      ASSERT_TRUE(same_value(lane(s.weight, k), t.weight)) << index[k] << " W=" << W;
      ASSERT_TRUE(same_value(s.pdf[k], t.pdf)) << index[k] << " W=" << W;
      ASSERT_EQ(lane(is_delta(s), k), is_delta(t)) << index[k] << " W=" << W;
      ASSERT_TRUE(same_value(radiance_scale(s)[k], radiance_scale(t))) << index[k] << " W=" << W;
    }
  }
}

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
