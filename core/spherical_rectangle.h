// Rectangles as a point sees them, sampled uniformly over their solid angle (Ureña, Fajardo and
// King 2013, "An Area-Preserving Parametrization for Spherical Rectangles"), in a form that keeps
// its digits in float.
//
// In the rectangle's own frame the point is the origin and the rectangle [x0, x1] x [y0, y1] at the
// height z >= 0. Between the z axis and a corner (x, y) lies the solid angle asin(w m), where
// w = x / sqrt(x^2 + z^2) and m = y / sqrt(y^2 + z^2).
#pragma once

#include "core/simd_atan.h"
#include "core/warp.h"

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

template <class V>
struct SphericalRectangle {
  V width, height, x0, y0, z;
  V inverse_width, inverse_height;
  V distance0, distance1;   // of the corners (x0, y0) and (x0, y1)
  V solid_angle = V(0.0f);  // [0, 2 pi]; 0 in the rectangle's plane
};

// Sines and cosines that belong to the solid angle, with its sign, of the rectangle's strip between
// 0 and x: asin(w m1) - asin(w m0).
template <class V>
struct Strips {
  V z, m0, m1;
  V over0, over1;  // z / sqrt(y^2 + z^2)

  LOCKSTEP_INLINE explicit Strips(const SphericalRectangle<V>& s) : z(s.z) {
    const V y1 = s.y0 + s.height, z2 = z * z;
    const V inverse0 = rsqrt(fma(s.y0, s.y0, z2)), inverse1 = rsqrt(fma(y1, y1, z2));
    m0 = s.y0 * inverse0, m1 = y1 * inverse1;
    over0 = z * inverse0, over1 = z * inverse1;
  }

  // `distance0`, `distance1`: of the corners (x, y0) and (x, y1).
  LOCKSTEP_INLINE SinCos<V> angle(V x, V distance0, V distance1) const {
    const V inverse = rsqrt(fma(x, x, z * z)), w = x * inverse;
    const V sin0 = w * m0, cos0 = distance0 * inverse * over0;
    const V sin1 = w * m1, cos1 = distance1 * inverse * over1;
    return {fma(sin1, cos0, -(cos1 * sin0)), fma(cos1, cos0, sin1 * sin0)};
  }
};

// The solid angle of a large rectangle, as the difference of two strips; distances of its corners.
template <class V>
LOCKSTEP_INLINE V solid_angle_of_strips(const SphericalRectangle<V>& s, V distance2, V distance3) {
  const Strips<V> strips(s);
  const SinCos<V> a = strips.angle(s.x0, s.distance0, s.distance1);
  const SinCos<V> b = strips.angle(s.x0 + s.width, distance2, distance3);
  const V turns =
      atan2_turns(fma(b.sin, a.cos, -(b.cos * a.sin)), fma(b.cos, a.cos, b.sin * a.sin));
  return V(2.0f * pi) * select(turns < V(0.0f), turns + V(1.0f), turns);
}

// A corner, and how far it is.
template <class V>
struct SeenCorner {
  Vec3<V> at;
  V distance;
  LOCKSTEP_INLINE SeenCorner(V x, V y, V z) : at(x, y, z), distance(length(at)) {}
};

