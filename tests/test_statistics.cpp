// Summary statistics and equal-time interpolation against values worked out by hand.
#include "experiments/compare/statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace lockstep::test_statistics {
namespace {

TEST(Statistics, QuantilesInterpolateBetweenOrderStatistics) {
  EXPECT_DOUBLE_EQ(quantile({3.0}, 0.95), 3.0);
  EXPECT_DOUBLE_EQ(quantile({4.0, 1.0, 3.0, 2.0}, 0.5), 2.5);
  EXPECT_DOUBLE_EQ(quantile({0.0, 10.0}, 0.05), 0.5);
  const Spread spread = spread_of({5.0, 1.0, 2.0, 3.0, 4.0});
  EXPECT_DOUBLE_EQ(spread.median, 3.0);
  EXPECT_DOUBLE_EQ(spread.p5, 1.2);
  EXPECT_DOUBLE_EQ(spread.p95, 4.8);
}

TEST(Statistics, CurvesAreStraightInLogTimeAndLogError) {
  // error = 8 / time: 2 at time 4, whatever the points' order.
  const std::optional<double> error = error_at({{16.0, 0.5}, {1.0, 8.0}}, 4.0);
  ASSERT_TRUE(error);
  EXPECT_NEAR(*error, 2.0, 1e-12);
}

TEST(Statistics, CurvesGoThroughTheirPoints) {
  const std::vector<CurvePoint> curve = {{1.0, 8.0}, {2.0, 5.0}, {16.0, 0.5}};
  for (const CurvePoint& point : curve) {
    ASSERT_TRUE(error_at(curve, point.time));
    EXPECT_NEAR(*error_at(curve, point.time), point.error, 1e-12);
  }
}

TEST(Statistics, NothingIsExtrapolated) {
  const std::vector<CurvePoint> curve = {{1.0, 8.0}, {16.0, 0.5}};
  EXPECT_FALSE(error_at(curve, 0.999));
  EXPECT_FALSE(error_at(curve, 16.001));
  EXPECT_FALSE(error_at({}, 1.0));
  EXPECT_TRUE(error_at({{2.0, 3.0}}, 2.0));
  EXPECT_FALSE(error_at({{2.0, 3.0}}, 2.1));
}

TEST(Statistics, AnErrorOfZeroIsReachedInAStraightLine) {
  EXPECT_NEAR(*error_at({{1.0, 2.0}, {4.0, 0.0}}, 2.0), 1.0, 1e-12);
}

TEST(Statistics, CommonTimesAreTheIntersection) {
  const auto range = common_times({{{1.0, 0.0}, {8.0, 0.0}}, {{10.0, 0.0}, {2.0, 0.0}}});
  ASSERT_TRUE(range);
  EXPECT_DOUBLE_EQ(range->low, 2.0);
  EXPECT_DOUBLE_EQ(range->high, 8.0);
  EXPECT_FALSE(common_times({{{1.0, 0.0}}, {{2.0, 0.0}}}));
  EXPECT_FALSE(common_times({{{1.0, 0.0}}, {}}));
  EXPECT_FALSE(common_times({}));
}

TEST(Statistics, BudgetsAreQuartersWithinTheRange) {
  const std::vector<double> expected = {8.0, 2.0};
  EXPECT_EQ(time_budgets({2.0, 8.0}), expected);
  EXPECT_EQ(time_budgets({8.0, 8.0}).size(), 1u);
}

TEST(Statistics, RatioIsTheGeometricMeanOverPairs) {
  const std::optional<Ratio> ratio = paired_ratio({1.0, 8.0}, {2.0, 4.0});  // 1/2 and 2
  ASSERT_TRUE(ratio);
  EXPECT_NEAR(ratio->value, 1.0, 1e-12);
  EXPECT_FALSE(ratio->low) << "two pairs give no interval";
  EXPECT_FALSE(paired_ratio({0.0}, {1.0}));
  EXPECT_FALSE(paired_ratio({}, {}));
}

TEST(Statistics, IntervalIsStudents) {
  // Logarithms -1, 0, 1, 0: mean 0, deviation sqrt(2/3); t = 3.182446 for three degrees.
  const std::vector<double> errors = {std::exp(-1.0), 1.0, std::exp(1.0), 1.0}, base(4, 1.0);
  const std::optional<Ratio> ratio = paired_ratio(errors, base);
  ASSERT_TRUE(ratio && ratio->low && ratio->high);
  const double reach = 3.182446 * std::sqrt(2.0 / 3.0 / 4.0);
  EXPECT_NEAR(std::log(*ratio->low), -reach, 1e-5);
  EXPECT_NEAR(std::log(*ratio->high), reach, 1e-5);
}

// 2000 experiments in which nothing differs: the interval must exclude 1 in a twentieth of them.
TEST(Statistics, IntervalExcludesTheTruthInATwentieth) {
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0.0, 0.3);
  for (const int seeds : {4, 8, 16}) {
    int excluded = 0;
    for (int experiment = 0; experiment < 2000; ++experiment) {
      std::vector<double> errors, base;
      for (int i = 0; i < seeds; ++i) {
        errors.push_back(std::exp(noise(random)));
        base.push_back(std::exp(noise(random)));
      }
      const std::optional<Ratio> ratio = paired_ratio(errors, base);
      ASSERT_TRUE(ratio && ratio->low && ratio->high);
      excluded += *ratio->low > 1.0 || *ratio->high < 1.0;
    }
    EXPECT_NEAR(excluded, 100, 40) << seeds << " seeds: four standard deviations";
  }
}

