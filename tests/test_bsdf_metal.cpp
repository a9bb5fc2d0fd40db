// Metal from mirror to rough: delta lanes, what single scattering loses, and its compensation.
#include "core/bsdf/metal.h"
#include "core/ggx_albedo.h"

#include "tests/bsdf_checks.h"

#include <iomanip>
#include <sstream>

namespace lockstep::test_bsdf_metal {
namespace {

constexpr float view_angles[] = {0.0f, 30.0f, 60.0f, 85.0f};

const std::vector<float>& albedo_table() {
  static const std::vector<float> table = make_ggx_albedo();
  return table;
}

// Copper, but for the third channel, which reflects everything.
MetalBsdf<float> copper(float alpha_x, float alpha_y) {
  return {{{0.2f, 0.92f, 0.0f}, {3.9f, 2.45f, 50.0f}, {{alpha_x, alpha_y}}}, glm::vec3(1.0f), 0.0f};
}

// Reflects everything in all channels.
MetalBsdf<float> white(float alpha) {
  return {{glm::vec3(0.0f), glm::vec3(50.0f), {{alpha, alpha}}}, glm::vec3(1.0f), 0.0f};
}

BsdfUnderTest under_test(const MetalBsdf<float>& b) {
  const Vec2<float> alpha = b.conductor.ggx.alpha;
  return under_test("alpha " + std::to_string(alpha.x) + " " + std::to_string(alpha.y), b);
}

MetalBsdf<float> compensated(MetalBsdf<float> b, float cos_o) {
  b.lost = ggx_loss(albedo_table().data(), cos_o, b.conductor.ggx.alpha);
  return b;
}

// What rough lanes were before they could be mirrors, they stay.
TEST(Metal, RoughLanesAreTheRoughConductor) {
  for (const float alpha : {1e-3f, 0.1f, 1.0f}) {
    const MetalBsdf<float> metal = copper(alpha, 0.3f);
    for (std::uint32_t i = 0; i < 512; ++i) {
      const glm::vec3 wo = cosine_hemisphere(uniform2(i, 1)), u = uniform3(i, 3);
      const glm::vec3 wi = cosine_hemisphere(uniform2(i, 2));
      const BsdfValue<float> v = eval_once(metal, wo, wi), w = eval_once(metal.conductor, wo, wi);
      const ScatterSample<float> s = sample_once(metal, wo, u.z, Vec2<float>(u.x, u.y));
      const BsdfSample<float> t = sample_once(metal.conductor, wo, u.z, Vec2<float>(u.x, u.y));
      EXPECT_TRUE(same_value(v.f_cos, w.f_cos) && same_value(v.pdf, w.pdf)) << alpha;
      EXPECT_TRUE(same_value(s.wi, t.wi) && same_value(s.pdf, t.pdf)) << alpha;
      EXPECT_TRUE(same_value(s.weight, t.weight)) << alpha;
      EXPECT_FALSE(s.delta) << alpha;
    }
  }
}

TEST(Metal, SmoothLanesAreMirrors) {
  MetalBsdf<float> metal = copper(0.0f, 9e-4f);
  metal.specular = {1.0f, 0.5f, 0.25f};
  for (const float degrees : view_angles) {
    const glm::vec3 wo = view_direction(degrees), u = uniform3(1, 2);
    const ScatterSample<float> s = sample_once(metal, wo, u.z, Vec2<float>(u.x, u.y));
    EXPECT_TRUE(s.delta);
    EXPECT_EQ(s.wi, glm::vec3(-wo.x, -wo.y, wo.z));
    EXPECT_EQ(s.weight, fresnel(metal.conductor, wo.z) * metal.specular);
    EXPECT_EQ(s.pdf, 1.0f);
    EXPECT_EQ(eval_once(metal, wo, s.wi).f_cos, glm::vec3(0.0f));
    EXPECT_EQ(eval_once(metal, wo, s.wi).pdf, 0.0f);
  }
}

// Sharp lobes tend to the mirror: no step in brightness where a lane becomes one.
TEST(Metal, SmoothIsTheLimitOfRough) {
  for (const float degrees : {0.0f, 60.0f}) {
    const glm::vec3 wo = view_direction(degrees);
    const double mirror = albedo(under_test(copper(0.0f, 0.0f)), wo, 1, 64).value;
    EXPECT_NEAR(albedo(under_test(copper(1.1e-3f, 1.1e-3f)), wo, 1).value, mirror, 1e-3);
  }
}

// E(cos, alpha) of a white metal at single scattering, by another way than the table's: cubature of
// eval() over directions instead of sampled normals. Where the normal is the view, alpha = 1 has
// the closed form 1 - ln 2.
double cubature(const BsdfUnderTest& bsdf, glm::vec3 wo) {
  const DirectionMap map(glm::dvec3(0.0, 0.0, 1.0));
  const auto value = [&](glm::dvec2 p) {
    const glm::vec3 wi(map.to_direction(p));
    return wi.z > 0.0f ? double(bsdf.eval(wo, wi).f_cos.z) * map.solid_angle_per_area(p) : 0.0;
  };
  double sum = 0.0;
  for (int i = 0; i < 16; ++i) {
    for (int j = 0; j < 16; ++j) {
      sum += integrate(value, {0.5 * i / 16.0, j / 16.0}, {0.5 * (i + 1) / 16.0, (j + 1) / 16.0},
                       1e-6);
    }
  }
  return sum;
}

TEST(GgxAlbedo, TableHoldsWhatSingleScatteringReflects) {
  EXPECT_EQ(albedo_table().size(), 4u * ggx_albedo_cells * ggx_albedo_cells);
  EXPECT_NEAR(ggx_albedo(albedo_table().data(), 1.0f, 1.0f), 1.0f - std::log(2.0f), 2e-3f);
  for (const float alpha : {0.1f, 0.25f, 0.5f, 0.75f, 1.0f}) {
    for (const float cos_o : {0.05f, 0.2f, 0.5f, 0.8f, 1.0f}) {
      const glm::vec3 wo(std::sqrt(1.0f - cos_o * cos_o), 0.0f, cos_o);
      const double expected = cubature(under_test(white(alpha)), wo);
      EXPECT_NEAR(double(ggx_albedo(albedo_table().data(), cos_o, alpha)), expected, 5e-3)
          << "cos " << cos_o << ", alpha " << alpha;
    }
  }
}

// The table in the literature's terms: the share of diffuse light that a white metal loses.
TEST(GgxAlbedo, LossGrowsToMoreThanHalf) {
  const auto mean_loss = [](float alpha) {
    double sum = 0.0;
    constexpr int steps = 64;
    for (int i = 0; i < steps; ++i) {
      const float cos_o = (float(i) + 0.5f) / steps;
      sum += 2.0 * double(cos_o * (1.0f - ggx_albedo(albedo_table().data(), cos_o, alpha))) / steps;
    }
    return sum;
  };
  std::ostringstream table;
  table << "share of diffuse light lost by alpha:" << std::fixed << std::setprecision(3);
  double last = 0.0;
  for (const float alpha : {0.1f, 0.2f, 0.3f, 0.4f, 0.5f, 0.6f, 0.7f, 0.8f, 0.9f, 1.0f}) {
    const double loss = mean_loss(alpha);
    EXPECT_GT(loss, last) << alpha;
    last = loss;
    table << "  " << alpha << ": " << loss;
  }
  RecordProperty("loss", table.str());
  EXPECT_NEAR(mean_loss(0.1f), 0.028, 0.003) << table.str();
  EXPECT_NEAR(mean_loss(0.5f), 0.300, 0.003) << table.str();
  EXPECT_NEAR(mean_loss(1.0f), 0.591, 0.003) << table.str();
}

TEST(GgxAlbedo, CompensatedWhiteMetalReturnsEverything) {
  for (const float alpha : {0.05f, 0.3f, 0.6f, 1.0f}) {
    for (const float degrees : view_angles) {
      const glm::vec3 wo = view_direction(degrees);
      const MeanWeight m = albedo(under_test(compensated(white(alpha), wo.z)), wo, 7);
      EXPECT_NEAR(m.value, 1.0, 0.01 + 4.0 * m.sigma) << alpha << " at " << degrees;
    }
  }
}

TEST(GgxAlbedo, CompensationGainsNothingAndKeepsMirrors) {
  for (const float alpha : {0.1f, 0.5f, 1.0f}) {
    for (const float degrees : view_angles) {
      const glm::vec3 wo = view_direction(degrees);
      const MetalBsdf<float> plain = copper(alpha, alpha);
      const double before = albedo(under_test(plain), wo, 8).value;
      const MeanWeight after = albedo(under_test(compensated(plain, wo.z)), wo, 8);
      EXPECT_GE(after.value, before) << alpha << " at " << degrees;
      EXPECT_LE(after.value, 1.005 + 4.0 * after.sigma) << alpha << " at " << degrees;
      expect_weights_match(under_test(compensated(plain, wo.z)), wo, 2e-3f, 9,
                           "alpha " + std::to_string(alpha));
    }
  }
  MetalBsdf<float> mirror = white(0.0f);
  mirror.lost = 1.0f;
  EXPECT_EQ(albedo(under_test(mirror), view_direction(30.0f), 1, 64).value,
            albedo(under_test(white(0.0f)), view_direction(30.0f), 1, 64).value);
}

TEST(GgxAlbedo, LookupHasTheSameBitsAtEveryWidth) {
  const float* table = albedo_table().data();
  for_each_width([&](auto width) {
    constexpr int W = width();
    using V = Float<W>;
    for (std::uint32_t first = 0; first < 1024; first += W) {
      float cos_o[W], alpha[W];
      for (int k = 0; k < W; ++k) {
        const Vec2<float> u = uniform2(first + std::uint32_t(k), 4);
        cos_o[k] = 1.2f * u.x - 0.1f, alpha[k] = 1.2f * u.y;  // some out of range
      }
      const V loss = ggx_loss(table, load<V>(cos_o), Vec2<V>(load<V>(alpha), V(0.5f)));
      for (int k = 0; k < W; ++k) {
        const float one = ggx_loss(table, cos_o[k], Vec2<float>(alpha[k], 0.5f));
        ASSERT_TRUE(same_value(loss[k], one)) << W;
        ASSERT_GE(one, 0.0f);
      }
    }
  });
}

TEST(Metal, IsFiniteAtGrazingAngles) {
  for (const float alpha : {0.0f, 1e-3f, 0.03f, 0.3f, 1.0f}) {
    expect_finite_at_extremes(under_test(copper(alpha, alpha)), false);
    expect_finite_at_extremes(under_test(compensated(copper(alpha, alpha), 1e-4f)), false);
  }
}

TEST(Metal, HasTheSameBitsAtEveryWidth) {
  const auto row = [](float alpha_x, float alpha_y) {
    return MaterialRow{0.2f, 0.92f, 1.1f, 3.9f, 2.45f, 2.1f, alpha_x, alpha_y, 1.0f, 0.9f, 0.8f};
  };
  const std::vector<MaterialRow> rows = {row(0, 0), row(5e-4f, 0.1f), row(0.3f, 0.3f),
                                         row(1, 0.2f)};
  for (const float lost : {0.0f, 0.7f}) {
    for_each_width([&](auto width) {
      expect_same_bits<width()>(rows, false, [lost](const MaterialTable& t, auto index) {
        auto bsdf = load_metal(t, index);
        using V = decltype(bsdf.lost);
        // Some lanes with and some without.
        bsdf.lost = select(bsdf.conductor.ggx.alpha.y > V(0.25f), V(lost), V(0.0f));
        return bsdf;
      });
    });
  }
}

}  // namespace
}  // namespace lockstep::test_bsdf_metal
