#include "experiments/statistics.h"

#include <boost/math/distributions/students_t.hpp>

#include <algorithm>
#include <cmath>

namespace lockstep {
namespace {

constexpr double kBudgetStep = 4.0;

double interpolate(const CurvePoint& a, const CurvePoint& b, double time) {
  if (b.time <= a.time) return std::sqrt(a.error * b.error);
  const double s = std::log(time / a.time) / std::log(b.time / a.time);
  if (a.error <= 0.0 || b.error <= 0.0) return a.error + s * (b.error - a.error);
  return std::exp(std::log(a.error) + s * std::log(b.error / a.error));
}

}  // namespace

double quantile(std::vector<double> values, double q) {
  std::sort(values.begin(), values.end());
  const double place = q * double(values.size() - 1);
  const std::size_t below = std::size_t(place);
  const std::size_t above = std::min(below + 1, values.size() - 1);
  return values[below] + (place - double(below)) * (values[above] - values[below]);
}

Spread spread_of(const std::vector<double>& values) {
  return {quantile(values, 0.5), quantile(values, 0.05), quantile(values, 0.95)};
}

std::optional<double> error_at(std::vector<CurvePoint> curve, double time) {
  std::sort(curve.begin(), curve.end(),
            [](const CurvePoint& a, const CurvePoint& b) { return a.time < b.time; });
  if (curve.empty() || !(time >= curve.front().time && time <= curve.back().time)) return {};
  if (curve.size() == 1) return curve.front().error;
  std::size_t i = 1;
  while (i + 1 < curve.size() && curve[i].time < time) ++i;
  return interpolate(curve[i - 1], curve[i], time);
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
  double sum = 0.0;
  for (double value : logs) sum += value;
  Ratio ratio{std::exp(sum / double(logs.size())), {}, {}};
  if (logs.size() < kFewestPairs) return ratio;

  double squares = 0.0;
  const double centre = std::log(ratio.value), n = double(logs.size());
  for (double value : logs) squares += (value - centre) * (value - centre);
  const double error = std::sqrt(squares / (n - 1.0) / n);
  const double reach = boost::math::quantile(boost::math::students_t(n - 1.0), 0.975) * error;
  ratio.low = std::exp(centre - reach);
  ratio.high = std::exp(centre + reach);
  return ratio;
}

}  // namespace lockstep
