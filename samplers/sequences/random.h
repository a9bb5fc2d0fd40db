// Independent random numbers: plain Monte Carlo.
#pragma once

#include "samplers/fractions.h"
#include "samplers/sequence_info.h"

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

struct RandomSequence {
  static constexpr SequenceInfo info{"random", "independent random numbers",
                                     "Jarzynski and Olano 2020, Hash Functions for GPU Rendering"};

  template <class U>
  LOCKSTEP_INLINE static Fractions<U> point(const SamplerState& s, U pixel, U sample, int pair) {
    return random_fractions(pixel, sample, pair, s.seed, Stream::Sequence);
  }
};

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