// The same with ratios of a long upper tail, where Student's interval misses in a tenth.
TEST(Statistics, IntervalBearsSkewedRatios) {
  std::mt19937 random(2);
  std::exponential_distribution<double> tail;
  int excluded = 0;
  for (int experiment = 0; experiment < 2000; ++experiment) {
    std::vector<double> errors;
    for (int i = 0; i < 12; ++i) errors.push_back(std::exp(tail(random) - 1.0));
    const std::optional<Ratio> ratio = paired_ratio(errors, std::vector<double>(12, 1.0));
    ASSERT_TRUE(ratio && ratio->low && ratio->high);
    excluded += *ratio->low > 1.0 || *ratio->high < 1.0;
  }
  EXPECT_NEAR(excluded, 120, 44) << "four standard deviations about 6 %";
}

TEST(Statistics, PairsWithOneRatioHaveNoSpread) {
  for (int pairs : {4, 8}) {
    std::vector<double> errors, base;
    for (int i = 1; i <= pairs; ++i) {
      errors.push_back(i);
      base.push_back(2.0 * i);
    }
    const std::optional<Ratio> ratio = paired_ratio(errors, base);
    ASSERT_TRUE(ratio && ratio->low);
    EXPECT_NEAR(*ratio->low, 0.5, 1e-12);
    EXPECT_NEAR(*ratio->high, 0.5, 1e-12);
    EXPECT_EQ(ratio->pairs, std::size_t(pairs));
  }
}

TEST(Statistics, IntervalIsTheSameForTheSameNumbers) {
  const std::vector<double> errors = {1.0, 1.2, 0.9, 1.4, 1.1, 0.8, 1.3}, base(7, 1.0);
  const std::optional<Ratio> once = paired_ratio(errors, base), again = paired_ratio(errors, base);
  EXPECT_EQ(*once->low, *again->low);
  EXPECT_LT(*once->low, once->value);
  EXPECT_GT(*once->high, once->value);
}

TEST(Statistics, TimesAreReadWhereTheCurveComesDown) {
  const std::vector<CurvePoint> curve = {{1.0, 8.0}, {4.0, 2.0}, {16.0, 4.0}, {64.0, 1.0}};
  EXPECT_NEAR(*time_at(curve, 4.0), 2.0, 1e-12) << "the first time";
  EXPECT_NEAR(*time_at(curve, 2.0), 4.0, 1e-12);
  EXPECT_NEAR(*time_at(curve, 1.0), 64.0, 1e-9);
  EXPECT_FALSE(time_at(curve, 8.0)) << "it begins there: sooner may be enough";
  EXPECT_FALSE(time_at(curve, 9.0));
  EXPECT_FALSE(time_at(curve, 0.99));
  EXPECT_FALSE(time_at({}, 1.0));
  EXPECT_NEAR(*time_at({{1.0, 2.0}, {4.0, 0.0}}, 1.0), 2.0, 1e-12) << "zero has no logarithm";
}

// Medians of 8 normal values of deviation 5 %: the uncertainty stated holds them in 95 % of cases;
// estimated from so few, in 80 % or more.
TEST(Statistics, MedianUncertaintyIsHonest) {
  std::mt19937 random(3);
  std::normal_distribution<double> noise(1.0, 0.05);
  int held = 0;
  for (int experiment = 0; experiment < 2000; ++experiment) {
    std::vector<double> values;
    for (int i = 0; i < 8; ++i) values.push_back(noise(random));
    held += std::abs(quantile(values, 0.5) - 1.0) <= *median_uncertainty(values);
  }
  EXPECT_GT(held, 1600);
  EXPECT_LT(held, 1980);
  EXPECT_FALSE(median_uncertainty({1.0}));
  EXPECT_EQ(*median_uncertainty({1.0, 1.0, 1.0, 5.0}), 0.0) << "one disturbed value";
  EXPECT_GT(*median_uncertainty({1.0, 2.0}), 0.2);
}

}  // namespace
}  // namespace lockstep::test_statistics
