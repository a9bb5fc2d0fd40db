// Random orders of a range of indices, without storing them.
#pragma once

#include "samplers/fractions.h"

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

// A permutation of [0, 2^bits): steps that can each be undone (Kensler 2013, section "Hashing").
template <class U>
LOCKSTEP_INLINE U mix_index(U i, U mask, int bits, U key) {
  i = (i ^ key) & mask;
  i = (i * U(0xe170893du)) & mask;
  i = i ^ (key >> 16);
  i = (i ^ ((i & mask) >> (bits / 2 + 1))) & mask;
  i = (i * U(0x0929eb3fu)) & mask;
  i = i ^ ((key >> 7) & mask);
  i = (i ^ (i >> (bits / 2 + 1))) & mask;
  i = (i * (key | U(1u))) & mask;
  i = (i ^ (i >> (bits / 2 + 1))) & mask;
  i = (i * U(0x6935fa69u)) & mask;
  i = (i + (key >> 3)) & mask;
  return i;
}

// The place of `index`, both in [0, count), in an order that `key` selects: the permutation of the
// next power of two, followed until it is back in the range. For count up to 2^16.
template <class U>
LOCKSTEP_INLINE U permuted_index(U index, std::uint32_t count, U key) {
  const int bits = std::bit_width(count - 1);
  const U mask((1u << bits) - 1u);
  const auto end = as_int(U(count));
  // Lanes behind the last path may hold anything, and a cycle outside the range never enters it.
  U i = select(as_int(index & mask) < end, index & mask, U(0u));
  i = mix_index(i, mask, bits, key);
  auto outside = as_int(i) >= end;
  while (any(outside)) {
    i = select(outside, mix_index(i, mask, bits, key), i);
    outside = as_int(i) >= end;
  }
  return i;
}

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
