// Multiples of a constant of the plane: each point is the one before plus (1/g, 1/g^2), mod 1,
// where g^3 = g + 1 (Roberts 2018, "The Unreasonable Effectiveness of Quasirandom Sequences");
// shifted for each pixel (Cranley and Patterson 1976).
#pragma once

#include "samplers/sequence_info.h"
#include "samplers/sobol.h"

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

struct GoldenSequence {
  static constexpr SequenceInfo info{"golden", "multiples of the plane's golden ratio",
                                     "Roberts 2018, Unreasonable Effectiveness"};

  // 1/g and 1/g^2 as 32-bit fractions.
  static constexpr std::uint32_t step_x = 3242174889u, step_y = 2447445413u;

  // Every pair of dimensions goes through the points in an order of its own: pairs in step with
  // each other would never fill their common space.
  template <class U>
  LOCKSTEP_INLINE static Fractions<U> point(const SamplerState& s, U pixel, U sample, int pair) {
    const Hash4<U> keys = pixel_keys(pixel, pair, s.seed);
    const U index = shuffled_index(sample, keys.z);
    return {index * U(step_x) + keys.x, index * U(step_y) + keys.y};
  }
};

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
