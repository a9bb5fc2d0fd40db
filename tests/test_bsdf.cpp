// Reflection models: samples against the density, weights against the values, reciprocity, energy,
// and the normalisation of the microfacet distribution.
#include "core/bsdf.h"

#include "tests/bsdf_checks.h"

#include <gtest/gtest.h>
#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace lockstep::test_bsdf {
namespace {

constexpr std::uint32_t sample_count = 1 << 17;

struct MaterialCase {
  std::string name;
  MaterialKind kind;
  std::array<float, material_stride> row;  // as core/scene_data.h lays them out
  double power = 1.0;  // of the direction map around the mirror direction; 1: around the normal
};

MaterialCase diffuse(const char* name, glm::vec3 rho) {
  return {name, MaterialKind::Diffuse, {rho.x, rho.y, rho.z}};
}

MaterialCase conductor(const char* name, float alpha_x, float alpha_y, double power = 1.0) {
  // Copper, but for the third channel, which reflects everything.
  return {name,
          MaterialKind::Conductor,
          {0.2f, 0.92f, 0.0f, 3.9f, 2.45f, 50.0f, alpha_x, alpha_y},
          power};
}

// Reflectance of a dielectric to diffuse light from inside, by the midpoint rule.
float inner_reflectance(float eta) {
  double outer = 0.0;
  for (int i = 0; i < 2000; ++i) {
    const float c = (float(i) + 0.5f) / 2000.0f;
    outer += 2.0 * double(c * fresnel_dielectric(c, eta)) / 2000.0;
  }
  return float(1.0 - (1.0 - outer) / double(eta * eta));
}

MaterialCase coated(const char* name, glm::vec3 base, glm::vec3 coat, float alpha, float layered,
                    float eta = 1.5f, double power = 1.0) {
  return {
      name,
      MaterialKind::Coated,
      {base.x, base.y, base.z, coat.x, coat.y, coat.z, alpha, eta, layered, inner_reflectance(eta)},
      power};
}

const std::vector<MaterialCase>& cases() {
  const glm::vec3 black(0.0f), white(1.0f), orange(0.9f, 0.4f, 0.05f), blue(0.1f, 0.2f, 0.8f);
  static const std::vector<MaterialCase> list = {
      diffuse("diffuse", orange),
      conductor("conductor .01", 0.01f, 0.01f, 4.0),
      conductor("conductor .1", 0.1f, 0.1f, 2.0),
      conductor("conductor .5", 0.5f, 0.5f),
      conductor("conductor 1", 1.0f, 1.0f),
      conductor("conductor .1 .4", 0.1f, 0.4f, 2.0),
      conductor("conductor .6 .05", 0.6f, 0.05f, 2.0),
      coated("layered .01", blue, white, 0.01f, 1.0f, 1.5f, 4.0),
      coated("layered .1", orange, white, 0.1f, 1.0f, 1.5f, 2.0),
      coated("layered .3, dense", blue, white, 0.3f, 1.0f, 2.4f),
      coated("layered 1", orange, white, 1.0f, 1.0f, 1.33f),
      coated("layered, black base", black, white, 0.2f, 1.0f),
      coated("layered, black coat", orange, black, 0.2f, 1.0f),
      coated("added .05", 0.5f * orange, 0.5f * white, 0.05f, 0.0f, 1.5f, 3.0),
      coated("added .5", 0.5f * blue, 0.4f * white, 0.5f, 0.0f),
  };
  return list;
}

constexpr float view_angles[] = {0.0f, 30.0f, 60.0f, 85.0f};

// f(bsdf) for the model of that kind, loaded for `index`.
template <class I, class F>
auto with_bsdf(MaterialKind kind, const MaterialTable& table, I index, F f) {
  if (kind == MaterialKind::Conductor) return f(load_conductor(table, index));
  if (kind == MaterialKind::Coated) return f(load_coated(table, index));
  return f(load_diffuse(table, index));
}

BsdfValue<float> eval_case(const MaterialCase& c, glm::vec3 wo, glm::vec3 wi) {
  const MaterialTable table{c.row.data()};
  return with_bsdf(c.kind, table, 0, [&](const auto& bsdf) { return eval_once(bsdf, wo, wi); });
}

BsdfSample<float> sample_case(const MaterialCase& c, glm::vec3 wo, glm::vec3 u) {
  const MaterialTable table{c.row.data()};
  return with_bsdf(c.kind, table, 0, [&](const auto& bsdf) {
    return sample_once(bsdf, wo, u.z, Vec2<float>(u.x, u.y));
  });
}

// Calls f(case, wo, label, seed) for every material and view.
template <class F>
void for_each_case(F f) {
  std::uint32_t seed = 100;
  for (const MaterialCase& c : cases()) {
    for (const float angle : view_angles) {
      f(c, view_direction(angle), c.name + " at " + std::to_string(int(angle)) + " degrees",
        ++seed);
    }
  }
}

TEST(Bsdf, SamplesHaveTheDensityThatEvalGives) {
  const double significance = sidak_significance(int(cases().size() * std::size(view_angles)));
  for_each_case([&](const MaterialCase& c, glm::vec3 wo, const std::string& label,
                    std::uint32_t seed) {
    // Around the normal the horizon, where densities jump, is an edge between cells.
    const DirectionMap map(
        c.power > 1.0 ? glm::dvec3(-wo.x, -wo.y, wo.z) : glm::dvec3(0.0, 0.0, 1.0), c.power);
    CellCounts counts(48, 24);
    for (std::uint32_t i = 0; i < sample_count; ++i) {
      const BsdfSample<float> s = sample_case(c, wo, uniform3(i, seed));
      s.pdf > 0.0f ? counts.add(map.to_square(s.wi)) : counts.add_lost();
    }
    const DensityTest test = counts.test([&](glm::dvec2 p) {
      const glm::vec3 wi(map.to_direction(p));
      return wi.z > 0.0f ? double(eval_case(c, wo, wi).pdf) * map.solid_angle_per_area(p) : 0.0;
    });
    EXPECT_GT(test.chi_square.p_value, significance)
        << label << ": chi-square " << test.chi_square.statistic << " with "
        << test.chi_square.degrees << " degrees of freedom";
    EXPECT_LE(test.mass, 1.0 + 2e-4) << label;
    // What the density lacks of 1 is what sample() loses below the horizon.
    const double sigma = std::sqrt(std::max(1e-9, test.mass * (1.0 - test.mass)) / test.samples);
    EXPECT_NEAR(test.valid_share, test.mass, 5.0 * sigma + 1e-4) << label;
  });
}

TEST(Bsdf, WeightIsValueOverDensity) {
  for_each_case(
      [](const MaterialCase& c, glm::vec3 wo, const std::string& label, std::uint32_t seed) {
        int failures = 0;
        for (std::uint32_t i = 0; i < 4096 && failures < 3; ++i) {
          const BsdfSample<float> s = sample_case(c, wo, uniform3(i, seed));
          if (!(s.pdf > 0.0f)) continue;
          const BsdfValue<float> v = eval_case(c, wo, s.wi);
          // The half vector loses digits to cancellation where both directions graze.
          const float tolerance = 2e-3f;
          const float pdf_error = std::abs(v.pdf / s.pdf - 1.0f);
          const glm::vec3 error = abs(s.weight * s.pdf - v.f_cos) / v.pdf;
          if (pdf_error < tolerance && max_component(error) < tolerance) continue;
          ++failures;
          ADD_FAILURE() << label << ", sample " << i << ": pdf " << s.pdf << " against " << v.pdf
                        << ", weight off by " << max_component(error) << ", wi.z " << s.wi.z;
        }
      });
}

TEST(Bsdf, IsReciprocal) {
  for (const MaterialCase& c : cases()) {
    for (std::uint32_t i = 0; i < 4096; ++i) {
      const glm::vec3 a = cosine_hemisphere(uniform2(i, 1)), b = cosine_hemisphere(uniform2(i, 2));
      if (std::min(a.z, b.z) < 1e-3f) continue;
      const glm::vec3 ab = eval_case(c, a, b).f_cos / b.z, ba = eval_case(c, b, a).f_cos / a.z;
      ASSERT_LT(max_component(abs(ab - ba)), 1e-4f * max_component(ab) + 1e-6f) << c.name;
    }
  }
}

struct Mean {
  glm::dvec3 value{0.0}, sigma{0.0};
};

// Share of white light from everywhere that leaves along wo, and its standard error.
Mean albedo(const MaterialCase& c, glm::vec3 wo, std::uint32_t seed) {
  glm::dvec3 sum(0.0), squares(0.0);
  for (std::uint32_t i = 0; i < sample_count; ++i) {
    const BsdfSample<float> s = sample_case(c, wo, uniform3(i, seed));
    const glm::dvec3 w = s.pdf > 0.0f ? glm::dvec3(s.weight) : glm::dvec3(0.0);
    sum += w, squares += w * w;
  }
  const double n = sample_count;
  const glm::dvec3 mean = sum / n;
  return {mean, glm::sqrt(glm::max(squares / n - mean * mean, 0.0) / n)};
}

TEST(Bsdf, ReturnsNoMoreThanItReceives) {
  for_each_case(
      [](const MaterialCase& c, glm::vec3 wo, const std::string& label, std::uint32_t seed) {
        const Mean a = albedo(c, wo, seed);
        for (int channel = 0; channel < 3; ++channel) {
          EXPECT_LE(a.value[channel], 1.0 + 4.0 * a.sigma[channel] + 1e-5) << label;
          EXPECT_GE(a.value[channel], 0.0) << label;
          if (c.kind == MaterialKind::Diffuse) {
            EXPECT_NEAR(a.value[channel], double(c.row[std::size_t(channel)]), 1e-6) << label;
          }
        }
      });
}

// White base, white coat, and a metal that reflects everything. Nothing is gained; nothing is lost
// where the surface is nearly smooth and not seen at a grazing angle. Rough ones lose what would
// take more than one bounce between microfacets, and light enters the coat as if it were smooth.
TEST(Bsdf, WhiteFurnace) {
  const glm::vec3 white(1.0f);
  for (const float angle : view_angles) {
    const glm::vec3 wo = view_direction(angle);
    double last_mirror = 1.0;
    for (const float alpha : {0.01f, 0.1f, 0.3f, 1.0f}) {
      const Mean layered = albedo(coated("", white, white, alpha, 1.0f), wo, 1);
      const Mean metal = albedo(conductor("", alpha, alpha), wo, 2);
      EXPECT_LE(layered.value.x, 1.0 + 4.0 * layered.sigma.x) << alpha << " at " << angle;
      EXPECT_LE(metal.value.z, 1.0 + 1e-5) << alpha << " at " << angle;
      if (angle == 0.0f) {
        EXPECT_GE(layered.value.x, 0.97) << alpha;
        EXPECT_LE(metal.value.z, last_mirror + 1e-5) << alpha;
        last_mirror = metal.value.z;
      }
      if (alpha == 0.01f && angle <= 60.0f) {
        EXPECT_NEAR(layered.value.x, 1.0, 4.0 * layered.sigma.x + 5e-4) << angle;
        EXPECT_NEAR(metal.value.z, 1.0, 5e-4) << angle;
      }
    }
  }
}

// Integral over the upper hemisphere per solid angle.
template <class F>
double integrate_hemisphere(F f) {
  const DirectionMap map(glm::dvec3(0.0, 0.0, 1.0), 4.0);
  const double horizon = std::pow(0.5, 0.25);
  constexpr int cells = 16;
  double sum = 0.0;
  for (int i = 0; i < cells; ++i) {
    for (int j = 0; j < cells; ++j) {
      sum += integrate(
          [&](glm::dvec2 p) {
            return f(glm::vec3(map.to_direction(p))) * map.solid_angle_per_area(p);
          },
          {horizon * i / cells, double(j) / cells},
          {horizon * (i + 1) / cells, double(j + 1) / cells}, 1e-7);
    }
  }
  return sum;
}

constexpr Vec2<float> roughnesses[] = {{1e-3f, 1e-3f}, {0.01f, 0.01f}, {0.1f, 0.1f}, {0.5f, 0.5f},
                                       {1.0f, 1.0f},   {0.1f, 0.4f},   {1.0f, 0.05f}};

TEST(Ggx, MicrofacetsCoverTheSurfaceOnce) {
  for (const Vec2<float> alpha : roughnesses) {
    const Ggx<float> ggx{alpha};
    EXPECT_NEAR(integrate_hemisphere([&](glm::vec3 m) { return double(ggx.d(m) * m.z); }), 1.0,
                1e-3)
        << alpha.x << ", " << alpha.y;
  }
}

TEST(Ggx, VisibleMicrofacetsCoverTheProjectedSurfaceOnce) {
  for (const Vec2<float> alpha : roughnesses) {
    const Ggx<float> ggx{alpha};
    for (const float angle : view_angles) {
      const glm::vec3 w = view_direction(angle);
      const double visible = integrate_hemisphere(
          [&](glm::vec3 m) { return double(ggx.d(m) * std::max(0.0f, dot(w, m))); });
      EXPECT_NEAR(double(ggx.g1(w)) * visible / double(w.z), 1.0, 2e-3)
          << alpha.x << ", " << alpha.y << " at " << angle;
    }
  }
}

TEST(Ggx, MaskingIsCorrelatedAndAtMostOne) {
  for (std::uint32_t i = 0; i < 4096; ++i) {
    const Ggx<float> ggx{uniform2(i, 3) + 0.01f};
    const glm::vec3 a = cosine_hemisphere(uniform2(i, 4)), b = cosine_hemisphere(uniform2(i, 5));
    const float both = ggx.g2(a, b);
    EXPECT_LE(both, std::min(ggx.g1(a), ggx.g1(b)) * (1.0f + 1e-6f));
    EXPECT_GE(both, ggx.g1(a) * ggx.g1(b) * (1.0f - 1e-6f));
  }
}

template <int W>
void expect_same_bits_at_width(MaterialKind kind) {
  using V = Float<W>;
  std::vector<float> rows;
  std::vector<std::int32_t> of_kind;
  for (const MaterialCase& c : cases()) {
    if (c.kind == kind) of_kind.push_back(std::int32_t(rows.size()) / material_stride);
    rows.insert(rows.end(), c.row.begin(), c.row.end());
  }
  const MaterialTable table{rows.data()};
  for (std::uint32_t first = 0; first < 8192; first += W) {
    std::int32_t index[W];
    float u[W], v[W], lobe[W];
    Vec3<V> wo(V(0.0f)), wi(V(0.0f));
    float o[3][W], in[3][W];
    for (int k = 0; k < W; ++k) {
      const std::uint32_t i = first + std::uint32_t(k);
      index[k] = of_kind[pcg3d(i, 1u, 1u).x % of_kind.size()];
      const glm::vec3 r = uniform3(i, 6);
      u[k] = r.x, v[k] = r.y, lobe[k] = r.z;
      const glm::vec3 a = cosine_hemisphere(uniform2(i, 7)), b = uniform_sphere(uniform2(i, 8));
      for (int axis = 0; axis < 3; ++axis) o[axis][k] = a[axis], in[axis][k] = b[axis];
    }
    wo = {load<V>(o[0]), load<V>(o[1]), load<V>(o[2])};
    wi = {load<V>(in[0]), load<V>(in[1]), load<V>(in[2])};
    const Int<W> at = load<Int<W>>(index);
    const auto value =
        with_bsdf(kind, table, at, [&](const auto& bsdf) { return eval_once(bsdf, wo, wi); });
    const auto sampled = with_bsdf(kind, table, at, [&](const auto& bsdf) {
      return sample_once(bsdf, wo, load<V>(lobe), Vec2<V>(load<V>(u), load<V>(v)));
    });
    for (int k = 0; k < W; ++k) {
      const glm::vec3 a = lane(wo, k), b = lane(wi, k);
      const MaterialCase& c = cases()[std::size_t(index[k])];
      const BsdfValue<float> one = eval_case(c, a, b);
      const BsdfSample<float> one_sample = sample_case(c, a, {u[k], v[k], lobe[k]});
      ASSERT_TRUE(same_value(lane(value.f_cos, k), one.f_cos)) << c.name << " W=" << W;
      ASSERT_TRUE(same_value(value.pdf[k], one.pdf)) << c.name << " W=" << W;
      ASSERT_TRUE(same_value(lane(sampled.wi, k), one_sample.wi)) << c.name << " W=" << W;
      ASSERT_TRUE(same_value(lane(sampled.weight, k), one_sample.weight)) << c.name << " W=" << W;
      ASSERT_TRUE(same_value(sampled.pdf[k], one_sample.pdf)) << c.name << " W=" << W;
    }
  }
}

TEST(Bsdf, HasTheSameBitsAtEveryWidth) {
  for (const MaterialKind kind :
       {MaterialKind::Diffuse, MaterialKind::Conductor, MaterialKind::Coated}) {
    for_each_width([&](auto width) { expect_same_bits_at_width<width()>(kind); });
  }
}

TEST(Bsdf, SamplesAreFiniteAtTheEdgesOfTheSquare) {
  for_each_case([](const MaterialCase& c, glm::vec3 wo, const std::string& label, std::uint32_t) {
    for (const float x : {0.0f, 0x1p-24f, 0.5f, one_minus_epsilon}) {
      for (const float y : {0.0f, 0.25f, 0.5f, one_minus_epsilon}) {
        for (const float lobe : {0.0f, one_minus_epsilon}) {
          const BsdfSample<float> s = sample_case(c, wo, {x, y, lobe});
          EXPECT_TRUE(is_finite(s.pdf) && is_finite(s.weight.x) && is_finite(s.weight.y))
              << label << " at " << x << ", " << y << ": pdf " << s.pdf;
          EXPECT_NEAR(length(s.wi), 1.0f, 1e-5f) << label << " at " << x << ", " << y;
        }
      }
    }
  });
}

}  // namespace
}  // namespace lockstep::test_bsdf
