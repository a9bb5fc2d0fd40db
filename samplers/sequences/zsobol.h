// One sequence dealt out to all pixels along a Z-order curve.
#pragma once

#include "samplers/sequence_info.h"
#include "samplers/z_order.h"

#include <bit>

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

struct ZSobolSequence {
  static constexpr SequenceInfo info{
      "zsobol", "Sobol points dealt out to pixels in Z-order",
      "Ahmed and Wonka 2020, Screen-Space Blue-Noise Diffusion of Monte Carlo Sampling Error",
      true};

  template <class U>
  LOCKSTEP_INLINE static Fractions<U> point(const SamplerState& s, U pixel, U sample, int pair) {
    return z_ordered_point(s, pixel, sample, std::bit_width(s.samples - 1), pair, s.seed);
  }
};

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
