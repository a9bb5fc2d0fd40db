// Queues of rays through Embree in streams: elements of N rays side by side, 1 or 16. Embree 4 has
// none, so there they are declared only (see has_streams).
#pragma once

#include "packets/ray_packets.h"

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

template <int N>
void closest_stream(RTCScene scene, bool coherent, const RayQueue& rays, int begin, int end,
                    HitArray& hits);
template <int N>
void occluded_stream(RTCScene scene, bool coherent, ShadowQueue& rays, int begin, int end);

#if LOCKSTEP_EMBREE_MAJOR < 4

inline constexpr int stream_rays = 128;

template <int N>
RTCRayNt<N>& rays_of(RTCRayHitNt<N>& element) {
  return element.ray;
}
template <int N>
RTCRayNt<N>& rays_of(RTCRayNt<N>& element) {
  return element;
}

// Kept by each thread, with what never changes in place: to set it anew would cost short queues and
// trials some 5 %.
template <class Element, int N>
Element (&stream_elements())[stream_rays / N] {
  struct Stream {
    alignas(64) Element element[stream_rays / N];
    Stream() {
      for (Element& e : element) set_constants(rays_of(e));
    }
  };
  thread_local Stream stream;
  return stream.element;
}

// Lanes behind the end of the queue get an empty interval, which Embree takes for inactive.
template <int N>
void retire_lanes(RTCRayNt<N>& ray, int rays) {
  for (int lane = rays; lane < N; ++lane) {
    ray.tnear[lane] = ray_end;
    ray.tfar[lane] = -ray_end;
  }
}
template <int N>
void restore_lanes(RTCRayNt<N>& ray, int rays) {
  for (int lane = rays; lane < N; ++lane) ray.tnear[lane] = 0.0f;
}

template <int N>
void closest_stream(RTCScene scene, bool coherent, const RayQueue& rays, int begin, int end,
                    HitArray& hits) {
  ClosestQuery query = closest_query(coherent);
  auto& stream = stream_elements<RTCRayHitNt<N>, N>();
  for (int first = begin; first < end; first += stream_rays) {
    const int elements = (std::min(stream_rays, end - first) + N - 1) / N;
    for (int m = 0; m < elements; ++m) set_closest(stream[m], rays, first + m * N);
    const int in_last = end - first - (elements - 1) * N;
    retire_lanes(stream[elements - 1].ray, in_last);
    void* p = stream;
    if constexpr (N == 1) {
      rtcIntersect1M(scene, &query, static_cast<RTCRayHit*>(p), unsigned(elements),
                     sizeof stream[0]);
    } else {
      rtcIntersectNM(scene, &query, static_cast<RTCRayHitN*>(p), N, unsigned(elements),
                     sizeof stream[0]);
    }
    restore_lanes(stream[elements - 1].ray, in_last);
    for (int m = 0; m < elements; ++m) keep_hits(stream[m], hits, first + m * N);
  }
}

template <int N>
void occluded_stream(RTCScene scene, bool coherent, ShadowQueue& rays, int begin, int end) {
  AnyQuery query = any_query(coherent);
  auto& stream = stream_elements<RTCRayNt<N>, N>();
  for (int first = begin; first < end; first += stream_rays) {
    const int elements = (std::min(stream_rays, end - first) + N - 1) / N;
    for (int m = 0; m < elements; ++m) set_shadow(stream[m], rays, first + m * N);
    const int in_last = end - first - (elements - 1) * N;
    retire_lanes(stream[elements - 1], in_last);
    void* p = stream;
    if constexpr (N == 1) {
      rtcOccluded1M(scene, &query, static_cast<RTCRay*>(p), unsigned(elements), sizeof stream[0]);
    } else {
      rtcOccludedNM(scene, &query, static_cast<RTCRayN*>(p), N, unsigned(elements),
                    sizeof stream[0]);
    }
    for (int m = 0; m < elements; ++m) {
      std::memcpy(rays.distance + first + m * N, stream[m].tfar, sizeof stream[m].tfar);
    }
    restore_lanes(stream[elements - 1], in_last);
  }
}

#endif

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
