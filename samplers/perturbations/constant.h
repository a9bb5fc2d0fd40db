// A random offset for each pixel and pair, the same for all samples.
#pragma once

#include "samplers/fractions.h"
#include "samplers/sequence_info.h"

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

struct ConstantOffset {
  static constexpr PerturbationInfo info{
      "constant", "random, one for each pixel",
      "Cranley and Patterson 1976, Randomization of Number Theoretic Methods"};

  template <class U>
  LOCKSTEP_INLINE static Fractions<U> offset(const SamplerState& s, U pixel, U, int pair) {
    return random_fractions(pixel, U(0u), pair, s.seed, Stream::Offset);
  }
};

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
