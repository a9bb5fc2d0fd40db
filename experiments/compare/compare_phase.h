// One scene at one depth of a comparison: its reference, then the renders that are measured.
#pragma once

#include "core/scene.h"
#include "experiments/compare/compare.h"
#include "experiments/compare/errors_csv.h"
#include "experiments/compare/journal.h"
#include "experiments/metrics/metrics.h"

#include <chrono>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <tuple>

namespace lockstep {

struct Phase {
  const CompareSettings& settings;
  SceneComparison& result;  // described already
  const Scene& scene;
  RenderSettings render_settings;  // with the depth
  Journal& journal;
  ErrorsCsv& csv;
  // Work in samples per pixel; false asks to stop.
  std::function<bool(double work, std::string_view label)> progress;

  std::string conditions = {};                              // see conditions_of() in the source
  std::optional<PreparedReference> reference = {};          // of the result's reference
  std::set<std::tuple<int, std::uint32_t, int>> done = {};  // sampler, seed, spp
};

// Takes over what the journal has of this scene and depth, and measures the rest. `reference_work`
// is the work that the reference takes. Returns false where the time ran out before all seeds were
// rendered. Throws Error, and Cancelled where it was asked to stop.
bool run_phase(Phase& phase, double reference_work, std::chrono::steady_clock::time_point deadline);

// Work of all samplers and rungs for one seed.
double work_per_seed(const CompareSettings& settings);

}  // namespace lockstep
