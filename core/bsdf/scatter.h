// What models with mirror-like or transparent lanes say of a sample beyond BsdfSample.
//
// Such models return a ScatterSample, which converts to BsdfSample; callers ask is_delta() and
// radiance_scale() of either, so that models without such lanes stay as they are.
//   Smooth lobes are Dirac distributions: eval() gives 0 for them, and sample() marks the lane as
// delta. Its pdf is then the probability with which the direction was chosen from a discrete set,
// no density: light sampling cannot find that direction, and emission found along it counts in
// full. (An infinite density says the same to the power heuristic.)
//   Transparent models take wo and wi on both sides of the surface, told apart by the sign of z.
#pragma once

#include "core/bsdf.h"
#include "core/microfacet.h"

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

template <class V>
struct ScatterSample : BsdfSample<V> {
  MaskOf<V> delta;
  V scale;  // of radiance where light was refracted, 1 / eta^2, already in `weight`; elsewhere 1
};

template <class V>
LOCKSTEP_INLINE MaskOf<V> is_delta(const BsdfSample<V>&) {
  return MaskOf<V>(false);
}
template <class V>
LOCKSTEP_INLINE MaskOf<V> is_delta(const ScatterSample<V>& s) {
  return s.delta;
}

// Russian roulette divides it out: what refraction takes on the way in comes back on the way out.
template <class V>
LOCKSTEP_INLINE V radiance_scale(const BsdfSample<V>&) {
  return V(1.0f);
}
template <class V>
LOCKSTEP_INLINE V radiance_scale(const ScatterSample<V>& s) {
  return s.scale;
}

// True for models that take wo and wi on both sides of the surface.
template <class Bsdf>
inline constexpr bool transmits = false;

template <class V>
LOCKSTEP_INLINE MaskOf<V> is_smooth(const Ggx<V>& ggx) {
  return max(ggx.alpha.x, ggx.alpha.y) < V(smoothest_alpha);
}
template <class V>
LOCKSTEP_INLINE Ggx<V> at_least_smoothest(const Ggx<V>& ggx) {
  return {{max(ggx.alpha.x, V(smoothest_alpha)), max(ggx.alpha.y, V(smoothest_alpha))}};
}

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
