#include "experiments/equal_time.h"

#include <algorithm>
#include <set>

namespace lockstep {
namespace {

double cpu_median(const std::vector<const Measurement*>& runs) {
  return quantile(values_of(runs, [](const Measurement& run) { return run.cpu_seconds; }), 0.5);
}

// One seed's errors at the rungs' median times: noise in a single timing stays out of the ratio.
std::vector<CurvePoint> seed_curve(const Rungs& rungs, std::uint32_t seed, std::size_t metric) {
  std::vector<CurvePoint> curve;
  for (const auto& [spp, runs] : rungs) {
    for (const Measurement* run : runs) {
      if (run->seed == seed) curve.push_back({cpu_median(runs), run->errors[metric]});
    }
  }
  return curve;
}

}  // namespace

Rungs rungs_of(const SceneComparison& scene, int sampler) {
  Rungs rungs;
  for (const Measurement& run : scene.runs) {
    if (run.sampler == sampler) rungs[run.spp].push_back(&run);
  }
  for (auto& [spp, runs] : rungs) {
    std::sort(runs.begin(), runs.end(),
              [](const Measurement* a, const Measurement* b) { return a->seed < b->seed; });
  }
  return rungs;
}

std::vector<CurvePoint> median_curve(const Rungs& rungs, std::size_t metric) {
  std::vector<CurvePoint> curve;
  for (const auto& [spp, runs] : rungs) {
    const auto error = [&](const Measurement& run) { return run.errors[metric]; };
    curve.push_back({cpu_median(runs), quantile(values_of(runs, error), 0.5)});
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
  std::set<std::uint32_t> seeds;
  for (const auto& [spp, runs] : rungs) {
    for (const Measurement* run : runs) seeds.insert(run->seed);
  }
  std::vector<double> errors, base_errors;
  for (std::uint32_t seed : seeds) {
    const std::optional<double> error = error_at(seed_curve(rungs, seed, metric), time);
    const std::optional<double> base_error = error_at(seed_curve(base, seed, metric), time);
    if (!error || !base_error) continue;
    errors.push_back(*error);
    base_errors.push_back(*base_error);
  }
  return paired_ratio(errors, base_errors);
}

}  // namespace lockstep
