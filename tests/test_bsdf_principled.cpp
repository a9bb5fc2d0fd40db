// glTF's metallic-roughness model with transmission and coat.
#include "core/bsdf/principled.h"

#include "core/ggx_albedo.h"
#include "tests/bsdf_checks.h"

namespace lockstep::test_bsdf_principled {
namespace {

const glm::vec3 white(1.0f), gold(1.0f, 0.78f, 0.34f), blue(0.1f, 0.2f, 0.8f);

struct Case {
  std::string name;
  PrincipledBsdf<float> bsdf;
  bool sharp = false;  // the metal or dielectric facets are too narrow for a map around the normal
};

PrincipledBsdf<float> plastic(glm::vec3 color, float alpha) {
  return {color, 0.0f, alpha, 1.5f, 1.0f, 0.0f, 0.0f, 0.1f, false};
}
PrincipledBsdf<float> metal(glm::vec3 color, float alpha) {
  PrincipledBsdf<float> b = plastic(color, alpha);
  b.metallic = 1.0f;
  return b;
}
PrincipledBsdf<float> transparent(glm::vec3 color, float alpha, float eta, bool thin) {
  PrincipledBsdf<float> b = plastic(color, alpha);
  b.transmission = 1.0f, b.eta = eta, b.thin = thin;
  return b;
}
PrincipledBsdf<float> coated(PrincipledBsdf<float> b, float coat, float alpha) {
  b.coat = coat, b.coat_alpha = alpha;
  return b;
}
// A bit of everything.
PrincipledBsdf<float> mixed(float alpha, bool thin) {
  PrincipledBsdf<float> b = coated(plastic(blue, alpha), 0.6f, 0.3f);
  b.metallic = 0.3f, b.transmission = 0.5f, b.specular = 0.8f, b.eta = 1.7f, b.thin = thin;
  return b;
}

std::vector<Case> cases() {
  PrincipledBsdf<float> dull = plastic(white, 0.3f);
  dull.specular = 0.0f;
  return {{"plastic .3", plastic(blue, 0.3f)},
          {"plastic .05", plastic(white, 0.05f), true},
          {"dull plastic", dull},
          {"gold .5", metal(gold, 0.5f)},
          {"black metal .4", metal(glm::vec3(0.0f), 0.4f)},
          {"glass .3", transparent(white, 0.3f, 1.5f, false)},
          {"dense glass .05", transparent(blue, 0.05f, 2.4f, false), true},
          {"sheet .4", transparent(blue, 0.4f, 1.5f, true)},
          {"coated gold", coated(metal(gold, 0.6f), 1.0f, 0.25f)},
          {"coated glass", coated(transparent(white, 0.4f, 1.33f, false), 1.0f, 0.3f)},
          {"mixed .5", mixed(0.5f, false)},
          {"mixed sheet .3", mixed(0.3f, true)}};
}
constexpr float view_angles[] = {0.0f, 50.0f, 85.0f, 130.0f};

template <class F>
void for_each_case(F f) {
  std::uint32_t seed = 100;
  for (const Case& c : cases()) {
    const BsdfUnderTest bsdf = under_test(c.name, c.bsdf);
    for (const float degrees : view_angles) {
      f(c, bsdf, view_direction(degrees), at_angle(bsdf, degrees), ++seed);
    }
  }
}

TEST(Principled, SamplesHaveTheDensityThatEvalGives) {
  const double significance = sidak_significance(2 * int(cases().size() * std::size(view_angles)));
  for_each_case([&](const Case& c, const BsdfUnderTest& bsdf, glm::vec3 wo,
                    const std::string& label, std::uint32_t seed) {
    double mass = 0.0;
    for (const Side side : {Side::Same, Side::Other}) {
      if (side == Side::Other && c.bsdf.transmission == 0.0f) continue;
      glm::dvec3 axis(0.0, 0.0, 1.0);
      if (c.sharp) {
        // Around the mirrored direction, or the refracted one (about: it is a wide map).
        const float eta = wo.z > 0.0f ? c.bsdf.eta : 1.0f / c.bsdf.eta;
        const glm::vec3 through(-wo.x / eta, -wo.y / eta, -wo.z);
        axis = side == Side::Same ? glm::dvec3(-wo.x, -wo.y, wo.z) : glm::dvec3(through);
      }
      mass += expect_samples_follow_density(bsdf, wo, side, DirectionMap(axis, c.sharp ? 2.0 : 1.0),
                                            significance, seed, label);
    }
    EXPECT_LE(mass, 1.0 + 1e-3) << label;
  });
}

TEST(Principled, WeightIsValueOverDensity) {
  for_each_case([](const Case&, const BsdfUnderTest& bsdf, glm::vec3 wo, const std::string& label,
                   std::uint32_t seed) { expect_weights_match(bsdf, wo, 1e-4f, seed, label); });
}

// The chance of a lobe fits what it reflects: no sample carries far more than it should.
TEST(Principled, WeightsAreBounded) {
  for_each_case([](const Case&, const BsdfUnderTest& bsdf, glm::vec3 wo, const std::string& label,
                   std::uint32_t seed) {
    float largest = 0.0f;
    for (std::uint32_t i = 0; i < 4096; ++i) {
      const ScatterSample<float> s = bsdf.sample(wo, uniform3(i, seed));
      if (s.pdf > 0.0f) largest = std::max(largest, max_component(s.weight) / s.scale);
    }
    EXPECT_LT(largest, 4.0f) << label;
  });
}

TEST(Principled, IsReciprocal) {
  for (const Case& c : cases()) {
    const BsdfUnderTest bsdf = under_test(c.name, c.bsdf);
    const bool refracts = c.bsdf.transmission > 0.0f && !c.bsdf.thin;
    for (std::uint32_t i = 0; i < 1024; ++i) {
      const glm::vec3 a = uniform_sphere(uniform2(i, 1)), b = uniform_sphere(uniform2(i, 2));
      if (std::min(std::abs(a.z), std::abs(b.z)) < 1e-2f) continue;
      const auto index2 = [&](glm::vec3 w) {
        return w.z < 0.0f && refracts ? c.bsdf.eta * c.bsdf.eta : 1.0f;
      };
      const glm::vec3 ab = bsdf.eval(a, b).f_cos * (index2(b) / std::abs(b.z));
      const glm::vec3 ba = bsdf.eval(b, a).f_cos * (index2(a) / std::abs(a.z));
      ASSERT_LT(max_component(abs(ab - ba)), 2e-3f * max_component(ab) + 2e-5f)
          << c.name << " from " << a.z << " to " << b.z;
    }
  }
}

TEST(Principled, ReturnsNoMoreThanItReceives) {
  for (const float alpha : {0.02f, 0.3f, 1.0f}) {
    for (const float coat : {0.0f, 1.0f}) {
      for (const float coat_alpha : {0.02f, 0.5f}) {
        PrincipledBsdf<float> half = plastic(white, alpha);
        half.metallic = half.transmission = 0.5f;
        for (const auto& base :
             {plastic(white, alpha), metal(white, alpha), transparent(white, alpha, 1.5f, false),
              transparent(white, alpha, 1.5f, true), half}) {
          const BsdfUnderTest bsdf = under_test("white", coated(base, coat, coat_alpha));
          for (const float degrees : view_angles) {
            const MeanWeight m = albedo(bsdf, view_direction(degrees), 11, 1 << 12);
            EXPECT_LE(m.value, 1.0 + 4.0 * m.sigma + 2e-3)
                << degrees << ", alpha " << alpha << ", coat " << coat << " " << coat_alpha
                << ", metallic " << base.metallic << ", transmission " << base.transmission;
          }
        }
      }
    }
  }
}

// White and nearly smooth: all that arrives returns, from whichever layer. (A coat takes a little
// more than it gives, by the more grazing of two directions that differ.)
TEST(Principled, WhiteFurnaceWhereSmooth) {
  for (const auto& b :
       {plastic(white, 0.01f), metal(white, 0.01f), transparent(white, 0.01f, 1.5f, false),
        transparent(white, 0.01f, 1.5f, true), coated(metal(white, 0.01f), 1.0f, 0.01f)}) {
    for (const float degrees : {0.0f, 45.0f, 65.0f}) {
      const MeanWeight m = albedo(under_test("white", b), view_direction(degrees), 12);
      EXPECT_NEAR(m.value, 1.0, (b.coat > 0.0f ? 8e-3 : 2e-3) + 4.0 * m.sigma)
          << degrees << ", metallic " << b.metallic << ", transmission " << b.transmission;
    }
  }
}

TEST(Principled, WithoutMetalOrCoatItsGlassIsTheDielectric) {
  const PrincipledBsdf<float> b = transparent(white, 0.3f, 1.5f, false);
  const DielectricBsdf<float> glass{white, white, {{0.3f, 0.3f}}, 1.5f, false};
  for (std::uint32_t i = 0; i < 1024; ++i) {
    const glm::vec3 wo = uniform_sphere(uniform2(i, 1)), wi = uniform_sphere(uniform2(i, 2));
    const BsdfValue<float> v = eval_once(b, wo, wi), w = eval_once(glass, wo, wi);
    EXPECT_NEAR(v.f_cos.x, w.f_cos.x, 1e-4f * w.f_cos.x + 1e-6f) << i;
    EXPECT_NEAR(v.pdf, w.pdf, 1e-4f * w.pdf + 1e-6f) << i;
  }
}

TEST(Principled, MetalIsSchlicksConductor) {
  const float alpha = 0.4f;
  const Ggx<float> ggx{{alpha, alpha}};
  for (std::uint32_t i = 0; i < 512; ++i) {
    const glm::vec3 wo = cosine_hemisphere(uniform2(i, 1)), wi = cosine_hemisphere(uniform2(i, 2));
    const glm::vec3 m = glm::normalize(wo + wi);
    const glm::vec3 f = gold + (white - gold) * std::pow(1.0f - glm::dot(wo, m), 5.0f);
    const glm::vec3 expected = f * (ggx.d(m) * ggx.g2(wo, wi) / (4.0f * wo.z));
    const glm::vec3 got = eval_once(metal(gold, alpha), wo, wi).f_cos;
    EXPECT_LT(max_component(abs(got - expected)), 1e-4f * max_component(expected) + 1e-6f) << i;
  }
}

TEST(Principled, OpaqueSurfacesLookTheSameFromBehind) {
  const PrincipledBsdf<float> b = coated(plastic(blue, 0.3f), 0.5f, 0.2f);
  for (std::uint32_t i = 0; i < 256; ++i) {
    const glm::vec3 wo = cosine_hemisphere(uniform2(i, 1)), wi = uniform_sphere(uniform2(i, 2));
    const glm::vec3 turned(1.0f, 1.0f, -1.0f);
    EXPECT_EQ(eval_once(b, wo, wi).f_cos, eval_once(b, wo * turned, wi * turned).f_cos);
    if (wi.z > 0.0f) continue;
    EXPECT_EQ(eval_once(b, wo, wi).f_cos, glm::vec3(0.0f));
  }
}

// The fit against the integral that it stands for.
TEST(Principled, MeanReflectanceIsThatOfFresnelsFormula) {
  const auto mean = [](float eta) {
    double sum = 0.0;
    constexpr int steps = 20000;
    for (int i = 0; i < steps; ++i) {
      const float c = (float(i) + 0.5f) / steps;
      sum += 2.0 * double(c * cross_boundary(c, eta).reflectance) / steps;
    }
    return sum;
  };
  for (const float eta : {1.02f, 1.2f, 1.33f, 1.5f, 2.0f, 3.0f}) {
    EXPECT_NEAR(double(mean_reflectance(eta)), mean(eta), 5e-4) << eta;
    EXPECT_NEAR(double(mean_reflectance(1.0f / eta)), mean(1.0f / eta), 1e-3) << eta;
  }
}

TEST(Principled, CompensationReturnsWhatRoughMetalLoses) {
  const std::vector<float> table = make_ggx_albedo();
  for (const float alpha : {0.3f, 1.0f}) {
    for (const float degrees : {0.0f, 60.0f}) {
      const glm::vec3 wo = view_direction(degrees);
      PrincipledBsdf<float> b = metal(white, alpha);
      b.lost = ggx_loss(table.data(), wo.z, {alpha, alpha});
      const MeanWeight m = albedo(under_test("metal", b), wo, 13);
      EXPECT_NEAR(m.value, 1.0, 0.01 + 4.0 * m.sigma) << alpha << " at " << degrees;
    }
  }
}

TEST(Principled, IsFiniteAtGrazingAngles) {
  for (const float alpha : {0.0f, 1e-3f, 0.03f, 1.0f}) {
    for (const float eta : {1.0f, 1.5f, 2.4f}) {
      for (const bool thin : {false, true}) {
        PrincipledBsdf<float> b = mixed(alpha, thin);
        b.eta = eta;
        expect_finite_at_extremes(under_test("mixed", b), true);
        expect_finite_at_extremes(under_test("glass", transparent(white, alpha, eta, thin)), true);
        b = coated(metal(gold, alpha), 1.0f, 0.0f);
        b.lost = 2.0f;
        expect_finite_at_extremes(under_test("coated", b), true);
      }
    }
  }
}

TEST(Principled, HasTheSameBitsAtEveryWidth) {
  const std::vector<MaterialRow> rows = {
      {0.1f, 0.2f, 0.8f, 0, 0.3f, 1.5f, 1, 0, 0, 0.1f, 0},
      {1, 0.8f, 0.3f, 1, 0.1f, 1.5f, 1, 0, 0, 0.1f, 0},
      {1, 1, 1, 0, 0.2f, 1.5f, 1, 1, 0, 0.1f, 0},
      {1, 1, 1, 0, 0.2f, 1.5f, 0.5f, 1, 0, 0.1f, 1},
      {0.5f, 0.5f, 0.5f, 0.3f, 0.5f, 1.7f, 0.8f, 0.5f, 0.6f, 0.02f, 0},
      {0, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0}};
  for_each_width([&](auto width) {
    expect_same_bits<width()>(rows, true, [](const MaterialTable& t, auto index) {
      auto bsdf = load_principled(t, index);
      using V = decltype(bsdf.lost);
      bsdf.lost = select(bsdf.metallic > V(0.2f), V(0.4f), V(0.0f));
      return bsdf;
    });
  });
}

}  // namespace
}  // namespace lockstep::test_bsdf_principled
