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
  std::optional<TraversalMode> trial;  // for some of the rays, timed beside as many in `mode`
  bool trial_first = false;            // of the two
};

// What a queue of rays is like.
struct QueueClass {
  RayKind kind = RayKind::Camera;
  int bounce = 0;  // interactions before the rays
  int spread = 0;  // of neighbours' directions, from 0, almost parallel, to spreads - 1
};
inline constexpr int spreads = 4;

// `cosine`: the length of the mean of neighbours' directions, typically.
int spread_class(float cosine);

// A choice for each class of queues. One object per thread.
class TraversalPolicy {
 public:
  // Uses `fixed` for everything if given; else begins with packets of `width` lanes, and below 16
  // lanes with streams for shadow rays that spread.
  TraversalPolicy(std::optional<TraversalMode> fixed, int width);

  TraversalPlan plan(const QueueClass& queue, int rays);

  // What a ray took in the trial's mode, and in the plan's.
  void record(const QueueClass& queue, TraversalMode trial, double trial_time, double plan_time);

 private:
  static constexpr int bounces = 8;  // told apart

  MeasuredChoice& choice(const QueueClass& queue);

  std::optional<TraversalMode> fixed_;
  std::vector<MeasuredChoice> choices_;
};

}  // namespace lockstep
