// Added sequences and perturbations (added.h) as kernels call them: through a pointer, a packet at
// a time.
#pragma once

#include "samplers/fractions.h"
#include "samplers/perturbations.h"
#include "samplers/sequences.h"

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

template <class U>
LOCKSTEP_INLINE Fractions<U> added_fractions(PointsFunction points, const SamplerState& s, U pixel,
                                             U sample, int pair) {
  constexpr int lanes = width_of<U>;
  std::uint32_t pixels[lanes], samples[lanes], x[lanes], y[lanes];
  store(pixels, pixel);
  store(samples, sample);
  points(s, pixels, samples, lanes, pair, x, y);
  return {load<U>(x), load<U>(y)};
}

struct AddedSequence {
  template <class U>
  LOCKSTEP_INLINE static Fractions<U> point(const SamplerState& s, U pixel, U sample, int pair) {
    return added_fractions(s.added_points, s, pixel, sample, pair);
  }
};

struct AddedOffset {
  template <class U>
  LOCKSTEP_INLINE static Fractions<U> offset(const SamplerState& s, U pixel, U sample, int pair) {
    return added_fractions(s.added_offsets, s, pixel, sample, pair);
  }
};

// Calls f with a value of the type that the state names.
template <class F>
void visit_sequence(const SamplerState& state, const F& f) {
  if (state.added_points) return f(AddedSequence{});
  Sequences::visit(int(state.sequence), f);
}

template <class F>
void visit_perturbation(const SamplerState& state, const F& f) {
  if (state.added_offsets) return f(AddedOffset{});
  Perturbations::visit(int(state.perturbation), f);
}

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
