// Traversal: packets of W rays through Embree. The only place where kernels call it.
#pragma once

#include "packets/wave.h"

#include <embree3/rtcore.h>

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

template <int W>
LOCKSTEP_INLINE void embree_intersect(RTCScene scene, RTCIntersectContext* context,
                                      const std::int32_t* valid, RTCRayHitNt<W>* packet) {
  void* p = packet;
  if constexpr (W == 1) rtcIntersect1(scene, context, static_cast<RTCRayHit*>(p));
  if constexpr (W == 4) rtcIntersect4(valid, scene, context, static_cast<RTCRayHit4*>(p));
  if constexpr (W == 8) rtcIntersect8(valid, scene, context, static_cast<RTCRayHit8*>(p));
  if constexpr (W == 16) rtcIntersect16(valid, scene, context, static_cast<RTCRayHit16*>(p));
}

template <int W>
LOCKSTEP_INLINE void embree_occluded(RTCScene scene, RTCIntersectContext* context,
                                     const std::int32_t* valid, RTCRayNt<W>* packet) {
  void* p = packet;
  if constexpr (W == 1) rtcOccluded1(scene, context, static_cast<RTCRay*>(p));
  if constexpr (W == 4) rtcOccluded4(valid, scene, context, static_cast<RTCRay4*>(p));
  if constexpr (W == 8) rtcOccluded8(valid, scene, context, static_cast<RTCRay8*>(p));
  if constexpr (W == 16) rtcOccluded16(valid, scene, context, static_cast<RTCRay16*>(p));
}

LOCKSTEP_INLINE RTCIntersectContext make_context(bool coherent) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags =
      coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  return context;
}

// Fills an Embree ray packet from entries i.. of the arrays.
template <int W>
LOCKSTEP_INLINE void set_rays(RTCRayNt<W>& ray, const Float3Array& origin,
                              const Float3Array& direction, int i, Float<W> far) {
  using V = Float<W>;
  store(ray.org_x, load<V>(origin.x + i));
  store(ray.org_y, load<V>(origin.y + i));
  store(ray.org_z, load<V>(origin.z + i));
  store(ray.dir_x, load<V>(direction.x + i));
  store(ray.dir_y, load<V>(direction.y + i));
  store(ray.dir_z, load<V>(direction.z + i));
  store(ray.tnear, V(0.0f));
  store(ray.time, V(0.0f));
  store(ray.tfar, far);
  for (int lane = 0; lane < W; ++lane) {
    ray.mask[lane] = ~0u;
    ray.id[lane] = unsigned(lane);
    ray.flags[lane] = 0;
  }
}

// -1 in the lanes below count, as Embree wants it.
template <int W>
LOCKSTEP_INLINE void set_valid(std::int32_t* valid, int i, int count) {
  for (int lane = 0; lane < W; ++lane) valid[lane] = i + lane < count ? -1 : 0;
}

// The distance to the spheres among the lanes' hits, computed alike at every width: Embree's
// intersectors of single rays and of packets round it differently. `distance` tells which of the
// two intersections it is. Stable for small and far spheres (Haines et al. 2019, section 7.2).
template <int W>
LOCKSTEP_INLINE Float<W> refine_distance(const SceneData& scene, const RayQueue& rays, int i,
                                         Int<W> geometry, Float<W> distance) {
  using V = Float<W>;
  using I = Int<W>;
  const Mask<W> hit = !(geometry < I(0));
  const I g = select(hit, geometry, I(0));
  const Mask<W> sphere = hit & (gather(scene.geometry.is_sphere, g) == I(1));
  if (none(sphere)) return distance;
  const Vec3<V> direction = load3<V>(rays.direction, i);
  const Vec3<V> to_centre = gather_vec3(scene.geometry.spheres, g, 4) - load3<V>(rays.origin, i);
  const V radius = gather(scene.geometry.spheres + 3, g * I(4));
  const V middle = dot(to_centre, direction);
  const Vec3<V> off = fma(-middle, direction, to_centre);  // from the ray's closest point
  const V half_chord = sqrt(max(V(0.0f), fma(radius, radius, -dot(off, off))));
  return select(sphere, select(distance < middle, middle - half_chord, middle + half_chord),
                distance);
}

// The closest hit of every ray in the queue.
template <int W>
void intersect(const SceneData& scene, bool coherent, const RayQueue& rays, HitArray& hits,
               TileCounts& counts) {
  using V = Float<W>;
  RTCIntersectContext context = make_context(coherent);
  alignas(64) RTCRayHitNt<W> packet{};
  alignas(64) std::int32_t valid[W];
  for (int i = 0; i < rays.count; i += W) {
    set_valid<W>(valid, i, rays.count);
    set_rays<W>(packet.ray, rays.origin, rays.direction, i,
                V(std::numeric_limits<float>::infinity()));
    for (int lane = 0; lane < W; ++lane) packet.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
    for (int lane = 0; lane < W; ++lane) packet.hit.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;
    embree_intersect<W>(static_cast<RTCScene>(scene.embree_scene), &context, valid, &packet);
    std::memcpy(hits.geometry + i, packet.hit.geomID, sizeof packet.hit.geomID);
    std::memcpy(hits.primitive + i, packet.hit.primID, sizeof packet.hit.primID);
    V distance = load<V>(packet.ray.tfar);
    if (scene.spheres) {
      distance = refine_distance<W>(scene, rays, i, load<Int<W>>(hits.geometry + i), distance);
    }
    store(hits.distance + i, distance);
    store(hits.normal.x + i, load<V>(packet.hit.Ng_x));
    store(hits.normal.y + i, load<V>(packet.hit.Ng_y));
    store(hits.normal.z + i, load<V>(packet.hit.Ng_z));
    store(hits.u + i, load<V>(packet.hit.u));
    store(hits.v + i, load<V>(packet.hit.v));
  }
  counts.lanes += std::uint64_t((rays.count + W - 1) / W * W);
  counts.active_lanes += std::uint64_t(rays.count);
}

// Adds the radiance of every shadow ray that reaches its light.
template <int W>
void trace_shadows(const SceneData& scene, bool coherent, const ShadowQueue& shadows,
                   PathTable& paths, TileCounts& counts) {
  using V = Float<W>;
  RTCIntersectContext context = make_context(coherent);
  alignas(64) RTCRayNt<W> packet;
  alignas(64) std::int32_t valid[W];
  for (int i = 0; i < shadows.count; i += W) {
    set_valid<W>(valid, i, shadows.count);
    set_rays<W>(packet, shadows.origin, shadows.direction, i, load<V>(shadows.distance + i));
    embree_occluded<W>(static_cast<RTCScene>(scene.embree_scene), &context, valid, &packet);
    const Mask<W> lit =
        lanes_below<W>(i, shadows.count) & (load<V>(packet.tfar) >= V(0.0f));  // -inf: occluded
    add_radiance(paths, load<Int<W>>(shadows.path + i), load3<V>(shadows.radiance, i), lit);
  }
  counts.rays.shadow += std::uint64_t(shadows.count);
  counts.lanes += std::uint64_t((shadows.count + W - 1) / W * W);
  counts.active_lanes += std::uint64_t(shadows.count);
}

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
