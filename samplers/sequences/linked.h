// Owen-scrambled Sobol pairs of which the first three are stratified together: pixel, light and
// first bounce. Later pairs are padded, as owen's are.
//
// Padding shuffles the order of each pair by itself, so that the pairing of their strata is random:
// an error of every pixel's own where each has its own shuffle, but one that all pixels have where
// they share it. Here the index of a pair goes through a matrix over bits, upper triangular, so
// that each pair stays a (0, 2)-sequence. The matrices were searched for, a column at a time: of
// the elementary intervals of 2^m points in four dimensions (six for the third pair), those in two
// and three of them counting for more, as many as possible hold one point.
#pragma once

#include "samplers/sequence_info.h"
#include "samplers/sobol.h"

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

struct LinkedSequence {
  static constexpr SequenceInfo info{"linked", "Owen-scrambled Sobol pairs, the first three linked",
                                     "see docs/samplers.md"};

  static constexpr int linked_pairs = 3;
  static constexpr int columns = 10;  // further ones are the identity's
  static constexpr std::uint32_t matrices[linked_pairs][columns] = {
      {0x1, 0x2, 0x4, 0x8, 0x10, 0x20, 0x40, 0x80, 0x100, 0x200},
      {0x1, 0x3, 0x4, 0xd, 0x11, 0x32, 0x57, 0xc9, 0x1f6, 0x2dd},
      {0x1, 0x2, 0x6, 0xf, 0x1a, 0x21, 0x72, 0x9e, 0x12a, 0x2a4}};

  LOCKSTEP_INLINE static std::uint32_t linked_index(std::uint32_t sample, int pair) {
    std::uint32_t index = sample;
    for (int bit = 0; bit < columns; ++bit) {
      if (sample >> bit & 1u) index ^= matrices[pair][bit] ^ 1u << bit;
    }
    return index;
  }

  LOCKSTEP_INLINE static Fractions<std::uint32_t> prepare(const SamplerState&, std::uint32_t sample,
                                                          int pair) {
    return {pair < linked_pairs ? linked_index(sample, pair) : sample, 0};
  }

  template <class U>
  LOCKSTEP_INLINE static Fractions<U> point(const SamplerState& s, U pixel, Fractions<U> prepared,
                                            int pair) {
    const Hash4<U> keys = pixel_keys(pixel, pair, s.seed);
    if (pair >= linked_pairs) {
      return scrambled_sobol(shuffled_index(prepared.x, keys.z), keys.x, keys.y);
    }
    return digit_shifted(scrambled_sobol(prepared.x, keys.x, keys.y), keys.z, keys.w);
  }
};

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
