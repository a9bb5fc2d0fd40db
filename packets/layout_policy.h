// Which lane layout renders fastest, measured while rendering: half of a tile's samples in one
// layout, half in another. The image does not depend on it.
#pragma once

#include "packets/lane_layout.h"
#include "packets/measured_choice.h"

#include <cstdint>
#include <optional>

namespace lockstep {

struct LayoutPlan {
  LaneLayout lanes;
  std::optional<LaneLayout> trial;  // for half of the samples
  bool trial_first = false;         // in turn: the first half brings the tile's geometry into cache
};

// One object per thread.
class LayoutPolicy {
 public:
  // Uses `fixed` always if given; else begins with 4x4x1.
  explicit LayoutPolicy(std::optional<LaneLayout> fixed);

  // For a tile of `samples` samples per pixel; fewer than 32 are too few for a trial.
  LayoutPlan plan(std::uint32_t samples);

  // What a path took in the trial's layout, and in the plan's.
  void record(double trial_time, double plan_time);

 private:
  std::optional<LaneLayout> fixed_;
  MeasuredChoice choice_;
  int trying_ = 0;
  double first_trial_time_ = 0.0, first_plan_time_ = 0.0;  // of a pair of trials, one in each order
  bool half_done_ = false;
};

}  // namespace lockstep
