// The exponential function, lane by lane the same at every width.
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

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
