// Triangles as a point sees them, sampled uniformly over their solid angle (Arvo 1995, "Stratified
// Sampling of Spherical Triangles"), rearranged so that small triangles keep their digits.
#pragma once

#include "core/simd_atan.h"
#include "core/warp.h"

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

// The triangle to_corner, to_corner + edge1, to_corner + edge2, seen from the origin.
template <class V>
struct SphericalTriangle {
  Vec3<V> to_corner, edge1, edge2;
  V determinant;            // of the three corners; its sign says which side is seen
  V solid_angle = V(0.0f);  // [0, 2 pi]; 0 in its plane and where rounding would spoil it
};

// Solid angle: van Oosterom and Strackee 1983.
template <class V>
LOCKSTEP_INLINE SphericalTriangle<V> spherical_triangle(const Vec3<V>& to_corner,
                                                        const Vec3<V>& edge1,
                                                        const Vec3<V>& edge2) {
  const Vec3<V> b = to_corner + edge1, c = to_corner + edge2;
  const V ra = length(to_corner), rb = length(b), rc = length(c), product = ra * rb * rc;
  const V denominator =
      fma(dot(to_corner, b), rc, fma(dot(b, c), ra, fma(dot(c, to_corner), rb, product)));
  const V determinant = dot(to_corner, cross(edge1, edge2));
  const MaskOf<V> cancels =
      fma(determinant, determinant, denominator * denominator) < V(1e-3f) * (product * product);
  const V solid_angle = V(4.0f * pi) * atan2_turns(abs(determinant), denominator);
  return {to_corner, edge1, edge2, determinant, select(cancels, V(0.0f), solid_angle)};
}

// Above this a corner is so near that rounding moves samples, or the triangle all but fills the
// hemisphere.
inline constexpr float max_triangle_angle = 6.2f;

// The unit vector at right angles to `axis`, a unit vector, on the side of `v`.
template <class V>
LOCKSTEP_INLINE Vec3<V> across(const Vec3<V>& v, const Vec3<V>& axis) {
  const Vec3<V> x = v - axis * dot(v, axis);
  return x * rsqrt(max(dot(x, x), V(1e-30f)));
}

// Point of the triangle as shares of its edges; pdf 1 / solid angle. As Arvo has it: the part
// a, b, c' with the share u.x of the solid angle, then a point between b and c'.
template <class V>
LOCKSTEP_INLINE Vec2<V> sample_spherical_triangle(const SphericalTriangle<V>& s, Vec2<V> u) {
  const V inverse_distance = rsqrt(dot(s.to_corner, s.to_corner));
  const Vec3<V> a = s.to_corner * inverse_distance, b = normalize(s.to_corner + s.edge1);
  const auto one_minus_cos = [](const Vec3<V>& v, const Vec3<V>& w)
                                 LOCKSTEP_LAMBDA { return V(0.5f) * dot(v - w, v - w); };

  // The angle alpha at a between the planes of the edges.
  const Vec3<V> n1 = cross(a, s.edge1), n2 = cross(a, s.edge2);
  const V scale = rsqrt(dot(n1, n1) * dot(n2, n2));
  const V cos_alpha = dot(n1, n2) * scale;
  const V sin_alpha = abs(s.determinant) * inverse_distance * scale;

  // 1 - cos of the angle from a to c'. With phi, the area less alpha: u = cos phi - cos alpha and
  // v = sin phi + sin alpha cos(a, b).
  const SinCos<V> area = sincos_turns(u.x * (s.solid_angle * V(0.5f * inv_pi)));
  const V half_sin2 = area.sin * area.sin / (V(1.0f) + max(area.cos, V(0.0f)));
  const V one_minus_area = select(area.cos > V(0.0f), half_sin2, V(1.0f) - area.cos);
  const V sin_phi = fma(area.sin, cos_alpha, -(area.cos * sin_alpha));
  const V cos_phi = fma(area.cos, cos_alpha, area.sin * sin_alpha);
  const V x = fma(area.sin, sin_alpha, -(cos_alpha * one_minus_area));
  const V y = fma(area.sin, cos_alpha, -(sin_alpha * (one_minus_cos(a, b) - one_minus_area)));
  const V divisor = fma(y, sin_phi, x * cos_phi) * sin_alpha;
  const V along = fma(y, one_minus_area, x * area.sin) / divisor;
  const V h = select(divisor * divisor > V(0.0f), min(max(along, V(0.0f)), V(2.0f)), V(0.0f));
  const Vec3<V> c1 = a * (V(1.0f) - h) + across(s.to_corner + s.edge2, a) * sqrt(h * (V(2.0f) - h));

  const V k = u.y * one_minus_cos(c1, b);
  const Vec3<V> w = b * (V(1.0f) - k) + across(c1, b) * sqrt(max(k * (V(2.0f) - k), V(0.0f)));

  // Cramer's rule for to_corner + s edge1 + t edge2 along w.
  const V d = V(1.0f) / dot(w, cross(s.edge1, s.edge2));
  const V first = dot(w, cross(s.edge2, s.to_corner)) * d;
  const V second = dot(w, cross(s.to_corner, s.edge1)) * d;
  const V x1 = min(max(first, V(0.0f)), V(1.0f));
  return {x1, min(max(second, V(0.0f)), V(1.0f) - x1)};
}

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
