// Halton's sequence, its digits permuted at random, shifted for each pixel.
#pragma once

#include "samplers/primes.h"
#include "samplers/sequence_info.h"
#include "samplers/sobol.h"

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

struct HaltonSequence {
  static constexpr SequenceInfo info{
      "halton", "Halton points with random digits, shifted for each pixel",
      "Halton 1960; Wang and Hickernell 2000, Randomized Halton Sequences", false, halton_primes};

  // The digits of `i` behind the point in reverse, each replaced by a random linear function of it
  // and, as `i` has infinitely many zeros in front, followed by as many as 32 bits hold.
  LOCKSTEP_INLINE static std::uint32_t radical_inverse(std::uint32_t i, std::uint32_t base,
                                                       std::uint32_t key) {
    const std::uint32_t factor = 1 + key % (base - 1);
    std::uint64_t digits = 0, scale = 1;
    for (std::uint32_t place = 0; scale < (std::uint64_t(1) << 32); ++place, i /= base) {
      const std::uint32_t shift = pcg3d(key, place, base).x % base;
      digits = digits * base + (std::uint64_t(i % base) * factor + shift) % base;
      scale *= base;
    }
    // digits / scale, scale < 2^32 * 2^13.
    return std::uint32_t(double(digits) / double(scale) * 0x1p32);
  }

  LOCKSTEP_INLINE static Fractions<std::uint32_t> prepare(const SamplerState& s,
                                                          std::uint32_t sample, int pair) {
    const int again = pair / (halton_dimensions / 2), first = 2 * (pair % (halton_dimensions / 2));
    const Hash3<std::uint32_t> keys = pcg3d(s.seed, std::uint32_t(pair), 0x4a17u);
    if (again > 0) sample = shuffled_index(sample, keys.z);
    return {radical_inverse(sample, s.table[first], keys.x),
            radical_inverse(sample, s.table[first + 1], keys.y)};
  }

  template <class U>
  LOCKSTEP_INLINE static Fractions<U> point(const SamplerState& s, U pixel, Fractions<U> prepared,
                                            int pair) {
    const Hash4<U> keys = pixel_keys(pixel, pair, s.seed);
    return {prepared.x + keys.x, prepared.y + keys.y};
  }
};

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
