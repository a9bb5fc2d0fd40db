// Three-component vectors and colours over any lane type: glm::vec<3, V>, and what glm lacks there.
// `dot` and what builds on it use fused multiply-add in one fixed order, so a packet's lanes and a
// single ray agree bit for bit.
#pragma once

#include "core/simd_rows.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

template <class V>
using Vec2 = glm::vec<2, V, glm::defaultp>;
template <class V>
using Vec3 = glm::vec<3, V, glm::defaultp>;

template <class V>
LOCKSTEP_INLINE Vec3<V> splat(glm::vec3 v) {
  return {V(v.x), V(v.y), V(v.z)};
}

template <class V>
LOCKSTEP_INLINE V dot(const Vec3<V>& a, const Vec3<V>& b) {
  return fma(a.x, b.x, fma(a.y, b.y, a.z * b.z));
}

template <class V>
LOCKSTEP_INLINE Vec3<V> cross(const Vec3<V>& a, const Vec3<V>& b) {
  return {fma(a.y, b.z, -(a.z * b.y)), fma(a.z, b.x, -(a.x * b.z)), fma(a.x, b.y, -(a.y * b.x))};
}

template <class V>
LOCKSTEP_INLINE V max_component(const Vec3<V>& a) {
  return max(max(a.x, a.y), a.z);
}

template <class V>
LOCKSTEP_INLINE Vec3<V> abs(const Vec3<V>& a) {
  return {abs(a.x), abs(a.y), abs(a.z)};
}

template <class V>
LOCKSTEP_INLINE V length(const Vec3<V>& a) {
  return sqrt(dot(a, a));
}

template <class V>
LOCKSTEP_INLINE Vec3<V> normalize(const Vec3<V>& a) {
  return a * rsqrt(dot(a, a));
}

// a + s * b
template <class V>
LOCKSTEP_INLINE Vec3<V> fma(V s, const Vec3<V>& b, const Vec3<V>& a) {
  return {fma(s, b.x, a.x), fma(s, b.y, a.y), fma(s, b.z, a.z)};
}

template <class V>
LOCKSTEP_INLINE Vec2<V> select(MaskOf<V> m, const Vec2<V>& a, const Vec2<V>& b) {
  return {select(m, a.x, b.x), select(m, a.y, b.y)};
}
template <class V>
LOCKSTEP_INLINE Vec3<V> select(MaskOf<V> m, const Vec3<V>& a, const Vec3<V>& b) {
  return {select(m, a.x, b.x), select(m, a.y, b.y), select(m, a.z, b.z)};
}

// Relative luminance of linear Rec. 709 RGB.
template <class V>
LOCKSTEP_INLINE V luminance(const Vec3<V>& c) {
  return fma(c.x, V(0.2126f), fma(c.y, V(0.7152f), c.z * V(0.0722f)));
}

// Three values per lane: x = base[index * stride], y and z behind it. Reads one value more.
template <class T, class I>
LOCKSTEP_INLINE auto gather_vec3(const T* base, I index, int stride) {
  const auto row = gather_rows(base, index * I(stride));
  return Vec3<std::remove_const_t<decltype(row.x)>>(row.x, row.y, row.z);
}

// A power of two, by which x > 0 comes to lie in [1/2, 4).
template <class V>
LOCKSTEP_INLINE V power_of_two_scale(V x) {
  using I = IntOf<V>;
  const I exponent = as_int(as_uint(x) & UIntOf<V>(0x7f800000u));
  const I scale = I(0x7e800000) - exponent, smallest(0x00800000);
  return as_float(as_uint(select(scale < smallest, smallest, scale)));
}

// Normalises vectors whose squared length would leave float's range.
template <class V>
LOCKSTEP_INLINE Vec3<V> normalize_any(const Vec3<V>& a) {
  const V largest = max(max_component(abs(a)), V(std::numeric_limits<float>::min()));
  return normalize(a * power_of_two_scale(largest));
}

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
