// Progressive multi-jittered (0, 2) points from tables, XOR-ed with keys of the pixel's.
#pragma once

#include "samplers/index_shuffle.h"
#include "samplers/pmj02_table.h"
#include "samplers/sequence_info.h"

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

struct Pmj02Sequence {
  static constexpr SequenceInfo info{
      "pmj02", "progressive multi-jittered (0,2) points from tables",
      "Christensen, Kensler and Kilpatrick 2018, Progressive Multi-Jittered Sample Sequences",
      false, pmj02_table};

  // The first pairs have a table each; the others share them, in an order of their own that keeps
  // every first 2^m points together. Samples behind a table's end begin again with other keys.
  LOCKSTEP_INLINE static Fractions<std::uint32_t> prepare(const SamplerState& s,
                                                          std::uint32_t sample, int pair) {
    const std::uint32_t block = sample / pmj02_points;
    const std::uint32_t table = (std::uint32_t(pair) + block) % pmj02_tables;
    std::uint32_t place = sample % pmj02_points;
    const bool again = std::uint32_t(pair) >= pmj02_tables || block > 0;
    const std::uint32_t purpose = std::uint32_t(pair) | block << 12;
    if (again && place > 1) {
      const int bits = std::bit_width(place) - 1;
      const std::uint32_t first = 1u << bits;
      place = first | mix_index(place ^ first, first - 1u, bits, pcg3d(s.seed, purpose, first).x);
    }
    const std::uint32_t* point = s.table + 2 * (table * pmj02_points + place);
    if (!again) return {point[0], point[1]};
    const Hash3<std::uint32_t> keys = pcg3d(s.seed, purpose, 0x02u);
    return {point[0] ^ keys.x, point[1] ^ keys.y};
  }

  template <class U>
  LOCKSTEP_INLINE static Fractions<U> point(const SamplerState& s, U pixel, Fractions<U> prepared,
                                            int pair) {
    const Hash3<U> keys = pixel_keys(pixel, pair, s.seed);
    return {prepared.x ^ keys.x, prepared.y ^ keys.y};
  }
};

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
