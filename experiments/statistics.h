// Summaries of repeated measurements, and curves of error against time read at equal time.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace lockstep {

// The value below which a share q in [0, 1] of the values lies, interpolated linearly between
// order statistics (Hyndman and Fan 1996, type 7). `values` is not empty.
double quantile(std::vector<double> values, double q);

struct Spread {
  double median = 0.0;
  double p5 = 0.0;
  double p95 = 0.0;
};

Spread spread_of(const std::vector<double>& values);

struct CurvePoint {
  double time = 0.0;  // seconds
  double error = 0.0;
};

// The error at `time` on the curve through the points, straight in log time and log error.
// Empty where `time` lies outside the points' range: nothing is extrapolated.
std::optional<double> error_at(std::vector<CurvePoint> curve, double time);

struct TimeRange {
  double low = 0.0;
  double high = 0.0;
};

// The times that every curve covers; empty where there are none.
std::optional<TimeRange> common_times(const std::vector<std::vector<CurvePoint>>& curves);

// Times at which to compare: the range's end and quarters of it, down to its beginning; longest
// first.
std::vector<double> time_budgets(TimeRange range);

constexpr std::size_t kFewestPairs = 4;  // below, an interval says nothing

struct Ratio {
  double value = 1.0;
  std::optional<double> low, high;  // 95 % interval; empty with fewer than kFewestPairs
};

// Geometric mean of errors[i] / base[i] over paired runs, with Student's interval of
// the logarithms. (Percentiles of a bootstrap are no 95 % for a handful of seeds: where nothing
// differs, theirs of four excludes 1 in a fifth of the cases, Student's in a twentieth.) Empty where
// an error is zero.
std::optional<Ratio> paired_ratio(const std::vector<double>& errors,
                                  const std::vector<double>& base);

}  // namespace lockstep
