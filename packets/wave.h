// The working set of a tile: paths, rays, hits and shadow rays as structures of arrays, small
// enough to stay in the second-level cache. Rays are kept compact: a dead path leaves no hole.
#pragma once

#include "core/simd_pack.h"
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

// The order of a wave's paths: offsets from the job's first pixel and sample. It depends on the
// job's shape alone, so waves of one shape share it.
struct alignas(64) PathOrder {
  int width = 0, height = 0, samples = 0;  // of the job it was made for
  LaneLayout lanes;
  int interleave = 0;  // SamplerState::interleave
  int count = 0;
  IntArray x, y, sample;
};

// One entry per path for as long as the wave lasts.
struct alignas(64) PathTable {
  int count = 0;
  UIntArray pixel, sample;
  FloatArray weight;              // of the pixel filter, where it has negative lobes
  float radiance[wave_room * 4];  // RGB and 1: summed up, the last counts samples
};

// Rays on their way, with what their paths carry.
struct alignas(64) RayQueue {
  int count = 0;
  Float3Array origin, direction;  // unit directions
  Float3Array throughput;
  FloatArray bsdf_pdf;         // with which the direction was sampled
  FloatArray environment_pdf;  // with which light sampling gives it, if it misses everything
  FloatArray eta_scale;        // what refraction took from the throughput: see radiance_scale()
  IntArray medium;             // material of the dielectric that the ray is in, or -1
  IntArray path;
};

// What the ray of the same index hit; geometry -1: nothing.
struct alignas(64) HitArray {
  FloatArray distance;
  FloatArray u, v;  // barycentric
  IntArray geometry, primitive;
  IntArray instance;  // Embree's number, -1 for what is none
  IntArray material;  // where the scene has mixes: what the path goes on with
};

// Hits in the order in which they are to be shaded.
struct alignas(64) HitOrder {
  int count = 0;
  IntArray hit, material;
};

// Distance: up to which nothing may be in the way; after tracing, -infinity where something is.
struct alignas(64) ShadowQueue {
  int count = 0;
  Float3Array origin, direction;
  FloatArray distance;
  Float3Array radiance;  // that arrives if nothing is in the way
  IntArray path;
};

// The hits on one kind of material, side by side, and the sample values of their paths by Purpose.
struct alignas(64) ShadeQueue {
  int count = 0;
  Float3Array direction;  // of the ray
  Float3Array origin;     // of the ray, and
  FloatArray distance;    // the hit's: only where the scene has spheres
  Float3Array throughput;
  FloatArray barycentric_u, barycentric_v;
  FloatArray eta_scale;  // see RayQueue
  IntArray medium;
  IntArray geometry, primitive, material, path;
  IntArray instance;  // see HitArray
  UIntArray pixel, sample;
  FloatArray u[4], v[4];
};

struct Wave {
  PathOrder order;
  PathTable paths;
  RayQueue rays[2];
  HitArray hits;
  HitOrder found, ordered;
  ShadowQueue shadows;
  ShadeQueue hits_to_shade;
};

// True where what is refracted is carried along.
template <FeatureMask F>
constexpr bool refracts(const SceneData& scene) {
  return needs_any<F>(scene, feature_set(Feature::Dielectric, Feature::Principled));
}

template <class V>
LOCKSTEP_INLINE Vec3<V> load3(const Float3Array& a, int i) {
  return {load<V>(a.x + i), load<V>(a.y + i), load<V>(a.z + i)};
}
template <class V>
LOCKSTEP_INLINE void store3(Float3Array& a, int i, const Vec3<V>& v) {
  store(a.x + i, v.x);
  store(a.y + i, v.y);
  store(a.z + i, v.z);
}
template <int W>
LOCKSTEP_INLINE void pack3(const Packing<W>& lanes, Float3Array& a, int at,
                           const Vec3<Float<W>>& v) {
  lanes.store(a.x + at, v.x);
  lanes.store(a.y + at, v.y);
  lanes.store(a.z + at, v.z);
}

// Adds v to the radiance of the lanes' paths, which all differ.
template <class V>
LOCKSTEP_INLINE void add_radiance(PathTable& paths, IntOf<V> path, const Vec3<V>& v, MaskOf<V> m) {
  add_rows(paths.radiance, path, {v.x, v.y, v.z, V(0.0f)}, m);
}

// Lanes i, i + 1, ... below count.
template <int W>
LOCKSTEP_INLINE Mask<W> lanes_below(int i, int count) {
  return Int<W>(i) + lane_indices<W>() < Int<W>(count);
}

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
