// The working set of a tile: paths, rays, hits and shadow rays as structures of arrays, small
// enough to stay in the second-level cache. Rays are kept compact: a dead path leaves no hole.
#pragma once

#include "core/vec.h"
#include "packets/kernel.h"

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

inline constexpr int wave_paths = 1024;
inline constexpr int wave_room = wave_paths + 16;  // packets may reach past the end

using FloatArray = float[wave_room];
using IntArray = std::int32_t[wave_room];
using UIntArray = std::uint32_t[wave_room];

struct alignas(64) Float3Array {
  FloatArray x, y, z;
};

// One entry per path for as long as the wave lasts.
struct alignas(64) PathTable {
  int count = 0;
  UIntArray pixel, sample;
  FloatArray column, row;  // of the pixel
  Float3Array radiance;
};

// Rays on their way, with what their paths carry.
struct alignas(64) RayQueue {
  int count = 0;
  Float3Array origin, direction;  // unit directions
  Float3Array throughput;
  FloatArray bsdf_pdf;         // with which the direction was sampled
  FloatArray environment_pdf;  // with which light sampling gives it, if it misses everything
  IntArray path;
};

// What the ray of the same index hit; geometry -1: nothing.
struct alignas(64) HitArray {
  FloatArray distance;
  Float3Array normal;  // geometric, not unit
  FloatArray u, v;     // barycentric
  IntArray geometry, primitive;
};

struct alignas(64) ShadowQueue {
  int count = 0;
  Float3Array origin, direction;
  FloatArray distance;
  Float3Array radiance;  // that arrives if nothing is in the way
  IntArray path;
};

// Indices into a RayQueue of the hits on one kind of material, and their sample values by Purpose.
struct alignas(64) ShadeList {
  int count = 0;
  IntArray ray, path;
  FloatArray u[4], v[4];
};

struct Wave {
  PathTable paths;
  RayQueue rays[2];
  HitArray hits;
  ShadowQueue shadows;
  ShadeList list;
};

template <class V>
LOCKSTEP_INLINE Vec3<V> load3(const Float3Array& a, int i) {
  return {load<V>(a.x + i), load<V>(a.y + i), load<V>(a.z + i)};
}
template <class I>
LOCKSTEP_INLINE Vec3<FloatOf<I>> gather3(const Float3Array& a, I i) {
  return {gather(a.x, i), gather(a.y, i), gather(a.z, i)};
}
template <class V>
LOCKSTEP_INLINE void store3(Float3Array& a, int i, const Vec3<V>& v) {
  store(a.x + i, v.x);
  store(a.y + i, v.y);
  store(a.z + i, v.z);
}
template <class V>
LOCKSTEP_INLINE void compress3(Float3Array& a, int at, const Vec3<V>& v, MaskOf<V> m) {
  compress_store(a.x + at, v.x, m);
  compress_store(a.y + at, v.y, m);
  compress_store(a.z + at, v.z, m);
}

// Adds v to the radiance of the lanes' paths, which all differ.
template <class V>
LOCKSTEP_INLINE void add_radiance(PathTable& paths, IntOf<V> path, const Vec3<V>& v, MaskOf<V> m) {
  constexpr int W = width_of<V>;
  float x[W], y[W], z[W];
  std::int32_t p[W];
  store(x, v.x), store(y, v.y), store(z, v.z), store(p, path);
  for (std::uint32_t mask = bits(m); mask != 0; mask &= mask - 1) {
    const int lane = std::countr_zero(mask);
    paths.radiance.x[p[lane]] += x[lane];
    paths.radiance.y[p[lane]] += y[lane];
    paths.radiance.z[p[lane]] += z[lane];
  }
}

// Lanes i, i + 1, ... below count.
template <int W>
LOCKSTEP_INLINE Mask<W> lanes_below(int i, int count) {
  return Int<W>(i) + lane_indices<W>() < Int<W>(count);
}

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
