#include "experiments/compare/equal_time.h"

#include "experiments/metrics/metrics.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

namespace lockstep {
namespace {

double cpu_median(const Rung& rung) { return quantile(rung.cpu_times, 0.5); }

// One seed's errors at the rungs' median times: noise in a single timing stays out of the ratio.
std::vector<CurvePoint> seed_curve(const Rungs& rungs, std::uint32_t seed, std::size_t metric) {
  std::vector<CurvePoint> curve;
  for (const auto& [spp, rung] : rungs) {
    for (const Measurement* run : rung.runs) {
      if (run->seed == seed) curve.push_back({cpu_median(rung), run->errors[metric]});
    }
  }
  return curve;
}

// The ratio of what `value` reads off the two samplers' curves of each seed.
template <class Value>
std::optional<Ratio> ratio_of(const Rungs& rungs, const Rungs& base, std::size_t metric,
                              Value value) {
  std::set<std::uint32_t> seeds;
  for (const auto& [spp, rung] : rungs) {
    for (const Measurement* run : rung.runs) seeds.insert(run->seed);
  }
  std::vector<double> values, base_values;
  for (std::uint32_t seed : seeds) {
    const std::optional<double> own = value(seed_curve(rungs, seed, metric));
    const std::optional<double> other = value(seed_curve(base, seed, metric));
    if (!own || !other) continue;
    values.push_back(*own);
    base_values.push_back(*other);
  }
  return paired_ratio(values, base_values);
}

}  // namespace

Rungs rungs_of(const SceneComparison& scene, int sampler) {
  Rungs rungs;
  for (const Measurement& run : scene.runs) {
    if (run.sampler != sampler) continue;
    rungs[run.spp].runs.push_back(&run);
    rungs[run.spp].cpu_times.push_back(run.cpu_seconds);
  }
  for (const TimingRepeat& repeat : scene.repeats) {
    if (repeat.sampler != sampler || !rungs.contains(repeat.spp)) continue;
    rungs[repeat.spp].cpu_times.push_back(repeat.cpu_seconds);
  }
  for (auto& [spp, rung] : rungs) {
    std::sort(rung.runs.begin(), rung.runs.end(),
              [](const Measurement* a, const Measurement* b) { return a->seed < b->seed; });
  }
  return rungs;
}

std::vector<CurvePoint> median_curve(const Rungs& rungs, std::size_t metric) {
  std::vector<CurvePoint> curve;
  for (const auto& [spp, rung] : rungs) {
    const auto error = [&](const Measurement& run) { return run.errors[metric]; };
    curve.push_back({cpu_median(rung), quantile(values_of(rung.runs, error), 0.5)});
  }
  return curve;
}

std::optional<TimeRange> common_times(const std::vector<Rungs>& samplers) {
  std::vector<std::vector<CurvePoint>> curves;
  for (const Rungs& rungs : samplers) curves.push_back(median_curve(rungs, 0));
  return common_times(curves);
}

std::optional<Ratio> ratio_at(const Rungs& rungs, const Rungs& base, std::size_t metric,
                              double time) {
  return ratio_of(rungs, base, metric, [time](std::vector<CurvePoint> curve) {
    return error_at(std::move(curve), time);
  });
}

std::string unlike_machines(const SceneComparison& scene) {
  std::map<std::string, int> renders;
  for (const Measurement& run : scene.runs) ++renders[run.cpu];
  for (const TimingRepeat& repeat : scene.repeats) ++renders[repeat.cpu];
  if (renders.size() < 2) return {};
  std::vector<std::string> parts;
  for (const auto& [cpu, count] : renders) {
    parts.push_back(fmt::format("{} on {}", count, cpu.empty() ? "an unknown CPU" : cpu));
  }
  return fmt::format(
      "Times are from unlike machines (renders: {}): those of one seed are from one of them and "
      "may "
      "be compared, medians over seeds mix them.",
      fmt::join(parts, ", "));
}

bool is_near_reference(const Reference& reference, const Rung& rung, std::size_t metric) {
  constexpr double kNear = 3.0;
  const auto own = reference.errors.find(std::string(metrics()[metric].name));
  if (own == reference.errors.end()) return false;
  const auto error = [&](const Measurement& run) { return run.errors[metric]; };
  return quantile(values_of(rung.runs, error), 0.5) < kNear * own->second;
}

std::optional<Ratio> time_ratio(const Rungs& rungs, const Rungs& base, std::size_t metric,
                                double error) {
  return ratio_of(rungs, base, metric, [error](std::vector<CurvePoint> curve) {
    return time_at(std::move(curve), error);
  });
}

}  // namespace lockstep
