// The exponential function and the logarithm, lane by lane the same at every width.
#pragma once

#include "core/simd.h"

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

// e^x for x up to 88, to 2 units in the last place; 0 below -87.
template <class V>
LOCKSTEP_INLINE V exp(V x) {
  const V clamped = clamp(x, V(-87.0f), V(88.0f));
  const V n = floor(fma(clamped, V(1.44269504f), V(0.5f)));
  // x - n ln 2, with ln 2 in two parts.
  const V r = fma(n, V(-1.42860677e-6f), fma(n, V(-0.693145752f), clamped));
  V p = fma(V(1.0f / 720.0f), r, V(1.0f / 120.0f));
  p = fma(p, r, V(1.0f / 24.0f));
  p = fma(p, r, V(1.0f / 6.0f));
  p = fma(p, r, V(0.5f));
  p = fma(p, r, V(1.0f));
  p = fma(p, r, V(1.0f));
  const V power = as_float(as_uint(to_int(n) + IntOf<V>(127)) << 23);
  return select(x < V(-87.0f), V(0.0f), p * power);
}

// The binary logarithm of a normal number above 0; absolute error below 2e-7 and half a unit in the
// last place. Exact for powers of two.
template <class V>
LOCKSTEP_INLINE V log2(V x) {
  using I = IntOf<V>;
  // x = 2^n m with m in [2^-1/2, 2^1/2), whose logarithm is 2 artanh((m - 1) / (m + 1)).
  constexpr std::int32_t root_half = 0x3f3504f3;
  const I offset = as_int(as_uint(x)) - I(root_half);
  const I n = offset >> 23;
  const V m = as_float(as_uint((offset & I(0x007fffff)) + I(root_half)));
  const V t = (m - V(1.0f)) / (m + V(1.0f)), t2 = t * t;
  V p = fma(V(1.0f / 9.0f), t2, V(1.0f / 7.0f));
  p = fma(p, t2, V(1.0f / 5.0f));
  p = fma(p, t2, V(1.0f / 3.0f));
  p = fma(p, t2, V(1.0f));
  return fma(p * t, V(2.88539008f), to_float(n));
}

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
