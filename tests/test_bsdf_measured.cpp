// Measured reflectance: sampling, energy, interpolation, reciprocity and equal bits at every width.
#include "core/bsdf/measured.h"

#include "core/microfacet.h"
#include "tests/bsdf_checks.h"
#include "tests/t_measured.h"

namespace lockstep::test_bsdf_measured {
namespace {

const glm::vec3 tint(0.9f, 0.6f, 0.3f);

glm::vec3 lambert(glm::vec3, glm::vec3) { return tint * inv_pi; }

// White facets of this roughness.
Reflectance facets(float alpha) {
  return [alpha](glm::vec3 wo, glm::vec3 wi) {
    const Ggx<float> ggx{{alpha, alpha}};
    const float f = ggx.d(glm::normalize(wo + wi)) * ggx.g2(wo, wi) / (4.0f * wo.z * wi.z);
    return glm::vec3(f);
  };
}

// Bright where light goes back to where it came from, and at grazing angles.
glm::vec3 odd(glm::vec3 wo, glm::vec3 wi) {
  const float back = std::max(glm::dot(wo, wi), 0.0f);
  return tint * (0.1f + 0.5f * back * back * back * back) / std::max(wo.z + wi.z, 0.2f);
}

struct Case {
  std::string name;
  MeasuredTable table;
  bool sharp = false;

