// Fresnel reflectance against closed forms and against complex arithmetic in double.
#include "core/fresnel.h"

#include "tests/widths.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>

namespace lockstep::test_fresnel {
namespace {

// Snell's law and Fresnel's equations with a complex index n, as textbooks write them.
double reference(double cos_i, std::complex<double> n) {
  const std::complex<double> cos_t = std::sqrt(1.0 - (1.0 - cos_i * cos_i) / (n * n));
  const std::complex<double> s = (cos_i - n * cos_t) / (cos_i + n * cos_t);
  const std::complex<double> p = (n * cos_i - cos_t) / (n * cos_i + cos_t);
  return 0.5 * (std::norm(s) + std::norm(p));
}

constexpr float dielectrics[] = {1.01f, 1.1f, 1.33f, 1.5f, 2.4f, 4.0f, 0.9f, 0.6666667f};
struct Metal {
  float eta, k;
};
// Copper, gold, silver, aluminium, chromium in some channels, and unphysical corners.
constexpr Metal metals[] = {{0.2f, 3.9f},  {1.1f, 2.14f}, {0.143f, 3.98f}, {1.374f, 1.77f},
                            {0.05f, 4.3f}, {1.45f, 7.5f}, {3.18f, 3.3f},   {0.05f, 9.0f},
                            {5.0f, 0.01f}, {1.5f, 1e-4f}, {0.5f, 0.5f},    {10.0f, 10.0f}};

TEST(FresnelDielectric, AgreesWithComplexArithmetic) {
  for (const float eta : dielectrics) {
    for (int i = 0; i <= 1000; ++i) {
      const float cos_i = float(i) / 1000.0f;
      const float r = fresnel_dielectric(cos_i, eta);
      EXPECT_NEAR(r, reference(double(cos_i), double(eta)), 2e-5) << eta << " at cos " << cos_i;
      EXPECT_GE(r, 0.0f);
      EXPECT_LE(r, 1.0f + 1e-6f);
    }
  }
}

TEST(FresnelDielectric, ClosedForms) {
  for (const float eta : dielectrics) {
    const double r0 = std::pow((double(eta) - 1.0) / (double(eta) + 1.0), 2.0);
    EXPECT_NEAR(fresnel_dielectric(1.0f, eta), r0, 1e-7);
    EXPECT_NEAR(fresnel_dielectric(0.0f, eta), 1.0, 1e-6);
    EXPECT_GT(fresnel_dielectric(1e-4f, eta), 0.9f);
    // At Brewster's angle nothing of the parallel polarisation is reflected.
    const double cos_b = 1.0 / std::sqrt(1.0 + double(eta) * double(eta));
    const double cos_t = double(eta) * cos_b;
    const double s = (cos_b - double(eta) * cos_t) / (cos_b + double(eta) * cos_t);
    EXPECT_NEAR(fresnel_dielectric(float(cos_b), eta), 0.5 * s * s, 1e-6);
  }
  EXPECT_NEAR(fresnel_dielectric(1.0f, 1.5f), 0.04f, 1e-7f);
}

TEST(FresnelDielectric, NoInterfaceReflectsNothing) {
  for (const float cos_i : {1.0f, 0.7f, 0.1f}) {
    EXPECT_NEAR(fresnel_dielectric(cos_i, 1.0f), 0.0f, 1e-12f);
  }
}

TEST(FresnelDielectric, ReflectsTotallyFromTheDenseSide) {
  const double critical = std::sqrt(1.0 - 1.0 / (1.5 * 1.5));
  EXPECT_EQ(fresnel_dielectric(float(critical) - 1e-3f, 1.0f / 1.5f), 1.0f);
  EXPECT_LT(fresnel_dielectric(float(critical) + 1e-3f, 1.0f / 1.5f), 1.0f);
}

TEST(FresnelConductor, AgreesWithComplexArithmetic) {
  for (const Metal m : metals) {
    for (int i = 0; i <= 1000; ++i) {
      const float cos_i = float(i) / 1000.0f;
      const float r = fresnel_conductor(cos_i, m.eta, m.k);
      EXPECT_NEAR(r, reference(double(cos_i), {double(m.eta), double(m.k)}), 1e-5)
          << m.eta << " + " << m.k << " i at cos " << cos_i;
      EXPECT_GE(r, 0.0f);
      EXPECT_LE(r, 1.0f + 1e-6f);
    }
  }
}

TEST(FresnelConductor, ClosedForms) {
  for (const Metal m : metals) {
    const double eta = double(m.eta), k2 = double(m.k) * double(m.k);
    const double r0 = ((eta - 1.0) * (eta - 1.0) + k2) / ((eta + 1.0) * (eta + 1.0) + k2);
    EXPECT_NEAR(fresnel_conductor(1.0f, m.eta, m.k), r0, 2e-6);
    EXPECT_NEAR(fresnel_conductor(0.0f, m.eta, m.k), 1.0, 1e-6);
  }
  // Aluminium at 550 nm, normal incidence: 92 %.
  EXPECT_NEAR(fresnel_conductor(1.0f, 0.958f, 6.69f), 0.921f, 2e-3f);
}

TEST(FresnelConductor, WithoutAbsorptionIsADielectric) {
  for (const float eta : dielectrics) {
    if (eta < 1.0f) continue;
    for (int i = 1; i <= 1000; ++i) {
      const float cos_i = float(i) / 1000.0f;
      EXPECT_NEAR(fresnel_conductor(cos_i, eta, 0.0f), fresnel_dielectric(cos_i, eta), 2e-5);
    }
  }
}

TEST(Fresnel, HasTheSameBitsAtEveryWidth) {
  for_each_width([](auto width) {
    constexpr int W = width();
    using V = Float<W>;
    for (std::uint32_t i = 0; i < 4096; i += W) {
      float cos_i[W], eta[W], k[W];
      for (int l = 0; l < W; ++l) {
        const glm::vec3 u = uniform3(i + std::uint32_t(l), 1);
        cos_i[l] = u.x, eta[l] = 0.1f + 3.0f * u.y, k[l] = 5.0f * u.z;
      }
      cos_i[0] = 0.0f;
      const V dielectric = fresnel_dielectric(load<V>(cos_i), load<V>(eta));
      const V conductor = fresnel_conductor(load<V>(cos_i), load<V>(eta), load<V>(k));
      for (int l = 0; l < W; ++l) {
        ASSERT_TRUE(same_value(dielectric[l], fresnel_dielectric(cos_i[l], eta[l])));
        ASSERT_TRUE(same_value(conductor[l], fresnel_conductor(cos_i[l], eta[l], k[l])));
      }
    }
  });
}

}  // namespace
}  // namespace lockstep::test_fresnel
