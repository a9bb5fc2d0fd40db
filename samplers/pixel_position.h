// Where a pixel lies, from its number, and its place on the Z-order curve.
#pragma once

#include "core/simd.h"
#include "samplers/sampler_state.h"

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

template <class U>
struct PixelPosition {
  U x, y;
};

// Exact for up to 2^22 rows: the float quotient is off by one at most.
template <class U>
LOCKSTEP_INLINE PixelPosition<U> position_of(U pixel, int width) {
  using V = FloatOf<U>;
  using I = decltype(as_int(pixel));
  const I number = as_int(pixel), columns(width);
  I row = to_int(to_float(number) * V(1.0f / float(width)));
  I column = number - row * columns;
  const auto above = column < I(0), below = column >= columns;
  row = row - select(above, I(1), I(0)) + select(below, I(1), I(0));
  column = number - row * columns;
  return {as_uint(column), as_uint(row)};
}

// The lower 16 bits, a zero between any two.
template <class U>
LOCKSTEP_INLINE U spread_bits(U x) {
  x = x & U(0x0000ffffu);
  x = (x | (x << 8)) & U(0x00ff00ffu);
  x = (x | (x << 4)) & U(0x0f0f0f0fu);
  x = (x | (x << 2)) & U(0x33333333u);
  return (x | (x << 1)) & U(0x55555555u);
}

template <class U>
LOCKSTEP_INLINE U morton_code(const PixelPosition<U>& p) {
  return spread_bits(p.x) | (spread_bits(p.y) << 1);
}

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
