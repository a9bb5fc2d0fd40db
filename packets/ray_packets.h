// Queues of rays through Embree in packets of P, and one by one (P = 1).
#pragma once

#include "core/embree.h"
#include "packets/wave.h"

#include <algorithm>
#include <cstring>
#include <limits>

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

inline constexpr float ray_end = std::numeric_limits<float>::infinity();

template <class T, int P>
LOCKSTEP_INLINE void copy(T (&to)[P], const T* from) {
  std::memcpy(to, from, sizeof to);
}

// Callers name the number of lanes, an int: Embree 4's structures have an unsigned one, from which
// it is not deduced.

// What does not differ from ray to ray; Embree leaves it as it is.
template <int P>
void set_constants(RTCRayNt<P>& ray) {
  for (int lane = 0; lane < P; ++lane) {
    ray.tnear[lane] = ray.time[lane] = 0.0f;
    ray.mask[lane] = ~0u;
    ray.id[lane] = unsigned(lane);
    ray.flags[lane] = 0;
  }
}

// Entries i... of the queue.
template <int P, class Queue>
LOCKSTEP_INLINE void set_rays(RTCRayNt<P>& ray, const Queue& queue, int i) {
  copy(ray.org_x, queue.origin.x + i);
  copy(ray.org_y, queue.origin.y + i);
  copy(ray.org_z, queue.origin.z + i);
  copy(ray.dir_x, queue.direction.x + i);
  copy(ray.dir_y, queue.direction.y + i);
  copy(ray.dir_z, queue.direction.z + i);
}
template <int P>
LOCKSTEP_INLINE void set_closest(RTCRayHitNt<P>& packet, const RayQueue& queue, int i) {
  set_rays<P>(packet.ray, queue, i);
  for (int lane = 0; lane < P; ++lane) packet.ray.tfar[lane] = ray_end;
  for (int lane = 0; lane < P; ++lane) packet.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
}
template <int P>
LOCKSTEP_INLINE void set_shadow(RTCRayNt<P>& ray, const ShadowQueue& queue, int i) {
  set_rays<P>(ray, queue, i);
  copy(ray.tfar, queue.distance + i);
}
template <int P>
LOCKSTEP_INLINE void keep_hits(const RTCRayHitNt<P>& packet, HitArray& hits, int i) {
  std::memcpy(hits.geometry + i, packet.hit.geomID, sizeof packet.hit.geomID);
  std::memcpy(hits.primitive + i, packet.hit.primID, sizeof packet.hit.primID);
  std::memcpy(hits.instance + i, packet.hit.instID[0], sizeof packet.hit.instID[0]);
  std::memcpy(hits.distance + i, packet.ray.tfar, sizeof packet.ray.tfar);
  std::memcpy(hits.u + i, packet.hit.u, sizeof packet.hit.u);
  std::memcpy(hits.v + i, packet.hit.v, sizeof packet.hit.v);
}

// Lanes behind the queue's end hold anything; Embree splits wide packets and may look at all lanes
// of a part, so they get the first ray.
template <int P>
void repeat_first(RTCRayNt<P>& ray, int rays) {
  for (auto* field : {ray.org_x, ray.org_y, ray.org_z, ray.dir_x, ray.dir_y, ray.dir_z, ray.tfar}) {
    std::fill(field + rays, field + P, field[0]);
  }
}

// -1 in the lanes that carry a ray, as Embree wants it.
template <int P>
struct alignas(64) Valid {
  std::int32_t lane[P];

  explicit Valid(int rays) {
    for (int i = 0; i < P; ++i) lane[i] = i < rays ? -1 : 0;
  }
};

template <int P>
LOCKSTEP_INLINE void intersect(RTCScene scene, ClosestQuery& query, const Valid<P>& valid,
                               RTCRayHitNt<P>* packet) {
  void* p = packet;
  const int* v = valid.lane;
  if constexpr (P == 1) trace(rtcIntersect1, scene, query, static_cast<RTCRayHit*>(p));
  if constexpr (P == 4) trace(rtcIntersect4, v, scene, query, static_cast<RTCRayHit4*>(p));
  if constexpr (P == 8) trace(rtcIntersect8, v, scene, query, static_cast<RTCRayHit8*>(p));
  if constexpr (P == 16) trace(rtcIntersect16, v, scene, query, static_cast<RTCRayHit16*>(p));
}
template <int P>
LOCKSTEP_INLINE void occlude(RTCScene scene, AnyQuery& query, const Valid<P>& valid,
                             RTCRayNt<P>* packet) {
  void* p = packet;
  const int* v = valid.lane;
  if constexpr (P == 1) trace(rtcOccluded1, scene, query, static_cast<RTCRay*>(p));
  if constexpr (P == 4) trace(rtcOccluded4, v, scene, query, static_cast<RTCRay4*>(p));
  if constexpr (P == 8) trace(rtcOccluded8, v, scene, query, static_cast<RTCRay8*>(p));
  if constexpr (P == 16) trace(rtcOccluded16, v, scene, query, static_cast<RTCRay16*>(p));
}

template <int P>
void closest_packets(RTCScene scene, bool coherent, const RayQueue& rays, int begin, int end,
                     HitArray& hits) {
  alignas(64) RTCRayHitNt<P> packet{};
  set_constants<P>(packet.ray);
  ClosestQuery query = closest_query(coherent);
  const Valid<P> all(P);
  for (int i = begin; i < end; i += P) {
    set_closest(packet, rays, i);
    if (end - i >= P) {
      intersect<P>(scene, query, all, &packet);
    } else {
      repeat_first<P>(packet.ray, end - i);
      intersect<P>(scene, query, Valid<P>(end - i), &packet);
    }
    keep_hits(packet, hits, i);
  }
}

template <int P>
void occluded_packets(RTCScene scene, bool coherent, ShadowQueue& rays, int begin, int end) {
  AnyQuery query = any_query(coherent);
  alignas(64) RTCRayNt<P> packet{};
  set_constants<P>(packet);
  const Valid<P> all(P);
  for (int i = begin; i < end; i += P) {
    set_shadow<P>(packet, rays, i);
    if (end - i >= P) {
      occlude<P>(scene, query, all, &packet);
    } else {
      repeat_first<P>(packet, end - i);
      occlude<P>(scene, query, Valid<P>(end - i), &packet);
    }
    std::memcpy(rays.distance + i, packet.tfar, sizeof packet.tfar);
  }
}

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
