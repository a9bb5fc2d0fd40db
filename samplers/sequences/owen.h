// The first two dimensions of Sobol's sequence, Owen-scrambled and with shuffled order, padded into
// as many 2-D pairs as a path needs.
#pragma once

#include "samplers/sequence_info.h"
#include "samplers/sobol.h"

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

struct OwenSequence {
  static constexpr SequenceInfo info{"owen", "Owen-scrambled Sobol points, padded in pairs",
                                     "Burley 2020, Practical Hash-based Owen Scrambling"};

  template <class U>
  LOCKSTEP_INLINE static Fractions<U> point(const SamplerState& s, U pixel, U sample, int pair) {
    const Hash4<U> keys = pixel_keys(pixel, pair, s.seed);
    return scrambled_sobol(shuffled_index(sample, keys.z), keys.x, keys.y);
  }
};

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