  MeasuredBsdf<float> bsdf() const { return {table.values.data(), 0, table.values[0]}; }
};

const std::vector<Case>& cases() {
  static const std::vector<Case> all = {
      {"Lambert", make_measured_table(cells_of(lambert), "Lambert")},
      {"facets .3", make_measured_table(cells_of(facets(0.3f)), "facets")},
      {"facets .06", make_measured_table(cells_of(facets(0.06f)), "facets"), true},
      {"odd", make_measured_table(cells_of(odd), "odd")},
      {"black",
       make_measured_table(cells_of([](auto, auto) { return glm::vec3(0.0f); }), "black")}};
  return all;
}
constexpr float view_angles[] = {0.0f, 35.0f, 60.0f, 85.0f};

template <class F>
void for_each_case(F f) {
  std::uint32_t seed = 300;
  for (const Case& c : cases()) {
    const BsdfUnderTest bsdf = under_test(c.name, c.bsdf());
    for (const float degrees : view_angles) {
      f(c, bsdf, view_direction(degrees), at_angle(bsdf, degrees), ++seed);
    }
  }
}

// As expect_samples_follow_density has it: what the density lacks of 1 is what samples lose.
TEST(Measured, SamplesHaveTheDensityThatEvalGives) {
  const double significance = sidak_significance(int(cases().size() * std::size(view_angles)));
  for_each_case([&](const Case& c, const BsdfUnderTest& bsdf, glm::vec3 wo,
                    const std::string& label, std::uint32_t seed) {
    const glm::dvec3 axis = c.sharp ? glm::dvec3(-wo.x, -wo.y, wo.z) : glm::dvec3(0, 0, 1);
    const double mass = expect_samples_follow_density(
        bsdf, wo, Side::Same, DirectionMap(axis, c.sharp ? 3.0 : 1.0), significance, seed, label);
    EXPECT_GT(mass, 0.5) << label;
  });
}

TEST(Measured, WeightsAreThoseOfEval) {
  for_each_case([](const Case&, const BsdfUnderTest& bsdf, glm::vec3 wo, const std::string& label,
                   std::uint32_t seed) { expect_weights_match(bsdf, wo, 1e-6f, seed, label); });
}

TEST(Measured, IsFiniteAtExtremes) {
  for (const Case& c : cases()) expect_finite_at_extremes(under_test(c.name, c.bsdf()), false);
}

// Mean weights are the integral of the table, by quadrature, within five standard errors.
TEST(Measured, ReflectsWhatTheTableHolds) {
  for_each_case([](const Case& c, const BsdfUnderTest& bsdf, glm::vec3 wo, const std::string& label,
                   std::uint32_t seed) {
    const DirectionMap map(c.sharp ? glm::dvec3(-wo.x, -wo.y, wo.z) : glm::dvec3(0, 0, 1),
                           c.sharp ? 3.0 : 1.0);
    const double expected = integrate(
        [&](glm::dvec2 p) {
          const glm::vec3 wi(map.to_direction(p));
          if (wi.z <= 0.0f) return 0.0;
          return double(max_component(bsdf.eval(wo, wi).f_cos)) * map.solid_angle_per_area(p);
        },
        {0.0, 0.0}, {1.0, 1.0}, 1e-4);
    const MeanWeight found = albedo(bsdf, wo, seed);
    EXPECT_NEAR(found.value, expected, 5.0 * found.sigma + 3e-4) << label;
  });
}

TEST(Measured, LambertsTableIsLambertsModel) {
  const MeasuredBsdf<float> bsdf = cases()[0].bsdf();
  for (std::uint32_t i = 0; i < 4096; ++i) {
    const glm::vec3 wo = cosine_hemisphere(uniform2(i, 1)), wi = cosine_hemisphere(uniform2(i, 2));
    const glm::vec3 f = eval(bsdf, wo, wi).f_cos;
    ASSERT_LT(max_component(abs(f - tint * (inv_pi * wi.z))), 1e-6f);
  }
}

TEST(Measured, IsReciprocalToTheLastBit) {
  for (const Case& c : cases()) {
    const MeasuredBsdf<float> bsdf = c.bsdf();
    for (std::uint32_t i = 0; i < 4096; ++i) {
      const glm::vec3 wo = cosine_hemisphere(uniform2(i, 3)),
                      wi = cosine_hemisphere(uniform2(i, 4));
      const glm::vec3 there = table_value(bsdf, half_angles(wo, wi));
      ASSERT_TRUE(same_value(there, table_value(bsdf, half_angles(wi, wo)))) << c.name << i;
    }
  }
}

// Values at the cells' middles come back, so coordinates and cells belong together.
TEST(Measured, CellsMiddlesKeepTheirValues) {
  const MeasuredTable table = make_measured_table(
      cells_of([](glm::vec3 wo, glm::vec3 wi) {
        return glm::vec3(wo.z * wi.z, glm::length(wo + wi), glm::length(wo - wi));
      }),
      "test");
  const MeasuredBsdf<float> bsdf{table.values.data(), 0, 0.5f};
  int compared = 0;
  for (int h = 5; h < measured_halves; h += 7) {
    for (int d = 1; d < measured_differences; d += 4) {
      for (int p = 0; p < measured_azimuths; p += 3) {
        const auto [wo, wi] = directions_of_cell(h, d, p);
        if (wo.z < 1e-3f || wi.z < 1e-3f) continue;
        ++compared;
        const glm::vec3 f = table_value(bsdf, half_angles(wo, wi));
        const glm::vec3 expected(wo.z * wi.z, glm::length(wo + wi), glm::length(wo - wi));
        ASSERT_LT(max_component(abs(f - expected)), 2e-4f) << h << ' ' << d << ' ' << p;
      }
    }
  }
  EXPECT_GT(compared, 500);
}

// Of what facets reflect under 45 degrees, the share that the table puts elsewhere.
double misplaced_share(float alpha) {
  const Reflectance truth = facets(alpha);
  const MeasuredTable table = make_measured_table(cells_of(truth), "facets");
  const MeasuredBsdf<float> bsdf{table.values.data(), 0, 0.5f};
  const glm::vec3 wo = view_direction(45.0f);
  const DirectionMap map(glm::dvec3(-wo.x, -wo.y, wo.z), 3.0);
  double off = 0.0, all = 0.0;
  constexpr int n = 256;
  for (int i = 0; i < n * n; ++i) {
    const glm::dvec2 p((i % n + 0.5) / n, (i / n + 0.5) / n);
    const glm::vec3 wi(map.to_direction(p));
    if (wi.z <= 0.0f) continue;
    const double f = double(truth(wo, wi).x * wi.z), area = map.solid_angle_per_area(p);
    all += f * area;
    off += std::abs(double(eval(bsdf, wo, wi).f_cos.x) - f) * area;
  }
  return off / all;
}

TEST(Measured, IsFineEnoughForHighlights) {
  EXPECT_LT(misplaced_share(0.05f), 0.01);
  EXPECT_LT(misplaced_share(0.3f), 0.01);
}

// Half vectors have to be worth their while: cosine sampling alone has a hundred times the
// variance.
TEST(Measured, DrawsHighlightsMostOfTheTime) {
  const BsdfUnderTest sharp = under_test("facets .06", cases()[2].bsdf());
  for (const float degrees : {0.0f, 35.0f, 60.0f}) {
    const MeanWeight w = albedo(sharp, view_direction(degrees), 7);
    EXPECT_LT(w.sigma * std::sqrt(double(1 << 15)), 1.0 * w.value) << degrees;
  }
}

TEST(Measured, KnowsTheLargestAlbedo) {
  EXPECT_NEAR(largest_albedo(cases()[0].table).largest, 0.9, 1e-3);
  const auto twice = [](glm::vec3 wo, glm::vec3 wi) { return 2.0f * facets(0.1f)(wo, wi); };
  EXPECT_NEAR(largest_albedo(make_measured_table(cells_of(twice), "twice")).largest, 2.0, 0.03);
}

TEST(Measured, GivesTheSameBitsAtEveryWidth) {
  std::vector<float> tables;
  std::vector<MaterialRow> rows;
  for (const Case& c : cases()) {
    rows.push_back({float(rows.size())});
    tables.insert(tables.end(), c.table.values.begin(), c.table.values.end());
  }
  const auto load_model = [&](MaterialTable t, auto index) {
    t.measured = tables.data();
    t.measured_count = int(cases().size());
    return load_measured(t, index);
  };
  for_each_width([&](auto width) { expect_same_bits<width()>(rows, false, load_model); });
}

}  // namespace
}  // namespace lockstep::test_bsdf_measured
