// Rough diffuse reflection, and diffuse light on both sides of a sheet.
#include "core/bsdf/diffuse_transmission.h"
#include "core/bsdf/oren_nayar.h"

#include "tests/bsdf_checks.h"

namespace lockstep::test_bsdf_diffuse {
namespace {

constexpr float view_angles[] = {0.0f, 30.0f, 60.0f, 85.0f};
const glm::vec3 orange(0.9f, 0.4f, 0.05f);

BsdfUnderTest rough(float sigma, glm::vec3 reflectance = orange) {
  return under_test("sigma " + std::to_string(int(sigma)), oren_nayar(reflectance, sigma));
}

TEST(OrenNayar, WithoutRoughnessIsLambert) {
  const BsdfUnderTest bsdf = rough(0.0f);
  for (std::uint32_t i = 0; i < 256; ++i) {
    const glm::vec3 wo = cosine_hemisphere(uniform2(i, 1)), wi = cosine_hemisphere(uniform2(i, 2));
    const BsdfValue<float> v = bsdf.eval(wo, wi),
                           lambert = eval_once(DiffuseBsdf<float>{orange}, wo, wi);
    EXPECT_EQ(v.f_cos, lambert.f_cos);
    EXPECT_EQ(v.pdf, lambert.pdf);
  }
}

// Against eq. 30 as printed, with angles.
TEST(OrenNayar, HasTheValueOfTheQualitativeModel) {
  for (const double sigma : {5.0, 20.0, 60.0}) {
    const double s2 = std::pow(sigma * double(pi) / 180.0, 2.0);
    const double a = 1.0 - 0.5 * s2 / (s2 + 0.33), b = 0.45 * s2 / (s2 + 0.09);
    for (std::uint32_t i = 0; i < 512; ++i) {
      const glm::vec3 wo = cosine_hemisphere(uniform2(i, 3));
      const glm::vec3 wi = cosine_hemisphere(uniform2(i, 4));
      const double theta_o = std::acos(double(wo.z)), theta_i = std::acos(double(wi.z));
      const double azimuth =
          std::atan2(double(wo.y), double(wo.x)) - std::atan2(double(wi.y), double(wi.x));
      const double f = a + b * std::max(0.0, std::cos(azimuth)) *
                               std::sin(std::max(theta_i, theta_o)) *
                               std::tan(std::min(theta_i, theta_o));
      const double got = double(rough(float(sigma)).eval(wo, wi).f_cos.x);
      EXPECT_NEAR(got, 0.9 / double(pi) * f * double(wi.z), 2e-5) << sigma;
    }
  }
}

TEST(OrenNayar, SamplesWeightsAndEnergyAgree) {
  const double significance = sidak_significance(2 * int(std::size(view_angles)));
  std::uint32_t seed = 10;
  for (const float sigma : {20.0f, 80.0f}) {
    for (const float degrees : view_angles) {
      const BsdfUnderTest bsdf = rough(sigma, glm::vec3(1.0f));
      const glm::vec3 wo = view_direction(degrees);
      const std::string label = at_angle(bsdf, degrees);
      const double mass = expect_samples_follow_density(
          bsdf, wo, Side::Both, DirectionMap(glm::dvec3(0, 0, 1)), significance, ++seed, label);
      EXPECT_NEAR(mass, 1.0, 1e-4) << label;
      expect_weights_match(bsdf, wo, 1e-5f, seed, label);
      const MeanWeight m = albedo(bsdf, wo, seed);
      EXPECT_LE(m.value, 1.0 + 4.0 * m.sigma) << label;
      EXPECT_GE(m.value, 0.5) << label;
    }
  }
}

TEST(OrenNayar, IsReciprocal) {
  const BsdfUnderTest bsdf = rough(35.0f);
  for (std::uint32_t i = 0; i < 512; ++i) {
    const glm::vec3 a = cosine_hemisphere(uniform2(i, 1)), b = cosine_hemisphere(uniform2(i, 2));
    if (std::min(a.z, b.z) < 1e-3f) continue;
    EXPECT_NEAR(bsdf.eval(a, b).f_cos.x / b.z, bsdf.eval(b, a).f_cos.x / a.z, 1e-5f);
  }
}

TEST(OrenNayar, IsFiniteAtGrazingAngles) {
  for (const float sigma : {0.0f, 20.0f, 1000.0f}) expect_finite_at_extremes(rough(sigma), false);
}

TEST(OrenNayar, HasTheSameBitsAtEveryWidth) {
  const std::vector<MaterialRow> rows = {{0.9f, 0.5f, 0.1f, 0}, {1, 1, 1, 20}, {0, 0.5f, 1, 90}};
  for_each_width([&](auto width) {
    expect_same_bits<width()>(
        rows, false, [](const MaterialTable& t, auto index) { return load_oren_nayar(t, index); });
  });
}

BsdfUnderTest sheet(glm::vec3 reflectance, glm::vec3 transmittance) {
  return under_test("sheet", DiffuseTransmissionBsdf<float>{reflectance, transmittance});
}

TEST(DiffuseTransmission, SamplesHaveTheDensityThatEvalGives) {
  const BsdfUnderTest bsdf = sheet(orange, {0.1f, 0.3f, 0.2f});
  std::uint32_t seed = 30;
  for (const float degrees : {0.0f, 70.0f, 100.0f, 180.0f}) {
    const glm::vec3 wo = view_direction(degrees);
    const double mass =
        expect_samples_follow_density(bsdf, wo, Side::Both, DirectionMap(glm::dvec3(0, 0, 1)),
                                      sidak_significance(4), ++seed, at_angle(bsdf, degrees));
    EXPECT_NEAR(mass, 1.0, 1e-4);
    expect_weights_match(bsdf, wo, 1e-5f, seed, at_angle(bsdf, degrees));
  }
}

// The share of white light that returns on each side is the colour of that side.
TEST(DiffuseTransmission, SplitsLightByItsColours) {
  const glm::vec3 passing(0.1f, 0.3f, 0.2f);
  const BsdfUnderTest bsdf = sheet(orange, passing);
  for (const float degrees : {20.0f, 150.0f}) {
    const glm::vec3 wo = view_direction(degrees);
    glm::dvec3 same(0.0), other(0.0);
    constexpr std::uint32_t samples = 1 << 15;
    for (std::uint32_t i = 0; i < samples; ++i) {
      const ScatterSample<float> s = bsdf.sample(wo, uniform3(i, 50));
      (s.wi.z * wo.z > 0.0f ? same : other) += glm::dvec3(s.weight) / double(samples);
    }
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(same[k], double(orange[k]), 0.01) << degrees;
      EXPECT_NEAR(other[k], double(passing[k]), 0.01) << degrees;
    }
  }
}

TEST(DiffuseTransmission, CarriesNothingWhereItsColoursAreBlack) {
  const glm::vec3 black(0.0f);
  for (std::uint32_t i = 0; i < 256; ++i) {
    const glm::vec3 wo = view_direction(i % 2 == 0 ? 40.0f : 140.0f), u = uniform3(i, 60);
    EXPECT_LT(sheet(black, orange).sample(wo, u).wi.z * wo.z, 0.0f);
    EXPECT_GT(sheet(orange, black).sample(wo, u).wi.z * wo.z, 0.0f);
    EXPECT_EQ(sheet(black, black).sample(wo, u).weight, black);
  }
  expect_finite_at_extremes(sheet(black, black), true);
  expect_finite_at_extremes(sheet(orange, orange), true);
}

TEST(DiffuseTransmission, HasTheSameBitsAtEveryWidth) {
  const std::vector<MaterialRow> rows = {
      {0.9f, 0.5f, 0.1f, 0.1f, 0.2f, 0.3f}, {1, 1, 1, 0, 0, 0}, {0, 0, 0, 0, 0, 0}};
  for_each_width([&](auto width) {
    expect_same_bits<width()>(rows, true, [](const MaterialTable& t, auto index) {
      return load_diffuse_transmission(t, index);
    });
  });
}

}  // namespace
}  // namespace lockstep::test_bsdf_diffuse
