// Sobol's sequence in all its dimensions, each Owen-scrambled by a key of the pixel's. Unlike
// padded pairs it is stratified in other projections too, as far as its direction numbers go.
#pragma once

#include "samplers/joe_kuo.h"
#include "samplers/sequence_info.h"
#include "samplers/sobol.h"

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

struct SobolSequence {
  static constexpr SequenceInfo info{
      "sobol", "Owen-scrambled Sobol points in all dimensions",
      "Joe and Kuo 2008, Constructing Sobol Sequences with Better Two-Dimensional Projections",
      false, joe_kuo_matrices};

  // The mirrored coordinates before scrambling. Beyond the table the dimensions begin again, with
  // another order of the samples.
  LOCKSTEP_INLINE static Fractions<std::uint32_t> prepare(const SamplerState& s,
                                                          std::uint32_t sample, int pair) {
    const int again = pair / (joe_kuo_dimensions / 2);
    if (again > 0) sample = shuffled_index(sample, pcg3d(s.seed, std::uint32_t(again), 0x50b01u).x);
    const std::uint32_t* columns = s.table + pair % (joe_kuo_dimensions / 2) * 64;
    Fractions<std::uint32_t> point{0, 0};
    for (; sample != 0; sample &= sample - 1) {
      const int bit = std::countr_zero(sample);
      point.x ^= columns[bit];
      point.y ^= columns[32 + bit];
    }
    return point;
  }

  template <class U>
  LOCKSTEP_INLINE static Fractions<U> point(const SamplerState& s, U pixel, Fractions<U> prepared,
                                            int pair) {
    const Hash4<U> keys = pixel_keys(pixel, pair, s.seed);
    const Fractions<U> scrambled{reverse_bits(scramble_mirrored(prepared.x, keys.x)),
                                 reverse_bits(scramble_mirrored(prepared.y, keys.y))};
    return digit_shifted(scrambled, keys.z, keys.w);
  }
};

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
