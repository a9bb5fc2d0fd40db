// Maps from the unit square to shapes, each with its pdf. u lies in [0, 1)^2.
#pragma once

#include "core/simd_math.h"
#include "core/vec.h"

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

inline constexpr float pi = 3.14159265f;
inline constexpr float inv_pi = 0.318309886f;

// Uniform on the unit disk, area measure, pdf 1/pi. Concentric map (Shirley and Chiu 1997):
// continuous and of low distortion, so that strata stay compact.
template <class V>
LOCKSTEP_INLINE Vec2<V> concentric_disk(Vec2<V> u) {
  const V a = fma(u.x, V(2.0f), V(-1.0f));
  const V b = fma(u.y, V(2.0f), V(-1.0f));
  const MaskOf<V> a_leads = abs(a) > abs(b);
  const V radius = select(a_leads, a, b);
  const V ratio = select(a_leads, b, a) / select(radius == V(0.0f), V(1.0f), radius);
  const SinCos<V> angle = sincos_eighth(ratio * V(pi / 4.0f));
  return {radius * select(a_leads, angle.cos, angle.sin),
          radius * select(a_leads, angle.sin, angle.cos)};
}

// Cosine-weighted direction around +z, solid angle, pdf cos/pi (Malley's method).
template <class V>
LOCKSTEP_INLINE Vec3<V> cosine_hemisphere(Vec2<V> u) {
  const Vec2<V> d = concentric_disk(u);
  return {d.x, d.y, sqrt(max(V(0.0f), V(1.0f) - fma(d.x, d.x, d.y * d.y)))};
}
template <class V>
LOCKSTEP_INLINE V cosine_hemisphere_pdf(V cos_theta) {
  return max(cos_theta, V(0.0f)) * V(inv_pi);
}

// Uniform on the unit sphere, solid angle, pdf 1/(4 pi).
template <class V>
LOCKSTEP_INLINE Vec3<V> uniform_sphere(Vec2<V> u) {
  const V z = fma(u.x, V(-2.0f), V(1.0f));
  const V r = V(2.0f) * sqrt(u.x * (V(1.0f) - u.x));
  const SinCos<V> phi = sincos_turns(u.y);
  return {r * phi.cos, r * phi.sin, z};
}

// Uniform in the cone around +z given by 1 - cos of its half angle; pdf 1/(2 pi one_minus_cos).
// Stated through 1 - cos, which keeps its digits where the cone is tiny.
template <class V>
LOCKSTEP_INLINE Vec3<V> uniform_cone(Vec2<V> u, V one_minus_cos) {
  const V h = u.x * one_minus_cos;  // 1 - cos theta
  const V sin_theta = sqrt(max(V(0.0f), h * (V(2.0f) - h)));
  const SinCos<V> phi = sincos_turns(u.y);
  return {sin_theta * phi.cos, sin_theta * phi.sin, V(1.0f) - h};
}
template <class V>
LOCKSTEP_INLINE V uniform_cone_pdf(V one_minus_cos) {
  return V(0.5f * inv_pi) / one_minus_cos;
}

// Uniform on the regular polygon of that many corners on the unit circle, the first on the x axis:
// the concentric map of the disk, whose sectors become the polygon's triangles.
template <class V>
LOCKSTEP_INLINE Vec2<V> uniform_polygon(Vec2<V> u, V corners) {
  const V a = fma(u.x, V(2.0f), V(-1.0f));
  const V b = fma(u.y, V(2.0f), V(-1.0f));
  const MaskOf<V> a_leads = abs(a) > abs(b);
  const V radius = select(a_leads, a, b);
  const V eighth = V(0.125f) * select(a_leads, b, a) / select(radius == V(0.0f), V(1.0f), radius);
  const V turned = select(a_leads, eighth, V(0.25f) - eighth);
  const V turns = turned + select(radius < V(0.0f), V(0.5f), V(0.0f));
  const V sector = turns * corners, first = floor(sector), share = sector - first;
  const auto corner = [&](V i) LOCKSTEP_LAMBDA {
    const V t = i / corners;
    return sincos_turns(t - floor(t));
  };
  const SinCos<V> c0 = corner(first), c1 = corner(first + V(1.0f));
  const V r = abs(radius);
  return {r * fma(share, c1.cos - c0.cos, c0.cos), r * fma(share, c1.sin - c0.sin, c0.sin)};
}

// Barycentric coordinates, uniform on a triangle (Heitz 2019, "A Low-Distortion Map Between
// Triangle and Square"): the square's halves fold onto each other instead of meeting in a point.
template <class V>
LOCKSTEP_INLINE Vec2<V> uniform_triangle(Vec2<V> u) {
  const MaskOf<V> upper = u.y > u.x;
  const V half_x = u.x * V(0.5f), half_y = u.y * V(0.5f);
  return {select(upper, half_x, u.x - half_y), select(upper, u.y - half_x, half_y)};
}

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
