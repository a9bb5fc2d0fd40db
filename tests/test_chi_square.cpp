// The statistical harness itself: tabulated quantiles, and a density that is a little wrong.
#include "tests/chi_square.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace lockstep::test_chi_square {
namespace {

TEST(ChiSquare, PValuesMatchTables) {
  EXPECT_NEAR(upper_gamma(0.5, 0.5 * 3.841458820694124), 0.05, 1e-12);
  EXPECT_NEAR(upper_gamma(1.0, 2.5), std::exp(-2.5), 1e-14);
  EXPECT_NEAR(upper_gamma(5.0, 0.5 * 18.307038053275146), 0.05, 1e-12);
  EXPECT_NEAR(upper_gamma(500.0, 0.5 * 1106.9689955), 0.01, 1e-6);
  EXPECT_NEAR(upper_gamma(0.5, 0.5 * 1.323303697), 0.25, 1e-8);
}

TEST(ChiSquare, SidakKeepsTheSignificanceOfTheWholeSet) {
  EXPECT_NEAR(std::pow(1.0 - sidak_significance(40), 40.0), 1.0 - test_significance, 1e-12);
}

TEST(ChiSquare, IntegratesPeaksAndEdges) {
  const auto step = [](glm::dvec2 p) { return p.x + p.y < 1.0 ? 2.0 : 0.0; };
  EXPECT_NEAR(integrate(step, {0.0, 0.0}, {1.0, 1.0}, 1e-7), 1.0, 1e-3);
  const auto peak = [](glm::dvec2 p) { return std::exp(-50.0 * (p.x * p.x + p.y * p.y)); };
  EXPECT_NEAR(integrate(peak, {-1.0, -1.0}, {1.0, 1.0}, 1e-9), std::numbers::pi / 50.0, 1e-7);
}

TEST(ChiSquare, DirectionMapIsInvertibleAndCoversTheSphere) {
  for (const double power : {1.0, 4.0}) {
    const DirectionMap map(glm::dvec3(0.3, -0.5, 0.8), power);
    double sphere = 0.0;
    for (int i = 0; i < 100; ++i) {
      for (int j = 0; j < 10; ++j) {
        const glm::dvec2 p((i + 0.5) / 100.0, (j + 0.5) / 10.0);
        const glm::dvec2 back = map.to_square(map.to_direction(p));
        EXPECT_NEAR(back.x, p.x, 1e-7);
        EXPECT_NEAR(back.y, p.y, 1e-7);
        sphere += map.solid_angle_per_area(p) / 1000.0;
      }
    }
    EXPECT_NEAR(sphere, 4.0 * std::numbers::pi, 1e-2);
  }
}

// Samples of density 2x on the unit square against `slope`-ed densities of mass `mass`.
ChiSquare test_ramp(double slope, double mass) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform;
  CellCounts counts(16, 16);
  for (int i = 0; i < 100000; ++i) {
    counts.add({std::sqrt(uniform(random)), uniform(random)});
  }
  return counts.test([&](glm::dvec2 p) { return mass * (1.0 + slope * (2.0 * p.x - 1.0)); })
      .chi_square;
}

TEST(ChiSquare, AcceptsTheRightDensityAndRejectsNearlyRightOnes) {
  EXPECT_GT(test_ramp(1.0, 1.0).p_value, 0.01);
  EXPECT_LT(test_ramp(0.95, 1.0).p_value, 1e-6);
  EXPECT_LT(test_ramp(1.0, 0.97).p_value, 1e-6);
}

}  // namespace
}  // namespace lockstep::test_chi_square