// The rectangle to_corner + s edge1 + t edge2, seen from the origin; its edges at right angles.
template <class V>
LOCKSTEP_INLINE SphericalRectangle<V> spherical_rectangle(const Vec3<V>& to_corner,
                                                          const Vec3<V>& edge1,
                                                          const Vec3<V>& edge2,
                                                          const Vec3<V>& normal) {
  const V width = length(edge1), height = length(edge2);
  const V inverse_width = V(1.0f) / width, inverse_height = V(1.0f) / height;
  const V x0 = dot(to_corner, edge1) * inverse_width, y0 = dot(to_corner, edge2) * inverse_height;
  const V x1 = x0 + width, y1 = y0 + height, z = abs(dot(to_corner, normal));
  const SeenCorner<V> c00(x0, y0, z), c01(x0, y1, z), c10(x1, y0, z), c11(x1, y1, z);

  // Its two triangles (van Oosterom and Strackee 1983): a denominator that cancels means opposite
  // corners, and an angle large enough for the strips.
  const V determinant = z * (width * height);
  MaskOf<V> cancels(false);
  const auto triangle = [&](const SeenCorner<V>& a, const SeenCorner<V>& b, const SeenCorner<V>& c)
                            LOCKSTEP_LAMBDA {
    const V product = a.distance * b.distance * c.distance;
    const V ab = dot(a.at, b.at), bc = dot(b.at, c.at), ca = dot(c.at, a.at);
    const V denominator =
        fma(ab, c.distance, fma(bc, a.distance, fma(ca, b.distance, product)));
    cancels = cancels | (denominator < V(0.05f) * product);
    return atan2_turns(determinant, denominator);
  };
  SphericalRectangle<V> s{width,          height,       x0,           y0, z, inverse_width,
                          inverse_height, c00.distance, c01.distance, V(0.0f)};
  s.solid_angle = V(4.0f * pi) * (triangle(c00, c10, c11) + triangle(c00, c11, c01));
  if (any(cancels)) {
    const V by_strips = solid_angle_of_strips(s, c10.distance, c11.distance);
    s.solid_angle = select(cancels, by_strips, s.solid_angle);
  }
  return s;
}

// x such that the rectangle up to it has the share u of the solid angle: w for the angle phi of its
// strip is sin phi / sqrt(m0^2 + m1^2 - 2 m0 m1 cos phi), of which no two terms may cancel.
template <class V>
LOCKSTEP_INLINE V spherical_rectangle_x(const SphericalRectangle<V>& s, V u) {
  const Strips<V> strips(s);
  const SinCos<V> start = strips.angle(s.x0, s.distance0, s.distance1);
  const SinCos<V> turn = sincos_turns(u * (s.solid_angle * V(0.5f * inv_pi)));
  const V sin_phi = fma(start.sin, turn.cos, start.cos * turn.sin);
  const V cos_phi = fma(start.cos, turn.cos, -(start.sin * turn.sin));
  const V product = strips.m0 * strips.m1, sign = select(product > V(0.0f), V(1.0f), V(-1.0f));
  const V c = sign * cos_phi, sin2 = sin_phi * sin_phi;
  const V one_minus_c = select(c > V(0.0f), sin2 / (V(1.0f) + c), V(1.0f) - c);
  const V difference = fma(-sign, strips.m0, strips.m1);
  const V scale2 = fma(difference, difference, abs(product) * (one_minus_c + one_minus_c));
  const V x = s.z * sin_phi * rsqrt(max(scale2 - sin2, V(1e-30f)));
  return min(max(x, s.x0), s.x0 + s.width);
}

// Point of the rectangle as shares of its edges; pdf 1 / solid angle.
template <class V>
LOCKSTEP_INLINE Vec2<V> sample_spherical_rectangle(const SphericalRectangle<V>& s, Vec2<V> u) {
  const V x = spherical_rectangle_x(s, u.x);
  // Along the line across the rectangle at x, the sine of the latitude is uniform.
  const V d2 = fma(x, x, s.z * s.z), y1 = s.y0 + s.height;
  const V h0 = s.y0 * rsqrt(fma(s.y0, s.y0, d2)), h1 = y1 * rsqrt(fma(y1, y1, d2));
  const V h = fma(u.y, h1 - h0, h0);
  const V y = h * d2 * rsqrt(d2 * max(fma(-h, h, V(1.0f)), V(1e-14f)));
  const auto share = [](V part, V inverse_whole) LOCKSTEP_LAMBDA {
    return min(max(part * inverse_whole, V(0.0f)), V(1.0f));
  };
  return {share(x - s.x0, s.inverse_width), share(y - s.y0, s.inverse_height)};
}

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
