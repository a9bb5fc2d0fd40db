// One texel per lane, as linear red, green, blue and alpha.
#pragma once

#include "core/simd_rows.h"
#include "core/texture_data.h"

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

template <class V>
struct Rgba {
  V r, g, b, a;
};

// s x + y, channel by channel.
template <class V>
LOCKSTEP_INLINE Rgba<V> fma(V s, const Rgba<V>& x, const Rgba<V>& y) {
  return {fma(s, x.r, y.r), fma(s, x.g, y.g), fma(s, x.b, y.b), fma(s, x.a, y.a)};
}

// The float that the lower 16 bits hold as a half float; finite ones only. No step goes through a
// float below the normal range, which kernels flush to zero.
template <class U>
LOCKSTEP_INLINE FloatOf<U> float_from_half(U h) {
  using V = FloatOf<U>;
  const U magnitude = (h & U(0x7fffu)) << 13;
  const U rebiased = magnitude + U((127u - 15u) << 23);
  // Below 2^-14 the leading one that floats imply is not there: put it in, then take it away.
  const V small = as_float(rebiased + U(1u << 23)) - V(0x1p-14f);
  const V value = select(as_int(magnitude) < IntOf<U>(1 << 23), small, as_float(rebiased));
  return as_float(as_uint(value) | ((h & U(0x8000u)) << 16));
}

template <class U>
LOCKSTEP_INLINE FloatOf<U> fraction(U code, float largest) {
  return to_float(as_int(code)) * FloatOf<U>(1.0f / largest);
}

template <class I>
LOCKSTEP_INLINE Rgba<FloatOf<I>> byte_texel(const TexelData& t, I word) {
  using U = UIntOf<I>;
  const U texel = as_uint(gather(t.words, word));
  const U mask(255u);
  const U r = texel & mask, g = (texel >> 8) & mask, b = (texel >> 16) & mask;
  const auto a = fraction(texel >> 24, 255.0f);
  if (!t.decode) return {fraction(r, 255.0f), fraction(g, 255.0f), fraction(b, 255.0f), a};
  return {gather(t.decode, as_int(r)), gather(t.decode, as_int(g)), gather(t.decode, as_int(b)), a};
}

// The texel whose words start at `word`, which must be valid in every lane.
template <class I>
LOCKSTEP_INLINE Rgba<FloatOf<I>> load_texel(const TexelData& t, I word) {
  using U = UIntOf<I>;
  if (t.format == TexelFormat::Byte) return byte_texel(t, word);
  const auto row = gather_rows(t.words, word);
  const U x = as_uint(row.x), y = as_uint(row.y), low(0xffffu);
  switch (t.format) {
    case TexelFormat::Short:
      return {fraction(x & low, 65535.0f), fraction(x >> 16, 65535.0f), fraction(y & low, 65535.0f),
              fraction(y >> 16, 65535.0f)};
    case TexelFormat::Half:
      return {float_from_half(x), float_from_half(x >> 16), float_from_half(y),
              float_from_half(y >> 16)};
    default:
      return {as_float(x), as_float(y), as_float(as_uint(row.z)), as_float(as_uint(row.w))};
  }
}

// Two neighbouring positions along an axis and their weights, which sum to 1 but at a black border.
template <class V>
struct AxisTaps {
  IntOf<V> at[2];
  V weight[2];
};

// Linear interpolation at s, in texels from the outer edge of the first.
template <class V>
LOCKSTEP_INLINE AxisTaps<V> linear_taps(V s) {
  const V lower = floor(s - V(0.5f));
  const V upper_weight = s - V(0.5f) - lower;
  const IntOf<V> at = to_int(lower);
  return {{at, at + IntOf<V>(1)}, {V(1.0f) - upper_weight, upper_weight}};
}

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
