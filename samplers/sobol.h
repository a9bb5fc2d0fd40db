// The first two dimensions of Sobol's sequence, a (0, 2)-sequence in base 2, Owen-scrambled by a
// hash and with shuffled order, for padding into as many 2-D pairs as a path needs
// (Burley 2020, "Practical Hash-based Owen Scrambling").
//
// Values are 32-bit binary fractions. Most of the work is done on their mirror image, where bit j
// is the j-th digit behind the point.
#pragma once

#include "core/hash.h"
#include "core/simd_bits.h"
#include "core/vec.h"

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

// Point `index` of the sequence that `keys` select: x and y key the coordinates' scrambles, z the
// order. Every aligned block of 2^m indices is a (0, m, 2)-net.
template <class U>
LOCKSTEP_INLINE Vec2<FloatOf<U>> owen_sobol(U index, const Hash3<U>& keys) {
  const U shuffled = reverse_bits(scramble_mirrored(reverse_bits(index), keys.z));
  const U x = reverse_bits(scramble_mirrored(shuffled, keys.x));
  const U y = reverse_bits(scramble_mirrored(mirrored_second_coordinate(shuffled), keys.y));
  return {unit_float(x), unit_float(y)};
}

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
