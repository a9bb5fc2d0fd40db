// What rough boundaries and coats lose between their facets, put back: a furnace from both sides.
#include "core/boundary_albedo.h"
#include "core/bsdf/coated.h"
#include "core/bsdf/dielectric.h"
#include "core/bsdf/principled.h"
#include "core/fresnel.h"

#include "tests/bsdf_checks.h"

namespace lockstep::test_boundary_albedo {
namespace {

constexpr float indices[] = {1.1f, 1.33f, 1.5f, 2.5f};
constexpr float alphas[] = {0.05f, 0.12f, 0.3f, 0.6f, 1.0f};
constexpr float cosines[] = {0.05f, 0.1f, 0.3f, 0.5f, 0.65f, 0.8f, 1.0f};

const float* tables() {
  static const std::vector<float> values =
      make_boundary_albedo({std::begin(indices), std::end(indices)});
  return values.data();
}
const std::vector<float>& metal_table() {
  static const std::vector<float> table = make_ggx_albedo();
  return table;
}

glm::vec3 seen_under(float cos_o) { return {std::sqrt(1.0f - cos_o * cos_o), 0.0f, cos_o}; }

// Share of the light from everywhere that returns to wo, over a lattice instead of random samples:
// its error is below 2e-3 here.
template <class Bsdf>
double returned(const Bsdf& bsdf, glm::vec3 wo) {
  constexpr int samples = 1 << 15;
  const auto fraction = [](double x) {
    return std::min(float(x - std::floor(x)), one_minus_epsilon);
  };
  double sum = 0.0;
  for (int i = 0; i < samples; ++i) {
    const Vec2<float> u((float(i) + 0.5f) / samples, fraction(i * 0.6180339887498949));
    const auto s = sample_once(bsdf, wo, fraction(i * 0.7548776662466927), u);
    if (s.pdf > 0.0f) sum += double(s.weight.x / radiance_scale(s));
  }
  return sum / samples;
}

DielectricBsdf<float> glass(int table, float alpha) {
  return {glm::vec3(1.0f), glm::vec3(1.0f), {{alpha, alpha}}, indices[table], false};
}
DielectricBsdf<float> compensated(DielectricBsdf<float> b, int table, float cos_o) {
  b.lost = boundary_loss(tables(), table, cos_o < 0.0f, std::abs(cos_o), b.ggx.alpha.x);
  return b;
}

CoatedBsdf<float> coat(int table, float alpha) {
  const float eta = indices[table];
  return {glm::vec3(1.0f),
          glm::vec3(1.0f),
          {{alpha, alpha}},
          eta,
          1.0f,
          inner_reflectance(eta),
          0.0f,
          0.0f};
}
CoatedBsdf<float> compensated(CoatedBsdf<float> b, int table, float cos_o) {
  b.boundary_albedo = tables();
  b.table = table;
  b.lost = boundary_loss(tables(), table, false, cos_o, b.ggx.alpha.x);
  b.inner_reflectance += boundary_inner_difference(tables(), table, b.ggx.alpha.x);
  return b;
}

std::string label(int table, float alpha, float cos_o) {
  return "eta " + std::to_string(indices[table]) + ", alpha " + std::to_string(alpha) + ", cos " +
         std::to_string(cos_o);
}

template <class F>
void for_each_case(const F& f) {
  for (int table = 0; table < int(std::size(indices)); ++table) {
    for (const float alpha : alphas) {
      for (const float cos_o : cosines) f(table, alpha, cos_o);
    }
  }
}

TEST(BoundaryAlbedo, CompensatedGlassReturnsEverythingOnBothSides) {
  double most_lost = 0.0;
  for_each_case([&](int table, float alpha, float cosine) {
    for (const float cos_o : {cosine, -cosine}) {
      const glm::vec3 wo = seen_under(cos_o);
      const DielectricBsdf<float> b = glass(table, alpha);
      if (alpha == 1.0f) most_lost = std::max(most_lost, 1.0 - returned(b, wo));
      EXPECT_NEAR(returned(compensated(b, table, cos_o), wo), 1.0, 5e-3)
          << label(table, alpha, cos_o);
    }
  });
  EXPECT_GT(most_lost, 0.6) << "without compensation";
}

// Facets of a sheet mirror what passes, and lose as a metal's.
TEST(BoundaryAlbedo, CompensatedSheetReturnsEverything) {
  for (const float alpha : alphas) {
    for (const float cos_o : cosines) {
      DielectricBsdf<float> b = glass(2, alpha);
      b.thin = true;
      b.lost = ggx_loss(metal_table().data(), cos_o, {alpha, alpha});
      EXPECT_NEAR(returned(b, seen_under(cos_o)), 1.0, 5e-3) << label(2, alpha, cos_o);
    }
  }
}

// The base gets what the coat lets through, so that white over white returns everything.
TEST(BoundaryAlbedo, CompensatedCoatReturnsEverything) {
  double most_lost = 0.0;
  for_each_case([&](int table, float alpha, float cos_o) {
    const glm::vec3 wo = seen_under(cos_o);
    const CoatedBsdf<float> b = coat(table, alpha);
    if (alpha == 1.0f) most_lost = std::max(most_lost, 1.0 - returned(b, wo));
    EXPECT_NEAR(returned(compensated(b, table, cos_o), wo), 1.0, 5e-3)
        << label(table, alpha, cos_o);
  });
  EXPECT_GT(most_lost, 0.6) << "without compensation";
}

TEST(BoundaryAlbedo, CompensatedTransparentPrincipledReturnsEverything) {
  for (const bool thin : {false, true}) {
    for_each_case([&](int table, float alpha, float cosine) {
      for (const float cos_o : {cosine, -cosine}) {
        PrincipledBsdf<float> b{
            glm::vec3(1.0f), 0.0f, alpha, indices[table], 1.0f, 1.0f, 0.0f, 0.1f, thin};
        b.lost = ggx_loss(metal_table().data(), cosine, {alpha, alpha});
        b.lost_by_clear =
            thin ? b.lost : boundary_loss(tables(), table, cos_o < 0.0f, cosine, alpha);
        EXPECT_NEAR(returned(b, seen_under(cos_o)), 1.0, 5e-3)
            << label(table, alpha, cos_o) << thin;
      }
    });
  }
}

// What is tinted stays below white, and black gives nothing.
TEST(BoundaryAlbedo, ColoursTintWhatIsPutBack) {
  for (const float tint : {0.0f, 0.5f}) {
    DielectricBsdf<float> b = glass(2, 0.8f);
    b.reflectance = b.transmittance = glm::vec3(tint);
    for (const float cos_o : {0.3f, -0.3f}) {
      const glm::vec3 wo = seen_under(cos_o);
      const DielectricBsdf<float> whole = compensated(b, 2, cos_o);
      const double expected = returned(b, wo) * double(1.0f + whole.lost * tint);
      EXPECT_LE(returned(whole, wo), double(tint));
      EXPECT_NEAR(returned(whole, wo), expected, 1e-5);
    }
  }
}

// Density and samples of glass are those without; of a coat the choice between layers differs.
TEST(BoundaryAlbedo, SamplesKeepTheirDensity) {
  std::uint32_t seed = 40;
  const double significance = sidak_significance(6);
  for (const float cos_o : {0.1f, 0.5f, 0.9f}) {
    const glm::vec3 wo = seen_under(cos_o);
    for (const float alpha : {0.3f, 1.0f}) {
      const BsdfUnderTest bsdf = under_test("coat", compensated(coat(2, alpha), 2, cos_o));
      expect_samples_follow_density(bsdf, wo, Side::Same, DirectionMap(glm::dvec3(0, 0, 1)),
                                    significance, ++seed, label(2, alpha, cos_o));
      expect_weights_match(bsdf, wo, 2e-3f, ++seed, label(2, alpha, cos_o));
    }
    for (const float side : {1.0f, -1.0f}) {
      const DielectricBsdf<float> b = glass(2, 0.4f), whole = compensated(b, 2, side * cos_o);
      const glm::vec3 from = seen_under(side * cos_o);
      expect_weights_match(under_test("glass", whole), from, 2e-2f, ++seed, "glass");
      for (std::uint32_t i = 0; i < 256; ++i) {
        const glm::vec3 u = uniform3(i, seed);
        const auto s = sample_once(b, from, u.z, Vec2<float>(u.x, u.y));
        const auto t = sample_once(whole, from, u.z, Vec2<float>(u.x, u.y));
        ASSERT_TRUE(same_value(s.wi, t.wi) && same_value(s.pdf, t.pdf));
      }
    }
  }
}

TEST(BoundaryAlbedo, HasTheSameBitsAtEveryWidth) {
  const std::vector<MaterialRow> rows = {{1, 1, 1, 1, 1, 1, 0.3f, 0.3f, 1.5f, 0},
                                         {0.5f, 1, 1, 1, 0.2f, 1, 0.6f, 0.2f, 2.5f, 0},
                                         {1, 1, 1, 1, 1, 1, 0.0f, 0.0f, 1.33f, 0}};
  const std::vector<MaterialRow> coats = {{0.5f, 0.4f, 1, 1, 1, 1, 0.2f, 1.5f, 1, 0.6f, 0, 0},
                                          {0.5f, 0.4f, 1, 1, 0.5f, 1, 0.9f, 2.5f, 1, 0.8f, 0.1f, 3},
                                          {0.5f, 0.4f, 1, 1, 1, 1, 0.5f, 1.1f, 0, 0.1f, 0, 0}};
  for_each_width([&](auto width) {
    expect_same_bits<width()>(rows, true, [](const MaterialTable& t, auto index) {
      auto b = load_dielectric(t, index);
      using V = decltype(b.eta);
      b.lost = boundary_loss(tables(), index, b.ggx.alpha.y > V(0.25f), V(0.4f), b.ggx.alpha.x);
      return b;
    });
    expect_same_bits<width()>(coats, false, [](const MaterialTable& t, auto index) {
      auto b = load_coated(t, index);
      using V = decltype(b.eta);
      b.boundary_albedo = tables();
      b.table = index;
      b.lost = boundary_loss(tables(), index, MaskOf<V>(false), V(0.4f), b.ggx.alpha.x);
      b.inner_reflectance =
          b.inner_reflectance + boundary_inner_difference(tables(), index, b.ggx.alpha.x);
      return b;
    });
  });
}

TEST(BoundaryAlbedo, IsFiniteAtGrazingAngles) {
  for (const float alpha : {1e-3f, 0.03f, 1.0f}) {
    for (const float cos_o : {1e-6f, -1e-6f}) {
      expect_finite_at_extremes(under_test("glass", compensated(glass(3, alpha), 3, cos_o)), true);
    }
    expect_finite_at_extremes(under_test("coat", compensated(coat(3, alpha), 3, 1e-6f)), false);
  }
}

TEST(BoundaryAlbedo, TablesAreSharedAndBounded) {
  std::vector<float> etas;
  EXPECT_EQ(boundary_table_for(1.5f, etas), 0u);
  EXPECT_EQ(boundary_table_for(1.33f, etas), 1u);
  EXPECT_EQ(boundary_table_for(1.5f, etas), 0u);
  EXPECT_EQ(etas, (std::vector<float>{1.5f, 1.33f}));
  for (int i = 0; i < 1000; ++i) boundary_table_for(1.0f + 0.001f * float(i), etas);
  ASSERT_EQ(etas.size(), most_boundary_tables);
  EXPECT_EQ(boundary_table_for(1.499f, etas), 0u);
  std::vector<float> extreme;
  for (const float eta : {0.0f, -1.0f, NAN, INFINITY, 1e30f, 1e-30f}) {
    boundary_table_for(eta, extreme);
  }
  EXPECT_EQ(extreme, (std::vector<float>{1.0f / 16.0f, 16.0f}));
  for (const float value : make_boundary_albedo(extreme)) ASSERT_TRUE(is_finite(value));
}

}  // namespace
}  // namespace lockstep::test_boundary_albedo
