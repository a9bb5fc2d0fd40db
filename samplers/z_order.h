// Sobol's points dealt out to pixels along a Z-order curve, so that the points of neighbouring
// pixels are stratified together, which makes their errors cancel (Ahmed and Wonka 2020,
// "Screen-Space Blue-Noise Diffusion of Monte Carlo Sampling Error via Hierarchical Ordering of
// Pixels").
#pragma once

#include "samplers/pixel_position.h"
#include "samplers/sobol.h"

#include <algorithm>

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

// A permutation of the digits 0...3 that `hash` selects, all of the 24 alike: they are the affine
// maps of the field of four elements and its one automorphism.
template <class U>
LOCKSTEP_INLINE U permuted_digit(U digit, U hash) {
  const U high = digit >> 1, low = digit & U(1u);
  const U times_a = ((high ^ low) << 1) | high, times_b = (low << 1) | (high ^ low);
  const auto third = as_int((hash & U(0xffffu)) * U(3u) >> 16);
  using I = decltype(as_int(digit));
  U product = select(third == I(0), digit, select(third == I(1), times_a, times_b));
  product ^= (product >> 1) & (hash >> 16) & U(1u);
  return product ^ ((hash >> 17) & U(3u));
}

// A random order of the four children of every node of the curve's quadtree, and of the samples
// below: the base-4 digits of `index`, each permuted by a hash of those before it. With an odd
// number of bits the last digit is binary.
template <class U>
LOCKSTEP_INLINE U permuted_digits(U index, int bits, U key) {
  U result(0u), above(0u);
  for (int shift = bits - 2; shift >= -1; shift -= 2) {
    U h = (above + U(std::uint32_t(shift + 2) * 0x9e3779b9u)) ^ key;
    h = h * U(0x7feb352du);
    h = (h ^ (h >> 15)) * U(0x846ca68bu);
    h ^= h >> 16;
    if (shift < 0) return result | ((index ^ (h >> 16)) & U(1u));
    result = result | (permuted_digit((index >> shift) & U(3u), h) << shift);
    above = index >> shift;
  }
  return result;
}

// The point of the pixel's sample: sample k of 2^sample_bits, further ones with other keys.
template <class U>
LOCKSTEP_INLINE Fractions<U> z_ordered_point(const SamplerState& s, U pixel, U sample,
                                             int sample_bits, int pair, std::uint32_t seed) {
  const PixelPosition<U> p = position_of(pixel, s.width);
  // What the index has no room for makes tiles that know nothing of each other.
  const int pixel_bits = std::min(s.pixel_bits, (32 - sample_bits) / 2);
  const U tile = ((p.y >> pixel_bits) << 16) | (p.x >> pixel_bits);
  const U mask((1u << pixel_bits) - 1u);
  const U code = morton_code(PixelPosition<U>{p.x & mask, p.y & mask});
  const U index = (code << sample_bits) | (sample & U((1u << sample_bits) - 1u));
  const Hash4<U> keys =
      pcg4d(U(std::uint32_t(pair)), tile, sample >> sample_bits, U(seed ^ 0x20b01u));
  const U place = permuted_digits(index, 2 * pixel_bits + sample_bits, keys.x);
  return scrambled_sobol(place, folded(keys.y), folded(keys.z));
}

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
