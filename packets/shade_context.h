// What the stages of a wave share while it goes through its bounces.
#pragma once

#include "packets/stage_clock.h"
#include "packets/wave.h"

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

// 1 / the weight of a technique with density `a` against one with density `b`, power heuristic,
// beta = 2.
template <class V>
LOCKSTEP_INLINE V inverse_power_heuristic(V a, V b) {
  const V ratio = b / a;
  return fma(ratio, ratio, V(1.0f));
}
template <class V>
LOCKSTEP_INLINE V power_heuristic(V a, V b) {
  return V(1.0f) / inverse_power_heuristic(a, b);
}

struct ShadeContext {
  const SceneData* scene;
  const TileJob* job;
  Wave* wave;
  StageClock* clock;
  int bounce;  // of this interaction, from 0
  bool last;   // no further interaction is lit

  const RayQueue& rays() const { return wave->rays[bounce & 1]; }
  RayQueue& next_rays() const { return wave->rays[(bounce + 1) & 1]; }
};

// General kernels share what all kinds of material need as functions; others have it inlined.
template <FeatureMask F>
inline constexpr bool is_general = F == all_features;

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
