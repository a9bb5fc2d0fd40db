// summary.json: what a comparison found, for scripts, the terminal's table and the report.
#pragma once

#include "experiments/compare/compare.h"

#include <nlohmann/json.hpp>

#include <string>

namespace lockstep {

// Per scene, sampler and sample count: median, mean and 5 - 95 % of every time and metric over the
// seeds, how well the time is known, metrics that are near the reference's own error, the mean
// spectrum of the error, and the runs themselves; per scene: errors at equal CPU time,
// interpolated, never extrapolated, with their ratio to the first sampler, the times that errors
// take (time_to_error.h), and the verdict in words (verdict.h).
nlohmann::ordered_json summarize(const Comparison& comparison);

// The equal-time results as lines of text; where no time is common to all samplers, the medians
// at each sample count. Below, the verdicts.
std::string results_table(const nlohmann::ordered_json& summary);

}  // namespace lockstep
