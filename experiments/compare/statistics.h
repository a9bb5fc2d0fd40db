// Summaries of repeated measurements, and curves of error against time read at equal time.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace lockstep {

// The value below which a share q in [0, 1] of the values lies, interpolated linearly between
// order statistics (Hyndman and Fan 1996, type 7). `values` is not empty.
double quantile(std::vector<double> values, double q);

// What Student's t of so many degrees of freedom exceeds with probability `tail`.
double student_quantile(double freedom, double tail);

struct Spread {
  double median = 0.0;
  double p5 = 0.0;
  double p95 = 0.0;
  double mean = 0.0;
};

Spread spread_of(const std::vector<double>& values);

// How well the median is known: half of its 95 % interval, as a share of it. From the median
// absolute deviation, so that one disturbed value in many does not count. Empty with fewer than two
// values, or where the median is 0.
std::optional<double> median_uncertainty(const std::vector<double>& values);

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

// The time at which the curve first comes down to `error`, straight in log time and log error.
// Empty where it begins at or below `error`, or never reaches it: nothing is extrapolated.
std::optional<double> time_at(std::vector<CurvePoint> curve, double error);

// Times at which to compare: the range's end and quarters of it, down to its beginning; longest
// first.
std::vector<double> time_budgets(TimeRange range);

constexpr std::size_t kFewestPairs = 4;           // below, an interval says nothing
constexpr std::size_t kFewestBootstrapPairs = 6;  // below, resampling has too little to draw from

struct Ratio {
  double value = 1.0;
  std::optional<double> low, high;  // 95 % interval; empty with fewer than kFewestPairs
  std::size_t pairs = 0;
};

// Geometric mean of errors[i] / base[i] over paired runs, with the 95 % interval of the bootstrap
// over pairs: studentised, of the logarithms (Efron and Tibshirani, An Introduction to the
// Bootstrap, 1993, section 12.5), the same for the same numbers. Plain percentiles are no 95 % for
// a handful of seeds: where nothing differs, theirs of eight exclude 1 in a tenth of the cases,
// these in a twentieth. With four or five pairs the interval is Student's. Empty where an error is
// zero.
std::optional<Ratio> paired_ratio(const std::vector<double>& errors,
                                  const std::vector<double>& base);

}  // namespace lockstep
