// One scene at one depth of a comparison: its reference, then the renders that are measured.
#pragma once

#include "core/scene.h"
#include "experiments/compare/compare.h"
#include "experiments/compare/journal.h"
#include "experiments/compare/reference.h"
#include "experiments/metrics/metrics.h"

#include <chrono>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

namespace lockstep {

struct Phase {
  const CompareSettings& settings;
  SceneComparison& result;         // described already
  const Scene* scene;              // null where nothing is to be rendered
  RenderSettings render_settings;  // with the depth
  // What is known of all scenes; a journal's line is one of this file.
  const std::vector<JournalEntry>& earlier;
  std::string journal_path;
  std::function<void(const JournalEntry&)> record;  // keeps what was measured
  // Work in samples per pixel; false asks to stop.
  std::function<bool(double work, std::string_view label)> progress;

  RenderHalf render_half = {};                              // see reference.h
  std::string conditions = {};                              // see conditions_of() in the source
  std::optional<PreparedReference> reference = {};          // of the result's reference
  std::set<std::tuple<int, std::uint32_t, int>> done = {};  // sampler, seed, spp
};

// A sampler's renders at one sample count, whose times spread too far.
struct UnsteadyRung {
  int sampler = 0;
  int spp = 0;
};

// Makes or reads the reference and whatever follows from it, but writes none of its images.
void open_phase(Phase& phase, double reference_work);

// Writes the reference as people see it.
void show_reference(Phase& phase);

// Takes over what the entries have of this scene and depth. Renders that are paired, those of one
// seed, are taken from one kind of CPU alone: the one that has them all, or this process's.
void restore(Phase& phase);

// True where nothing is left to be rendered but for its time.
bool all_done(const Phase& phase);

// First renders touch memory and code for the first time: they are made and thrown away.
void warm_up(Phase& phase, double work);

// Renders what is not done of a seed. Throws Cancelled where it was asked to stop.
void measure_seed(Phase& phase, int seed, double work);

std::vector<UnsteadyRung> unsteady_rungs(const SceneComparison& scene,
                                         const CompareSettings& settings);

// Rounds of repeats that the result holds, and how many there may be.
int repeats_so_far(const SceneComparison& scene);
int most_repeats(const CompareSettings& settings);

// Renders again for their times alone.
void repeat_round(Phase& phase, int round, const std::vector<UnsteadyRung>& unsteady, double work);

// The sampler's place in the settings, or -1.
int place_of(const CompareSettings& settings, const std::string& sampler);

// Takes over what the journal has of this scene and depth, and measures the rest. `reference_work`
// is the work that the reference takes. Returns false where the time ran out before all seeds were
// rendered. Throws Error, and Cancelled where it was asked to stop.
bool run_phase(Phase& phase, double reference_work, std::chrono::steady_clock::time_point deadline);

// Work of all samplers and rungs for one seed.
double work_per_seed(const CompareSettings& settings);

}  // namespace lockstep
