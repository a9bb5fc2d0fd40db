// What a comparison says in words: who loses to independent sampling at equal time, who is best,
// how much sooner or later an error is reached, and what the figures do not bear.
#pragma once

#include "experiments/compare/equal_time.h"

#include <nlohmann/json.hpp>

#include <vector>

namespace lockstep {

// The verdict on one scene at its depth, by FLIP: an object with the sentences and what they say.
// Samplers are judged at the times that all of them cover or, where there are none, at those that
// each has in common with `random`. A difference is claimed only where the 95 % interval of the
// ratio excludes 1. Times that are not well known, and errors that may be the reference's, are
// named. `rungs` has the runs of each sampler. Null where there is one sampler alone.
nlohmann::ordered_json verdict_json(const SceneComparison& scene, const CompareSettings& settings,
                                    const std::vector<Rungs>& rungs);

}  // namespace lockstep
