// Orthonormal frames: local z is the normal.
#pragma once

#include "core/vec.h"

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

template <class V>
struct Frame {
  Vec3<V> x, y, z;

  LOCKSTEP_INLINE Vec3<V> to_local(const Vec3<V>& v) const {
    return {dot(v, x), dot(v, y), dot(v, z)};
  }
  LOCKSTEP_INLINE Vec3<V> to_world(const Vec3<V>& v) const {
    return fma(v.x, x, fma(v.y, y, z * v.z));
  }
};

// A frame around a unit vector (Duff et al. 2017, "Building an Orthonormal Basis, Revisited").
template <class V>
LOCKSTEP_INLINE Frame<V> frame_around(const Vec3<V>& n) {
  const V sign = copysign(V(1.0f), n.z);
  const V a = V(-1.0f) / (sign + n.z);
  const V b = n.x * n.y * a;
  return {{fma(sign * n.x, n.x * a, V(1.0f)), sign * b, -(sign * n.x)},
          {b, fma(n.y, n.y * a, sign), -n.y},
          n};
}

// A frame around n whose x axis lies along t as far as it can; around n alone where it cannot.
template <class V>
LOCKSTEP_INLINE Frame<V> frame_along(const Vec3<V>& n, const Vec3<V>& t) {
  const V scale = V(1.0f) / max(max_component(abs(t)), V(std::numeric_limits<float>::min()));
  const Vec3<V> scaled = t * scale;
  const Vec3<V> in_plane = fma(-dot(n, scaled), n, scaled);
  const V length2 = dot(in_plane, in_plane);
  const MaskOf<V> usable = length2 > V(1e-10f);
  const Frame<V> any = frame_around(n);
  const Vec3<V> x = in_plane * rsqrt(select(usable, length2, V(1.0f)));
  return {select<V>(usable, x, any.x), select<V>(usable, cross(n, x), any.y), n};
}

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
