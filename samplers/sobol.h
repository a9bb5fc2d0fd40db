// The first two dimensions of Sobol's sequence, a (0, 2)-sequence in base 2, Owen-scrambled by a
// hash (Burley 2020, "Practical Hash-based Owen Scrambling").
//
// Values are 32-bit binary fractions. Most of the work is done on their mirror image, where bit j
// is the j-th digit behind the point.
#pragma once

#include "core/simd_bits.h"
#include "samplers/fractions.h"

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

// Owen's nested uniform scramble of a mirrored fraction: each digit is flipped or not by a hash of
// the digits before it (Laine and Karras 2011, with the constants of Vegdahl 2021).
template <class U>
LOCKSTEP_INLINE U scramble_mirrored(U x, U key) {
  x ^= x * U(0x3d20adeau);
  x += key;
  x = x * ((key >> 16) | U(1u));
  x ^= x * U(0x05526c56u);
  x ^= x * U(0x53a22864u);
  return x;
}

// The mirrored second coordinate of Sobol point `index`. Its generator matrix is Pascal's triangle
// mod 2, a Kronecker power, so five shifts multiply by it (Ahmed 2024).
template <class U>
LOCKSTEP_INLINE U mirrored_second_coordinate(U index) {
  index ^= (index >> 1) & U(0x55555555u);
  index ^= (index >> 2) & U(0x33333333u);
  index ^= (index >> 4) & U(0x0f0f0f0fu);
  index ^= (index >> 8) & U(0x00ff00ffu);
  index ^= (index >> 16) & U(0x0000ffffu);
  return index;
}

// An order of the indices in which every aligned block of 2^m is one of the natural order.
template <class U>
LOCKSTEP_INLINE U shuffled_index(U index, U key) {
  return reverse_bits(scramble_mirrored(reverse_bits(index), key));
}

// A point moved by keys, so that each point is uniform by itself: for one number the hash above is
// not quite.
template <class U>
LOCKSTEP_INLINE Fractions<U> digit_shifted(const Fractions<U>& point, U key_x, U key_y) {
  return {point.x ^ key_x, point.y ^ key_y};
}

// Point `index`, each coordinate scrambled by its key. Every aligned block of 2^m indices is a
// (0, m, 2)-net.
template <class U>
LOCKSTEP_INLINE Fractions<U> scrambled_sobol(U index, U key_x, U key_y) {
  return {reverse_bits(scramble_mirrored(index, key_x)),
          reverse_bits(scramble_mirrored(mirrored_second_coordinate(index), key_y))};
}

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
