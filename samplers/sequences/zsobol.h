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

  static CommonDigits prepare_tile(const SamplerState& s, const SampleBatch& batch, int pair) {
    const int bits = std::bit_width(s.samples - 1);
    const std::uint32_t last = batch.first_sample + std::uint32_t(batch.samples) - 1;
    if (batch.first_sample >> bits != last >> bits) return {};
    return digits_of_tile(s, batch.pixel[0], batch.first_sample, bits, pair, s.seed);
  }
  template <class U>
  LOCKSTEP_INLINE static Fractions<U> point(const SamplerState& s, U pixel, U sample, int pair,
                                            const CommonDigits& common = {}) {
    return z_ordered_point(s, pixel, sample, std::bit_width(s.samples - 1), pair, s.seed, common);
  }
};

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
