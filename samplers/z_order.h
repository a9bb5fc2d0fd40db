// Sobol's points dealt out to pixels along a Z-order curve, so that the points of neighbouring
// pixels are stratified together, which makes their errors cancel (Ahmed and Wonka 2020,
// "Screen-Space Blue-Noise Diffusion of Monte Carlo Sampling Error via Hierarchical Ordering of
// Pixels").
#pragma once

#include "samplers/pixel_position.h"
#include "samplers/sobol.h"

#include <algorithm>
#include <bit>

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

// What the places of a tile's samples have in common: upper bits of the index, and the keys.
struct CommonDigits {
  std::uint32_t above = 0;   // the index's own bits, shifted down
  std::uint32_t result = 0;  // permuted, in place
  int bits = 0;
  bool has_keys = false;
  Hash4<std::uint32_t> keys{};
};

// A random order of the four children of every node of the curve's quadtree, and of the samples
// below: the base-4 digits of `index`, each permuted by a hash of those before it, from the one
// below `common` down to `shift` = `end`. With an odd number of bits the last digit is binary.
template <class U>
LOCKSTEP_INLINE U permuted_digits(U index, int bits, U key, const CommonDigits& common = {},
                                  int end = 0) {
  U result(common.result), above(common.above);
  for (int shift = bits - common.bits - 2; shift >= end - 1; shift -= 2) {
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

// A sample's place before permutation, and what makes its order and its points random.
template <class U>
struct ZOrder {
  U index;
  Hash4<U> keys;
  int bits;  // of the index
};

// Sample k of 2^sample_bits; further ones have other keys.
template <class U>
LOCKSTEP_INLINE ZOrder<U> z_order(const SamplerState& s, U pixel, U sample, int sample_bits,
                                  int pair, std::uint32_t seed, const CommonDigits& common = {}) {
  const PixelPosition<U> p = position_of(pixel, s.width);
  // What the index has no room for makes blocks of pixels that know nothing of each other.
  const int pixel_bits = std::min(s.pixel_bits, (32 - sample_bits) / 2);
  const U block = ((p.y >> pixel_bits) << 16) | (p.x >> pixel_bits);
  const U mask((1u << pixel_bits) - 1u);
  const U code = morton_code(PixelPosition<U>{p.x & mask, p.y & mask});
  const U index = (code << sample_bits) | (sample & U((1u << sample_bits) - 1u));
  const int bits = 2 * pixel_bits + sample_bits;
  if (common.has_keys) {
    const Hash4<std::uint32_t>& k = common.keys;
    return {index, {U(k.x), U(k.y), U(k.z), U(k.w)}, bits};
  }
  return {index, pcg4d(U(std::uint32_t(pair)), block, sample >> sample_bits, U(seed ^ 0x20b01u)),
          bits};
}

// What all pixels of the tile of share_tile x share_tile around `pixel` have in common, for samples
// that agree but for their last `sample_bits` bits.
inline CommonDigits digits_of_tile(const SamplerState& s, std::uint32_t pixel, std::uint32_t sample,
                                   int sample_bits, int pair, std::uint32_t seed) {
  const ZOrder<std::uint32_t> z = z_order(s, pixel, sample, sample_bits, pair, seed);
  const int own = 2 * std::countr_zero(unsigned(share_tile)) + sample_bits;
  if (z.bits < own) return {};  // tiles of several blocks of pixels
  if (z.bits == own) return {0, 0, 0, true, z.keys};
  return {z.index >> own, permuted_digits(z.index, z.bits, z.keys.x, {}, own), z.bits - own, true,
          z.keys};
}

// The point of the pixel's sample.
template <class U>
LOCKSTEP_INLINE Fractions<U> z_ordered_point(const SamplerState& s, U pixel, U sample,
                                             int sample_bits, int pair, std::uint32_t seed,
                                             const CommonDigits& common = {}) {
  const ZOrder<U> z = z_order(s, pixel, sample, sample_bits, pair, seed, common);
  const U place = permuted_digits(z.index, z.bits, z.keys.x, common);
  return scrambled_sobol(place, folded(z.keys.y), folded(z.keys.z));
}

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
