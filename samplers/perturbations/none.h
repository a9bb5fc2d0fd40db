// No perturbation: pixels that share a sequence all have its points.
#pragma once

#include "samplers/fractions.h"
#include "samplers/sequence_info.h"

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

struct NoOffset {
  static constexpr PerturbationInfo info{"none", "none",
                                         "Sadeghi, Chen and Jensen 2009, Coherent Path Tracing"};

  template <class U>
  LOCKSTEP_INLINE static Fractions<U> offset(const SamplerState&, U, U, int) {
    return {U(0u), U(0u)};
  }
};

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
