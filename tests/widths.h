// Helpers for tests of width-generic code: every width against W = 1, lane by lane, bit for bit.
#pragma once

#include "core/hash.h"
#include "core/vec.h"

#include <gtest/gtest.h>

#include <type_traits>
#include <vector>

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

// Calls f with std::integral_constant 4, 8 and 16.
template <class F>
void for_each_width(F f) {
  f(std::integral_constant<int, 4>());
  f(std::integral_constant<int, 8>());
  f(std::integral_constant<int, 16>());
}

template <class T, int W>
T lane(Lanes<T, W> v, int i) {
  return v[i];
}
template <int W>
bool lane(LaneMask<W> m, int i) {
  return bits(m) >> i & 1u;
}
template <int W>
glm::vec3 lane(const Vec3<Lanes<float, W>>& v, int i) {
  return {v.x[i], v.y[i], v.z[i]};
}

// Equal bits, or NaN both: which of two NaN operands survives is the compiler's choice.
inline bool same_value(float a, float b) { return as_uint(a) == as_uint(b) || (a != a && b != b); }
inline bool same_value(std::int32_t a, std::int32_t b) { return a == b; }
inline bool same_value(std::uint32_t a, std::uint32_t b) { return a == b; }
inline bool same_value(bool a, bool b) { return a == b; }
inline bool same_value(glm::vec3 a, glm::vec3 b) {
  return same_value(a.x, b.x) && same_value(a.y, b.y) && same_value(a.z, b.z);
}

// Three uniform values of a fixed sequence.
inline glm::vec3 uniform3(std::uint32_t index, std::uint32_t seed) {
  const Hash3<std::uint32_t> h = pcg3d(index, seed, 0x9e3779b9u);
  return {unit_float(h.x), unit_float(h.y), unit_float(h.z)};
}
inline Vec2<float> uniform2(std::uint32_t index, std::uint32_t seed) {
  const glm::vec3 u = uniform3(index, seed);
  return {u.x, u.y};
}

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
