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
  V solid_angle = V(0.0f);  // [0, 2 pi]; 0 in the rectangle's plane
};

// Sines and cosines that belong to the solid angle, with its sign, of the rectangle's strip between
// 0 and x: asin(w m1) - asin(w m0).
template <class V>
struct Strips {
  V y0, y1, z, m0, m1;

  LOCKSTEP_INLINE explicit Strips(const SphericalRectangle<V>& s)
      : y0(s.y0), y1(s.y0 + s.height), z(s.z) {
    m0 = y0 / sqrt(fma(y0, y0, z * z)), m1 = y1 / sqrt(fma(y1, y1, z * z));
  }

  LOCKSTEP_INLINE SinCos<V> angle(V x) const {
    const V a2 = fma(x, x, z * z), w = x / sqrt(a2);
    const auto cosine = [&](V y) LOCKSTEP_LAMBDA {
      const V y2 = y * y;
      return z * sqrt((y2 + a2) / (a2 * fma(z, z, y2)));
    };
    const V sin0 = w * m0, sin1 = w * m1, cos0 = cosine(y0), cos1 = cosine(y1);
    return {fma(sin1, cos0, -(cos1 * sin0)), fma(cos1, cos0, sin1 * sin0)};
  }
};

// The solid angle of a large rectangle, as the difference of two strips.
template <class V>
LOCKSTEP_INLINE V solid_angle_of_strips(const SphericalRectangle<V>& s) {
  const Strips<V> strips(s);
  const SinCos<V> a = strips.angle(s.x0), b = strips.angle(s.x0 + s.width);
  const V turns =
      atan2_turns(fma(b.sin, a.cos, -(b.cos * a.sin)), fma(b.cos, a.cos, b.sin * a.sin));
  return V(2.0f * pi) * select(turns < V(0.0f), turns + V(1.0f), turns);
}

// The rectangle to_corner + s edge1 + t edge2, seen from the origin; its edges at right angles.
template <class V>
LOCKSTEP_INLINE SphericalRectangle<V> spherical_rectangle(const Vec3<V>& to_corner,
                                                          const Vec3<V>& edge1,
                                                          const Vec3<V>& edge2,
                                                          const Vec3<V>& normal) {
  const V width = length(edge1), height = length(edge2);
  const V x0 = dot(to_corner, edge1) / width, y0 = dot(to_corner, edge2) / height;
  SphericalRectangle<V> s{width, height, x0, y0, abs(dot(to_corner, normal)), V(0.0f)};

  // Its two triangles (van Oosterom and Strackee 1983): a denominator that cancels means opposite
  // corners, and an angle large enough for the strips.
  const V determinant = s.z * (width * height);
  MaskOf<V> cancels(false);
  const auto triangle = [&](const Vec3<V>& a, const Vec3<V>& b, const Vec3<V>& c) LOCKSTEP_LAMBDA {
    const V ra = length(a), rb = length(b), rc = length(c), product = ra * rb * rc;
    const V denominator = fma(dot(a, b), rc, fma(dot(b, c), ra, fma(dot(c, a), rb, product)));
    cancels = cancels | (denominator < V(0.05f) * product);
    return V(4.0f * pi) * atan2_turns(determinant, denominator);
  };
  const Vec3<V> a(x0, y0, s.z), c(x0 + width, y0 + height, s.z);
  s.solid_angle = triangle(a, Vec3<V>(c.x, y0, s.z), c) + triangle(a, c, Vec3<V>(x0, c.y, s.z));
  if (any(cancels)) s.solid_angle = select(cancels, solid_angle_of_strips(s), s.solid_angle);
  return s;
}

// x such that the rectangle up to it has the share u of the solid angle: w for the angle phi of its
// strip is sin phi / sqrt(m0^2 + m1^2 - 2 m0 m1 cos phi), of which no two terms may cancel.
template <class V>
LOCKSTEP_INLINE V spherical_rectangle_x(const SphericalRectangle<V>& s, V u) {
  const Strips<V> strips(s);
  const SinCos<V> start = strips.angle(s.x0);
  const SinCos<V> turn = sincos_turns(u * (s.solid_angle * V(0.5f * inv_pi)));
  const V sin_phi = fma(start.sin, turn.cos, start.cos * turn.sin);
  const V cos_phi = fma(start.cos, turn.cos, -(start.sin * turn.sin));
  const V product = strips.m0 * strips.m1, sign = select(product > V(0.0f), V(1.0f), V(-1.0f));
  const V c = sign * cos_phi, sin2 = sin_phi * sin_phi;
  const V one_minus_c = select(c > V(0.0f), sin2 / (V(1.0f) + c), V(1.0f) - c);
  const V difference = fma(-sign, strips.m0, strips.m1);
  const V scale2 = fma(difference, difference, abs(product) * (one_minus_c + one_minus_c));
  const V x = s.z * sin_phi / sqrt(max(scale2 - sin2, V(1e-30f)));
  return min(max(x, s.x0), s.x0 + s.width);
}

// Point of the rectangle as shares of its edges; pdf 1 / solid angle.
template <class V>
LOCKSTEP_INLINE Vec2<V> sample_spherical_rectangle(const SphericalRectangle<V>& s, Vec2<V> u) {
  const V x = spherical_rectangle_x(s, u.x);
  // Along the line across the rectangle at x, the sine of the latitude is uniform.
  const V d2 = fma(x, x, s.z * s.z), y1 = s.y0 + s.height;
  const V h0 = s.y0 / sqrt(fma(s.y0, s.y0, d2)), h1 = y1 / sqrt(fma(y1, y1, d2));
  const V h = fma(u.y, h1 - h0, h0);
  const V y = h * sqrt(d2 / max(fma(-h, h, V(1.0f)), V(1e-30f)));
  const auto share = [](V part, V whole)
                         LOCKSTEP_LAMBDA { return min(max(part / whole, V(0.0f)), V(1.0f)); };
  return {share(x - s.x0, s.width), share(y - s.y0, s.height)};
}

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
