// One sampler's renders of a scene by sample count, and how two samplers compare at equal CPU time.
#pragma once

#include "experiments/compare/compare.h"
#include "experiments/compare/statistics.h"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace lockstep {

// The renders of one sample count: runs in the order of the seeds, and the CPU times of all, those
// repeated for their time alone included.
struct Rung {
  std::vector<const Measurement*> runs;
  std::vector<double> cpu_times;
};

// By sample count.
using Rungs = std::map<int, Rung>;

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

// What to know about the times where CPUs of several names rendered the scene: a sentence; empty
// where one did.
std::string unlike_machines(const SceneComparison& scene);

// True where the rung's median of the metric is below three times what the reference itself is off
// by: much of it may be the reference's. False where that is not known.
bool is_near_reference(const Reference& reference, const Rung& rung, std::size_t metric);

// Ratio of the CPU time that one sampler needs for `error` to another's, paired over the seeds that
// both reach it with. Empty where no seed of both does.
std::optional<Ratio> time_ratio(const Rungs& rungs, const Rungs& base, std::size_t metric,
                                double error);

}  // namespace lockstep
