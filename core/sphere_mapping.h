// The sphere of directions as a square, by latitude and longitude or by octahedron: see
// SphereMapping for their conventions.
#pragma once

#include "core/environment_map_data.h"
#include "core/simd_atan.h"
#include "core/simd_math.h"
#include "core/vec.h"

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

// `cos2` and `sin2` are the squares of the cosine and sine of half the angle from +y, which keep
// their digits at both poles.
template <class V>
LOCKSTEP_INLINE Vec3<V> direction_of_latitude(V u, V sin2, V cos2) {
  const SinCos<V> longitude = sincos_turns(u);
  const V radius = V(2.0f) * sqrt(sin2 * cos2);
  return {-(radius * longitude.sin), cos2 - sin2, radius * longitude.cos};
}

template <class V>
LOCKSTEP_INLINE Vec2<V> lat_long_square(const Vec3<V>& w) {
  const V radius = sqrt(fma(w.x, w.x, w.z * w.z));
  return {V(0.5f) + atan2_turns(w.x, -w.z), V(2.0f) * atan2_turns(radius, w.y)};
}

// Clarberg 2008, section 3: each triangle of the folded square keeps its area on the sphere.
template <class V>
LOCKSTEP_INLINE Vec3<V> octahedral_direction(const Vec2<V>& p) {
  const V u = fma(p.x, V(2.0f), V(-1.0f)), v = fma(p.y, V(2.0f), V(-1.0f));
  const V au = abs(u), av = abs(v);
  const V signed_distance = V(1.0f) - (au + av);  // from the fold, where z = 0
  const V r = V(1.0f) - abs(signed_distance);
  const V eighth = select(r > V(0.0f), (av - au) / select(r > V(0.0f), r, V(1.0f)), V(0.0f));
  // The azimuth (eighth + 1) pi/4, from the middle of the quadrant.
  const SinCos<V> half = sincos_eighth(eighth * V(0.785398163f));
  const V root_half(0.707106781f);
  const V cosine = max((half.cos - half.sin) * root_half, V(0.0f));
  const V sine = max((half.cos + half.sin) * root_half, V(0.0f));
  const V radius = r * sqrt(V(2.0f) - r * r);
  return {copysign(radius * cosine, u), copysign(radius * sine, v),
          copysign(V(1.0f) - r * r, signed_distance)};
}

template <class V>
LOCKSTEP_INLINE Vec2<V> octahedral_square(const Vec3<V>& w) {
  const V ax = abs(w.x), ay = abs(w.y), az = abs(w.z);
  const V r = sqrt(fma(ax, ax, ay * ay) / (V(1.0f) + az));  // sqrt(1 - az)
  const V octant = V(4.0f) * atan_turns(min(ax, ay), max(ax, ay));
  const V share = select(ay > ax, V(1.0f) - octant, octant);
  const V b = share * r, a = r - b;
  const MaskOf<V> below = w.z < V(0.0f);
  const V u = copysign(select(below, V(1.0f) - b, a), w.x);
  const V v = copysign(select(below, V(1.0f) - a, b), w.y);
  return {fma(u, V(0.5f), V(0.5f)), fma(v, V(0.5f), V(0.5f))};
}

// The square's point of a unit direction, within [0, 1]^2 whatever the direction holds.
template <class V>
LOCKSTEP_INLINE Vec2<V> square_of_direction(SphereMapping mapping, const Vec3<V>& w) {
  const Vec2<V> p = mapping == SphereMapping::LatLong ? lat_long_square(w) : octahedral_square(w);
  return {clamp(p.x, V(0.0f), V(1.0f)), clamp(p.y, V(0.0f), V(1.0f))};
}

// Brings a texel at most one beyond the square's edge back to where the sphere goes on.
template <class I>
LOCKSTEP_INLINE void cross_edge(SphereMapping mapping, I width, I height, I& x, I& y) {
  using M = MaskOf<I>;
  if (mapping == SphereMapping::LatLong) {
    // Over a pole to the opposite longitude.
    const M pole = (y < I(0)) | (y >= height);
    y = select(y < I(0), I(0), select(y >= height, height - I(1), y));
    x = select(pole, x + (width >> 1), x);
    x = select(x < I(0), x + width, select(x >= width, x - width, x));
    return;
  }
  // An edge is glued to itself, turned about its middle.
  const I last = width - I(1);
  const M left = x<I(0), right = x> last;
  x = select(left, I(0), select(right, last, x));
  y = select(left | right, last - y, y);
  const M top = y<I(0), bottom = y> last;
  y = select(top, I(0), select(bottom, last, y));
  x = select(top | bottom, last - x, x);
}

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
