// A new random offset for every sample: the stratification of the shared points is lost.
#pragma once

#include "samplers/fractions.h"
#include "samplers/sequence_info.h"

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

struct FreshOffset {
  static constexpr PerturbationInfo info{"fresh", "random, new for each sample",
                                         "Staal and Hachisuka, Randomized Coherent Sampling"};

  template <class U>
  LOCKSTEP_INLINE static Fractions<U> offset(const SamplerState& s, U pixel, U sample, int pair) {
    return random_fractions(pixel, sample, pair, s.seed, Stream::Offset);
  }
};

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
