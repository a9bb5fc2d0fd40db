// What a comparison says in words: who loses to independent sampling at equal time, who is best.
#pragma once

#include "experiments/equal_time.h"

#include <nlohmann/json.hpp>

#include <vector>

namespace lockstep {

// The verdict on one scene at its depth, by FLIP: an object with the sentence and what it says.
// Samplers are judged at the times that all of them cover or, where there are none, at those that
// each has in common with `random`. A difference is claimed only where the 95 % interval of the
// ratio excludes 1. `rungs` has the runs of each sampler. Null where there is one sampler alone.
nlohmann::ordered_json verdict_json(const SceneComparison& scene,
                                    const std::vector<SamplerSpec>& samplers,
                                    const std::vector<Rungs>& rungs);

}  // namespace lockstep
