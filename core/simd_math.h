// Elementary functions over lanes: one polynomial source for every width, error bounds stated here
// and enforced by the tests.
#pragma once

#include "core/simd.h"

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

template <class V>
struct SinCos {
  V sin, cos;
};

// sin and cos of an angle in [-pi/4, pi/4], radians; absolute error below 1.2e-7 (2 ulp at 1).
// Minimax polynomials of Cephes' sinf/cosf (Moshier 1992).
template <class V>
LOCKSTEP_INLINE SinCos<V> sincos_eighth(V x) {
  const V x2 = x * x;
  const V s = fma(fma(fma(V(-1.9515295891e-4f), x2, V(8.3321608736e-3f)), x2, V(-1.6666654611e-1f)),
                  x2 * x, x);
  const V c = fma(fma(fma(V(2.443315711809948e-5f), x2, V(-1.388731625493765e-3f)), x2,
                      V(4.166664568298827e-2f)),
                  x2 * x2, fma(V(-0.5f), x2, V(1.0f)));
  return {s, c};
}

// sin and cos of 2 pi u for u in [0, 1]; absolute error below 2e-7.
template <class V>
LOCKSTEP_INLINE SinCos<V> sincos_turns(V u) {
  // The nearest quarter turn, then the rest within an eighth of a turn; both steps are exact.
  const V quarter = floor(fma(u, V(4.0f), V(0.5f)));
  const SinCos<V> r = sincos_eighth(fma(quarter, V(-0.25f), u) * V(6.28318531f));
  const auto q = to_int(quarter);
  using I = IntOf<V>;
  const MaskOf<V> odd = (q & I(1)) == I(1);
  const MaskOf<V> negative_sin = (q & I(2)) == I(2);
  const MaskOf<V> negative_cos = ((q + I(1)) & I(2)) == I(2);
  const V s = select(odd, r.cos, r.sin);
  const V c = select(odd, r.sin, r.cos);
  return {select(negative_sin, -s, s), select(negative_cos, -c, c)};
}

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
