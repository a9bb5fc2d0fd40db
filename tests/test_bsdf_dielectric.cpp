// The dielectric boundary: smooth, rough and thin, from both sides.
#include "core/bsdf/dielectric.h"

#include "core/fresnel.h"
#include "tests/bsdf_checks.h"

namespace lockstep::test_bsdf_dielectric {
namespace {

DielectricBsdf<float> glass(float eta, float alpha, bool thin = false) {
  const glm::vec3 white(1.0f);
  return {white, white, {{alpha, alpha}}, eta, thin};
}

std::string name_of(const DielectricBsdf<float>& b) {
  return std::string(b.thin ? "sheet, " : "") + "eta " + std::to_string(b.eta).substr(0, 4) +
         ", alpha " + std::to_string(b.ggx.alpha.x).substr(0, 4);
}
BsdfUnderTest under_test(const DielectricBsdf<float>& b) { return under_test(name_of(b), b); }

struct Case {
  DielectricBsdf<float> bsdf;
  float degrees;  // of wo from the normal; above 90: from inside
};

std::vector<Case> rough_cases() {
  std::vector<Case> list;
  for (const float eta : {0.67f, 1.33f, 1.5f, 2.4f}) {
    for (const float alpha : {0.03f, 0.25f, 1.0f}) {
      for (const float degrees : {0.0f, 40.0f, 80.0f}) list.push_back({glass(eta, alpha), degrees});
    }
    list.push_back({glass(eta, 0.1f), 120.0f});
    list.push_back({glass(eta, 0.6f), 160.0f});
  }
  DielectricBsdf<float> tinted = glass(1.5f, 0.1f);
  tinted.ggx.alpha = {0.4f, 0.15f};
  tinted.reflectance = {0.2f, 0.9f, 0.5f};
  tinted.transmittance = {0.3f, 0.1f, 0.05f};
  list.push_back({tinted, 30.0f});
  list.push_back({glass(1.5f, 0.2f, true), 60.0f});
  list.push_back({glass(2.4f, 0.7f, true), 130.0f});
  return list;
}

// Where a smooth boundary sends light.
glm::vec3 peak(const Case& c, glm::vec3 wo, Side side) {
  if (side == Side::Same) return {-wo.x, -wo.y, wo.z};
  if (c.bsdf.thin) return -wo;
  const float eta = wo.z > 0.0f ? c.bsdf.eta : 1.0f / c.bsdf.eta;
  const glm::vec2 t(-wo.x / eta, -wo.y / eta);
  return {t.x, t.y, -std::copysign(std::sqrt(std::max(0.05f, 1.0f - t.x * t.x - t.y * t.y)), wo.z)};
}

TEST(Dielectric, SamplesHaveTheDensityThatEvalGives) {
  const std::vector<Case> cases = rough_cases();
  const double significance = sidak_significance(2 * int(cases.size()));
  std::uint32_t seed = 100;
  for (const Case& c : cases) {
    const BsdfUnderTest bsdf = under_test(c.bsdf);
    const glm::vec3 wo = view_direction(c.degrees);
    double mass = 0.0;
    for (const Side side : {Side::Same, Side::Other}) {
      const float alpha = c.bsdf.ggx.alpha.x;
      const DirectionMap map(alpha < 0.2f ? glm::dvec3(peak(c, wo, side)) : glm::dvec3(0, 0, 1),
                             alpha < 0.05f  ? 4.0
                             : alpha < 0.2f ? 2.0
                                            : 1.0);
      mass += expect_samples_follow_density(
          bsdf, wo, side, map, significance, ++seed,
          at_angle(bsdf, c.degrees) + (side == Side::Same ? ", reflected" : ", passed"));
    }
    EXPECT_LE(mass, 1.0 + 1e-3) << at_angle(bsdf, c.degrees);
  }
}

TEST(Dielectric, WeightIsValueOverDensity) {
  std::uint32_t seed = 300;
  for (const Case& c : rough_cases()) {
    const BsdfUnderTest bsdf = under_test(c.bsdf);
    expect_weights_match(bsdf, view_direction(c.degrees), 2e-2f, ++seed, at_angle(bsdf, c.degrees));
  }
}

// Nothing is lost or gained at a smooth boundary: each sample carries exactly what arrives, times
// the change of radiance where it is refracted.
TEST(Dielectric, SmoothWhiteFurnaceIsExact) {
  for (const bool thin : {false, true}) {
    for (const float eta : {0.67f, 1.0f, 1.33f, 1.5f, 2.4f}) {
      const BsdfUnderTest bsdf = under_test(glass(eta, 0.0f, thin));
      for (const float degrees : {0.0f, 45.0f, 89.0f, 91.0f, 135.0f, 180.0f}) {
        const glm::vec3 wo = view_direction(degrees);
        for (std::uint32_t i = 0; i < 64; ++i) {
          const ScatterSample<float> s = bsdf.sample(wo, uniform3(i, 9));
          const std::string label = at_angle(bsdf, degrees);
          const float relative = wo.z > 0.0f ? eta : 1.0f / eta;
          const bool refracted = !thin && s.wi.z * wo.z < 0.0f;
          EXPECT_TRUE(s.delta) << label;
          EXPECT_GT(s.pdf, 0.0f) << label;
          EXPECT_FLOAT_EQ(s.scale, refracted ? 1.0f / (relative * relative) : 1.0f) << label;
          EXPECT_NEAR(s.weight.x / s.scale, 1.0f, 1e-6f) << label;
          EXPECT_EQ(bsdf.eval(wo, s.wi).f_cos, glm::vec3(0.0f)) << label;
          EXPECT_EQ(bsdf.eval(wo, s.wi).pdf, 0.0f) << label;
        }
      }
    }
  }
}

TEST(Dielectric, SmoothDirectionsObeySnellAndFresnel) {
  for (const float eta : {0.67f, 1.33f, 2.4f}) {
    for (const float degrees : {5.0f, 50.0f, 85.0f, 110.0f, 175.0f}) {
      const BsdfUnderTest bsdf = under_test(glass(eta, 0.0f));
      const glm::vec3 wo = view_direction(degrees);
      const float relative = wo.z > 0.0f ? eta : 1.0f / eta;
      const float fresnel = fresnel_dielectric(std::abs(wo.z), relative);
      const ScatterSample<float> reflected = bsdf.sample(wo, {0.3f, 0.7f, 0.999f * fresnel});
      EXPECT_EQ(reflected.wi, glm::vec3(-wo.x, -wo.y, wo.z)) << at_angle(bsdf, degrees);
      EXPECT_NEAR(reflected.pdf, fresnel, 1e-5f) << at_angle(bsdf, degrees);
      if (fresnel > 0.999f) continue;
      const ScatterSample<float> passed = bsdf.sample(wo, {0.3f, 0.7f, 0.9999f});
      EXPECT_LT(passed.wi.z * wo.z, 0.0f) << at_angle(bsdf, degrees);
      EXPECT_NEAR(passed.wi.x * relative, -wo.x, 1e-6f) << at_angle(bsdf, degrees);
      EXPECT_NEAR(passed.wi.y * relative, -wo.y, 1e-6f) << at_angle(bsdf, degrees);
      EXPECT_NEAR(length(passed.wi), 1.0f, 1e-6f) << at_angle(bsdf, degrees);
    }
  }
}

TEST(Dielectric, ReflectsAllBeyondTheCriticalAngle) {
  constexpr float eta = 1.5f;  // critical at 41.8 degrees inside
  for (const float alpha : {0.0f, 0.002f}) {
    const BsdfUnderTest bsdf = under_test(glass(eta, alpha));
    for (std::uint32_t i = 0; i < 256; ++i) {
      EXPECT_LT(bsdf.sample(view_direction(180.0f - 45.0f), uniform3(i, 1)).wi.z, 0.0f) << alpha;
    }
  }
  int passed = 0;
  const BsdfUnderTest smooth = under_test(glass(eta, 0.0f));
  for (std::uint32_t i = 0; i < 256; ++i) {
    passed += smooth.sample(view_direction(180.0f - 38.0f), uniform3(i, 1)).wi.z > 0.0f;
  }
  EXPECT_GT(passed, 128);
}

TEST(Dielectric, EqualIndicesLetLightPassStraight) {
  for (const float alpha : {0.0f, 0.5f}) {
    for (const bool thin : {false, true}) {
      if (thin && alpha > 0.0f) continue;  // a sheet's facets scatter what passes
      const BsdfUnderTest bsdf = under_test(glass(1.0f, alpha, thin));
      for (const float degrees : {0.0f, 60.0f, 89.99f, 90.01f, 150.0f}) {
        const glm::vec3 wo = view_direction(degrees);
        const ScatterSample<float> s = bsdf.sample(wo, {0.5f, 0.5f, 0.0f});
        EXPECT_EQ(s.wi, -wo) << at_angle(bsdf, degrees);
        EXPECT_EQ(s.weight, glm::vec3(1.0f)) << at_angle(bsdf, degrees);
        EXPECT_TRUE(s.delta) << at_angle(bsdf, degrees);
      }
    }
  }
}

// R + T^2 R / (1 - R^2), summed here bounce by bounce.
TEST(Dielectric, SheetReflectsAllOrders) {
  for (const float degrees : {0.0f, 60.0f, 85.0f, 120.0f}) {
    const glm::vec3 wo = view_direction(degrees);
    const double r = double(fresnel_dielectric(std::abs(wo.z), 1.5f));
    double sum = r, passing = (1.0 - r) * r * (1.0 - r);
    for (int bounce = 0; bounce < 200; ++bounce, passing *= r * r) sum += passing;
    const BsdfUnderTest sheet = under_test(glass(1.5f, 0.0f, true));
    EXPECT_NEAR(sheet.sample(wo, {0.1f, 0.1f, 0.0f}).pdf, sum, 1e-5) << degrees;
    const ScatterSample<float> passed = sheet.sample(wo, {0.1f, 0.1f, 0.9999f});
    EXPECT_EQ(passed.wi, -wo) << degrees;
    EXPECT_NEAR(passed.pdf, 1.0 - sum, 1e-5) << degrees;
  }
}

// f(a, b) n_b^2 = f(b, a) n_a^2, with n the index on the side of each direction.
TEST(Dielectric, IsReciprocal) {
  int crossing = 0;
  for (const Case& c : rough_cases()) {
    const BsdfUnderTest bsdf = under_test(c.bsdf);
    for (std::uint32_t i = 0; i < 1024; ++i) {
      const glm::vec3 a = uniform_sphere(uniform2(i, 1)), b = uniform_sphere(uniform2(i, 2));
      if (std::min(std::abs(a.z), std::abs(b.z)) < 1e-2f) continue;
      const auto index2 = [&](glm::vec3 w) {
        return w.z < 0.0f && !c.bsdf.thin ? c.bsdf.eta * c.bsdf.eta : 1.0f;
      };
      const glm::vec3 ab = bsdf.eval(a, b).f_cos * (index2(b) / std::abs(b.z));
      const glm::vec3 ba = bsdf.eval(b, a).f_cos * (index2(a) / std::abs(a.z));
      ASSERT_LT(max_component(abs(ab - ba)), 2e-3f * max_component(ab) + 1e-5f)
          << bsdf.name << " from " << a.z << " to " << b.z;
      crossing += a.z * b.z < 0.0f && ab.x > 1e-3f;
    }
  }
  EXPECT_GT(crossing, 1000);
}

// Single scattering: rough boundaries lose light between facets, ever more with alpha, and gain
// none. The loss at normal incidence is recorded here.
TEST(Dielectric, RoughWhiteFurnace) {
  for (const float eta : {0.67f, 1.33f, 1.5f, 2.4f}) {
    for (const float alpha : {0.01f, 0.1f, 0.3f, 0.6f, 1.0f}) {
      const BsdfUnderTest bsdf = under_test(glass(eta, alpha));
      for (const float degrees : {0.0f, 60.0f, 85.0f, 140.0f}) {
        const MeanWeight m = albedo(bsdf, view_direction(degrees), 5, 1 << 13);
        EXPECT_LE(m.value, 1.0 + 4.0 * m.sigma + 1e-5) << at_angle(bsdf, degrees);
        EXPECT_GE(m.value, alpha < 0.05f && degrees == 0.0f ? 0.999 : 0.3)
            << at_angle(bsdf, degrees);
      }
    }
  }
  const auto lost = [](float alpha) {
    return 1.0 - albedo(under_test(glass(1.5f, alpha)), view_direction(0.0f), 6).value;
  };
  EXPECT_NEAR(lost(0.1f), 0.001, 0.001);
  EXPECT_NEAR(lost(0.5f), 0.032, 0.003);
  EXPECT_NEAR(lost(1.0f), 0.107, 0.005);
}

TEST(Dielectric, IsFiniteAtGrazingAngles) {
  for (const float eta : {0.67f, 1.0f, 1.0015f, 1.5f, 2.4f}) {
    for (const float alpha : {0.0f, 1e-3f, 0.03f, 0.3f, 1.0f}) {
      for (const bool thin : {false, true}) {
        expect_finite_at_extremes(under_test(glass(eta, alpha, thin)), true);
      }
    }
  }
}

TEST(Dielectric, HasTheSameBitsAtEveryWidth) {
  const std::vector<MaterialRow> rows = {
      {1, 1, 1, 1, 1, 1, 0.0f, 0.0f, 1.5f, 0},        {1, 1, 1, 1, 1, 1, 0.1f, 0.1f, 1.5f, 0},
      {0.5f, 1, 1, 1, 0.2f, 1, 0.6f, 0.2f, 2.4f, 0},  {1, 1, 1, 1, 1, 1, 0.0f, 0.0f, 1.33f, 1},
      {1, 0.3f, 1, 0.9f, 1, 1, 0.3f, 0.3f, 0.67f, 1}, {1, 1, 1, 1, 1, 1, 0.3f, 0.3f, 1.0f, 0},
      {0, 0, 0, 0, 0, 0, 0.5f, 0.5f, 1.5f, 0}};
  for_each_width([&](auto width) {
    expect_same_bits<width()>(
        rows, true, [](const MaterialTable& t, auto index) { return load_dielectric(t, index); });
  });
}

}  // namespace
}  // namespace lockstep::test_bsdf_dielectric
