// Angles of directions in the plane, over lanes.
#pragma once

#include "core/simd.h"

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

// atan(b / a) for 0 <= b <= a, in turns: [0, 1/8]; 0 where both are 0. Absolute error below 3e-8.
// Polynomial of Cephes' atanf (Moshier 1992).
template <class V>
LOCKSTEP_INLINE V atan_turns(V b, V a) {
  // Above tan(pi/8): atan(b/a) = pi/4 + atan((b - a) / (b + a)).
  const MaskOf<V> high = b > a * V(0.414213562f);
  const V numerator = select(high, b - a, b);
  const V denominator = select(high, b + a, a);
  const V x = numerator / select(denominator > V(0.0f), denominator, V(1.0f));
  const V x2 = x * x;
  const V p =
      fma(fma(fma(V(8.05374449538e-2f), x2, V(-1.38776856032e-1f)), x2, V(1.99777106478e-1f)), x2,
          V(-3.33329491539e-1f));
  const V angle = fma(p * x2, x, x);
  return fma(angle, V(0.159154943f), select(high, V(0.125f), V(0.0f)));
}

// Angle of (x, y) from +x towards +y, in turns: [-1/2, 1/2]; 0 at the origin.
template <class V>
LOCKSTEP_INLINE V atan2_turns(V y, V x) {
  const V ax = abs(x), ay = abs(y);
  const V octant = atan_turns(min(ax, ay), max(ax, ay));
  const V quadrant = select(ay > ax, V(0.25f) - octant, octant);
  return copysign(select(x < V(0.0f), V(0.5f) - quadrant, quadrant), y);
}

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
