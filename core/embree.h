// Embree 3.13 or 4, whichever the build found. What differs: how a query says that its rays are
// coherent, where it stands among a call's arguments, and that Embree 4 has no streams of rays.
#pragma once

#include "core/simd.h"

#if LOCKSTEP_EMBREE_MAJOR >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace lockstep {

#if LOCKSTEP_EMBREE_MAJOR >= 4
using ClosestQuery = RTCIntersectArguments;
using AnyQuery = RTCOccludedArguments;
inline constexpr auto coherent_rays = RTC_RAY_QUERY_FLAG_COHERENT;
inline constexpr auto incoherent_rays = RTC_RAY_QUERY_FLAG_INCOHERENT;
#else
using ClosestQuery = RTCIntersectContext;
using AnyQuery = RTCIntersectContext;
inline constexpr auto coherent_rays = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
inline constexpr auto incoherent_rays = RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
#endif

LOCKSTEP_INLINE ClosestQuery closest_query(bool coherent) {
  ClosestQuery query;
#if LOCKSTEP_EMBREE_MAJOR >= 4
  rtcInitIntersectArguments(&query);
#else
  rtcInitIntersectContext(&query);
#endif
  query.flags = coherent ? coherent_rays : incoherent_rays;
  return query;
}
LOCKSTEP_INLINE AnyQuery any_query(bool coherent) {
  AnyQuery query;
#if LOCKSTEP_EMBREE_MAJOR >= 4
  rtcInitOccludedArguments(&query);
#else
  rtcInitIntersectContext(&query);
#endif
  query.flags = coherent ? coherent_rays : incoherent_rays;
  return query;
}

// rtcIntersect1 or rtcOccluded1.
template <class Function, class Query, class Ray>
LOCKSTEP_INLINE void trace(Function* function, RTCScene scene, Query& query, Ray* ray) {
#if LOCKSTEP_EMBREE_MAJOR >= 4
  function(scene, ray, &query);
#else
  function(scene, &query, ray);
#endif
}

// rtcIntersect4 and so on. `valid`: -1 for each lane that carries a ray.
template <class Function, class Query, class Rays>
LOCKSTEP_INLINE void trace(Function* function, const int* valid, RTCScene scene, Query& query,
                           Rays* rays) {
#if LOCKSTEP_EMBREE_MAJOR >= 4
  function(valid, scene, rays, &query);
#else
  function(valid, scene, &query, rays);
#endif
}

}  // namespace lockstep
