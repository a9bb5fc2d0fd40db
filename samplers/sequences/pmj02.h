// Progressive multi-jittered (0, 2) points from tables, XOR-ed with keys of the pixel's.
#pragma once

#include "samplers/fractions.h"
#include "samplers/pmj02_table.h"
#include "samplers/sequence_info.h"
#include "samplers/sequences/owen.h"

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

struct Pmj02Sequence {
  static constexpr SequenceInfo info{
      "pmj02", "progressive multi-jittered (0,2) points from tables",
      "Christensen, Kensler and Kilpatrick 2018, Progressive Multi-Jittered Sample Sequences",
      false, pmj02_table};

  // Points [2^m, 2^(m + 1)) in another order among themselves. All tables go through the quarters
  // of the square in much the same order, in which pairs would follow each other.
  template <class U>
  LOCKSTEP_INLINE static U reordered(U index, U key) {
    U below = index | (index >> 1);
    below |= below >> 2;
    below |= below >> 4;
    below |= below >> 8;
    below = below >> 1;  // 2^m - 1
    return index ^ ((index ^ shuffled_index(index, key)) & below);
  }

  // The first pairs of a pixel read different tables, and which differs from pixel to pixel: with
  // one order of tables for all, the pairing of their strata would be an error that all pixels
  // have. Further pairs are owen's. Samples behind a table's end begin again with other keys.
  template <class U>
  LOCKSTEP_INLINE static Fractions<U> point(const SamplerState& s, U pixel, U sample, int pair) {
    static_assert(pmj02_tables == 16 && pmj02_points == 4096);
    if (pair >= int(pmj02_tables)) return OwenSequence::point(s, pixel, sample, pair);
    const U id = pixel ^ ((sample >> 12) * U(0x9e3779b9u));
    const Hash3<U> order = pcg3d(id, U(0x9302u), U(s.seed));
    const U table = ((folded(order.x) | U(1u)) * U(std::uint32_t(pair)) + folded(order.y)) &
                    U(pmj02_tables - 1);
    const Hash4<U> keys = pixel_keys(id, pair, s.seed);
    const U place = reordered(sample & U(pmj02_points - 1), keys.z);
    const auto at = as_int((table << 13) | (place << 1));
    return {gather(s.table, at) ^ keys.x, gather(s.table + 1, at) ^ keys.y};
  }
};

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
