// Which traversal mode is fastest, measured while rendering. Coherent or not, packets or streams:
// no choice is best for every scene, sampler and bounce, and none changes what rays hit.
#pragma once

#include "packets/measured_choice.h"
#include "packets/traversal_mode.h"

#include <optional>
#include <vector>

namespace lockstep {

struct TraversalPlan {
  TraversalMode mode;
  std::optional<TraversalMode> trial;  // to trace every other part with
};

// A choice for each kind of ray and bounce. One object per thread.
class TraversalPolicy {
 public:
  // Uses `fixed` for everything if given; else begins with packets of `width` lanes.
  TraversalPolicy(std::optional<TraversalMode> fixed, int width);

  // For a queue of `rays` rays. Bounce counts interactions before the rays, from 0.
  TraversalPlan plan(RayKind kind, int bounce, int rays);

  // The time per ray of a trial over that of the plan's mode.
  void record(RayKind kind, int bounce, TraversalMode trial, double ratio);

 private:
  static constexpr int bounces = 8;  // told apart

  MeasuredChoice& choice(RayKind kind, int bounce);

  std::optional<TraversalMode> fixed_;
  std::vector<MeasuredChoice> choices_;  // closest hits by bounce, then shadow rays
};

}  // namespace lockstep
