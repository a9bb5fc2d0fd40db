// Counter-based random numbers: a value is a hash of what it is for, never of what came before.
// Source: Jarzynski and Olano 2020, "Hash Functions for GPU Rendering", pcg4d and pcg3d, chosen
// there for their quality at this speed.
#pragma once

#include "core/simd.h"

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

template <class U>
struct Hash3 {
  U x, y, z;
};
template <class U>
struct Hash4 {
  U x, y, z, w;
};

template <class U>
LOCKSTEP_INLINE Hash3<U> pcg3d(U x, U y, U z) {
  const U a(1664525u), c(1013904223u);
  x = x * a + c, y = y * a + c, z = z * a + c;
  x += y * z, y += z * x, z += x * y;
  x ^= x >> 16, y ^= y >> 16, z ^= z >> 16;
  x += y * z, y += z * x, z += x * y;
  return {x, y, z};
}

template <class U>
LOCKSTEP_INLINE Hash4<U> pcg4d(U x, U y, U z, U w) {
  const U a(1664525u), c(1013904223u);
  x = x * a + c, y = y * a + c, z = z * a + c, w = w * a + c;
  x += y * w, y += z * x, z += x * y, w += y * z;
  x ^= x >> 16, y ^= y >> 16, z ^= z >> 16, w ^= w >> 16;
  x += y * w, y += z * x, z += x * y, w += y * z;
  return {x, y, z, w};
}

// The upper 24 bits as a float in [0, 1 - 2^-24].
template <class U>
LOCKSTEP_INLINE FloatOf<U> unit_float(U x) {
  return to_float(as_int(x >> 8)) * FloatOf<U>(0x1p-24f);
}

inline constexpr float one_minus_epsilon = 0x1.fffffep-1f;  // the largest float below 1

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
