#include "experiments/compare/statistics.h"

#include <boost/math/distributions/students_t.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

namespace lockstep {
namespace {

constexpr double kBudgetStep = 4.0;

double interpolate(const CurvePoint& a, const CurvePoint& b, double time) {
  if (b.time <= a.time) return std::sqrt(a.error * b.error);
  const double s = std::log(time / a.time) / std::log(b.time / a.time);
  if (a.error <= 0.0 || b.error <= 0.0) return a.error + s * (b.error - a.error);
  return std::exp(std::log(a.error) + s * std::log(b.error / a.error));
}

std::vector<CurvePoint> by_time(std::vector<CurvePoint> curve) {
  std::sort(curve.begin(), curve.end(),
            [](const CurvePoint& a, const CurvePoint& b) { return a.time < b.time; });
  return curve;
}

struct MeanWithError {
  double mean = 0.0;
  double error = 0.0;  // standard error of the mean
};

MeanWithError mean_of(const std::vector<double>& values) {
  const double n = double(values.size());
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
  double squares = 0.0;
  for (double value : values) squares += (value - mean) * (value - mean);
  return {mean, std::sqrt(squares / (n - 1.0) / n)};
}

struct Interval {
  double low = 0.0;
  double high = 0.0;
};

Interval student_interval(const MeanWithError& of, double n) {
  const double reach = student_quantile(n - 1.0, 0.025) * of.error;
  return {of.mean - reach, of.mean + reach};
}

// How far resampled means lie from the mean, in their own standard errors, bounds it.
Interval bootstrap_interval(const std::vector<double>& values, const MeanWithError& of) {
  constexpr int kResamples = 2000;
  if (of.error <= 1e-12 * std::abs(of.mean)) return {of.mean, of.mean};
  std::mt19937 random(1);
  std::vector<double> resample(values.size()), distances;
  while (distances.size() < kResamples) {
    for (double& value : resample) value = values[random() % values.size()];
    const MeanWithError again = mean_of(resample);
    // One value drawn every time has no error to measure by; it is one draw in thousands.
    if (again.error <= 1e-12 * of.error) continue;
    distances.push_back((again.mean - of.mean) / again.error);
  }
  return {of.mean - quantile(distances, 0.975) * of.error,
          of.mean - quantile(distances, 0.025) * of.error};
}

}  // namespace

double student_quantile(double freedom, double tail) {
  return boost::math::quantile(boost::math::complement(boost::math::students_t(freedom), tail));
}

double quantile(std::vector<double> values, double q) {
  std::sort(values.begin(), values.end());
  const double place = q * double(values.size() - 1);
  const std::size_t below = std::size_t(place);
  const std::size_t above = std::min(below + 1, values.size() - 1);
  return values[below] + (place - double(below)) * (values[above] - values[below]);
}

Spread spread_of(const std::vector<double>& values) {
  return {quantile(values, 0.5), quantile(values, 0.05), quantile(values, 0.95),
          std::accumulate(values.begin(), values.end(), 0.0) / double(values.size())};
}

std::optional<double> median_uncertainty(const std::vector<double>& values) {
  if (values.size() < 2) return {};
  const double median = quantile(values, 0.5);
  if (median <= 0.0) return {};
  std::vector<double> deviations;
  for (double value : values) deviations.push_back(std::abs(value - median));
  // Of normal values: deviation = 1.4826 MAD, standard error of the median = 1.2533 / sqrt(n) of
  // it.
  const double deviation = 1.4826 * quantile(deviations, 0.5);
  return 1.96 * 1.2533 * deviation / std::sqrt(double(values.size())) / median;
}

std::optional<double> error_at(std::vector<CurvePoint> curve, double time) {
  curve = by_time(std::move(curve));
  if (curve.empty() || !(time >= curve.front().time && time <= curve.back().time)) return {};
  if (curve.size() == 1) return curve.front().error;
  std::size_t i = 1;
  while (i + 1 < curve.size() && curve[i].time < time) ++i;
  return interpolate(curve[i - 1], curve[i], time);
}

std::optional<double> time_at(std::vector<CurvePoint> curve, double error) {
  curve = by_time(std::move(curve));
  if (curve.empty() || curve.front().error <= error || error <= 0.0) return {};
  const auto reached = [&](const CurvePoint& point) { return point.error <= error; };
  const auto after = std::find_if(curve.begin(), curve.end(), reached);
  if (after == curve.end()) return {};
  const CurvePoint &a = *(after - 1), &b = *after;
  const double share = b.error > 0.0 ? std::log(error / a.error) / std::log(b.error / a.error)
                                     : (error - a.error) / (b.error - a.error);
  return a.time * std::pow(b.time / a.time, share);
}

std::optional<TimeRange> common_times(const std::vector<std::vector<CurvePoint>>& curves) {
  if (curves.empty()) return {};
  TimeRange range{0.0, HUGE_VAL};
  for (const std::vector<CurvePoint>& curve : curves) {
    if (curve.empty()) return {};
    const auto [first, last] = std::minmax_element(
        curve.begin(), curve.end(),
        [](const CurvePoint& a, const CurvePoint& b) { return a.time < b.time; });
    range.low = std::max(range.low, first->time);
    range.high = std::min(range.high, last->time);
  }
  if (range.low > range.high) return {};
  return range;
}

std::vector<double> time_budgets(TimeRange range) {
  std::vector<double> budgets;
  for (double time = range.high; time >= range.low && time > 0.0; time /= kBudgetStep) {
    budgets.push_back(time);
  }
  return budgets;
}

std::optional<Ratio> paired_ratio(const std::vector<double>& errors,
                                  const std::vector<double>& base) {
  if (errors.empty() || errors.size() != base.size()) return {};
  std::vector<double> logs;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    if (errors[i] <= 0.0 || base[i] <= 0.0) return {};
    logs.push_back(std::log(errors[i] / base[i]));
  }
  if (logs.size() < 2) return Ratio{std::exp(logs.front()), {}, {}, 1};
  const MeanWithError mean = mean_of(logs);
  Ratio ratio{std::exp(mean.mean), {}, {}, logs.size()};
  if (logs.size() < kFewestPairs) return ratio;
  const Interval interval = logs.size() < kFewestBootstrapPairs
                                ? student_interval(mean, double(logs.size()))
                                : bootstrap_interval(logs, mean);
  ratio.low = std::exp(interval.low);
  ratio.high = std::exp(interval.high);
  return ratio;
}

}  // namespace lockstep
