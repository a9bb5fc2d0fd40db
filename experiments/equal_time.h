// One sampler's renders of a scene by sample count, and how two samplers compare at equal CPU time.
#pragma once

#include "experiments/compare.h"
#include "experiments/statistics.h"

#include <map>
#include <optional>
#include <vector>

namespace lockstep {

// Runs by sample count; each list is in the order of the seeds.
using Rungs = std::map<int, std::vector<const Measurement*>>;

Rungs rungs_of(const SceneComparison& scene, int sampler);

template <class Get>
std::vector<double> values_of(const std::vector<const Measurement*>& runs, Get get) {
  std::vector<double> values;
  for (const Measurement* run : runs) values.push_back(get(*run));
  return values;
}

// The median error of each rung at its median CPU time. `metric` is an index into metrics().
std::vector<CurvePoint> median_curve(const Rungs& rungs, std::size_t metric);

// The CPU times that the medians of all samplers cover; empty where there are none.
std::optional<TimeRange> common_times(const std::vector<Rungs>& samplers);

// Ratio of one sampler's error to another's at `time`, paired over the seeds that both have. Empty
// where no seed of both covers the time, or an error is zero.
std::optional<Ratio> ratio_at(const Rungs& rungs, const Rungs& base, std::size_t metric,
                              double time);

}  // namespace lockstep
