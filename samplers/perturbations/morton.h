// An offset for each pixel, stratified along the Z-order curve: those of neighbouring pixels differ
// much, and those of every aligned block of pixels fill the unit square evenly.
#pragma once

#include "samplers/sequence_info.h"
#include "samplers/z_order.h"

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

struct MortonOffset {
  static constexpr PerturbationInfo info{
      "morton", "one for each pixel, stratified in Z-order",
      "after Ahmed and Wonka 2020, Screen-Space Blue-Noise Diffusion"};

  template <class U>
  LOCKSTEP_INLINE static Fractions<U> offset(const SamplerState& s, U pixel, U, int pair) {
    return z_ordered_point(s, pixel, U(0u), 0, pair, s.seed ^ std::uint32_t(Stream::Offset));
  }
};

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
