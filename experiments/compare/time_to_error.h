// How long each sampler takes to come down to an error, and how that compares.
#pragma once

#include "experiments/compare/equal_time.h"

#include <nlohmann/json.hpp>

#include <optional>
#include <string>
#include <vector>

namespace lockstep {

struct TimeOfSampler {
  std::size_t sampler = 0;            // its place in the settings
  std::optional<double> cpu_seconds;  // of the median error; empty where it was not measured
  std::optional<Ratio> ratio;         // of times to the first sampler's, paired by seed
};

struct TimesToError {
  std::size_t metric = 0;  // index into metrics()
  double error = 0.0;
  std::size_t seeds = 0;                // that were rendered
  std::vector<TimeOfSampler> samplers;  // the first is what the others are measured against
};

// For the settings' targets or, where there are none, for the lowest FLIP that every seed of every
// sampler comes down to, rounded up to two digits; where all have none in common, for the lowest
// that each has in common with the first sampler. Times are read between rungs, never beyond them:
// a sampler whose first rung is better already has none.
std::vector<TimesToError> times_to_errors(const CompareSettings& settings,
                                          const std::vector<Rungs>& rungs);

// "strata needs 0.61x the time of owen for FLIP 0.03, 95 % interval 0.58-0.66; ...". Samplers whose
// interval holds 1 are listed as no difference shown. Empty where nothing can be said.
std::string time_sentence(const TimesToError& times, const CompareSettings& settings);

nlohmann::ordered_json times_to_errors_json(const CompareSettings& settings,
                                            const std::vector<Rungs>& rungs);

}  // namespace lockstep
