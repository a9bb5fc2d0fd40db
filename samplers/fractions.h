// Points of the unit square as 32-bit binary fractions: what sequences make and perturbations move.
// Adding them wraps, as (x + y) mod 1 should, and rounds nothing.
#pragma once

#include "core/hash.h"
#include "core/vec.h"

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

template <class U>
struct Fractions {
  U x, y;
};

// In [0, 1 - 2^-24].
template <class U>
LOCKSTEP_INLINE Vec2<FloatOf<U>> unit_floats(const Fractions<U>& f) {
  return {unit_float(f.x), unit_float(f.y)};
}

// Of a value in [0, 1); rounding may have made it 1, which is not a fraction.
template <class V>
LOCKSTEP_INLINE auto fraction_of(V x) {
  return as_uint(to_int(min(x, V(one_minus_epsilon)) * V(0x1p30f))) << 2;
}

// w times the fraction, for w in [0, 1]; to 24 bits.
template <class U>
LOCKSTEP_INLINE U scaled(FloatOf<U> w, U fraction) {
  return as_uint(to_int(w * unit_float(fraction) * FloatOf<U>(0x1p30f))) << 2;
}

// Keys of streams that must be independent of each other, though pixel, sample and pair agree.
enum class Stream : std::uint32_t { Sequence = 0x5e9u, Offset = 0x0ff5e7u, Jitter = 0x1b4a3u };

// Independent fractions: a hash of all that they are for.
template <class U>
LOCKSTEP_INLINE Fractions<U> random_fractions(U pixel, U sample, int pair, std::uint32_t seed,
                                              Stream stream) {
  const U purpose(std::uint32_t(pair) | std::uint32_t(stream) << 12);
  const Hash4<U> h = pcg4d(pixel, sample, purpose, U(seed));
  return {h.x, h.y};
}

// The lower bits of a hash's words depend on little; scrambles use them first.
template <class U>
LOCKSTEP_INLINE U folded(U h) {
  return h ^ (h >> 16);
}

// Keys of one pixel's randomisation of a pair, for all of its samples.
template <class U>
LOCKSTEP_INLINE Hash4<U> pixel_keys(U pixel, int pair, std::uint32_t seed) {
  const Hash4<U> keys = pcg4d(pixel, U(std::uint32_t(pair)), U(seed), U(0x50b01u));
  return {folded(keys.x), folded(keys.y), folded(keys.z), folded(keys.w)};
}

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
