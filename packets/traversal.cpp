// Compiled once per instruction set.
#include "packets/traversal.h"

#include "packets/flush_denormals.h"
#include "packets/ray_packets.h"
#include "packets/ray_streams.h"
#include "packets/stage_clock.h"

#include <algorithm>
#include <bit>
#include <memory>

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {
namespace {

constexpr int trial_slice = 64;  // rays traced in one mode, then as many in another,
constexpr int trial_slices = 4;  // at most

RTCScene embree(const SceneData& scene) { return static_cast<RTCScene>(scene.embree_scene); }

// The distances to the spheres among the hits, computed alike for every mode: Embree's intersectors
// of single rays and of packets round them differently. Embree's distance tells which of the two
// intersections it is. Stable for small and far spheres (Haines et al. 2019, section 7.2).
void refine_distances(const SceneData& scene, const RayQueue& rays, int begin, int end,
                      HitArray& hits) {
  constexpr int W = native_lanes;
  using V = Float<W>;
  using I = Int<W>;
  for (int i = begin; i < end; i += W) {
    const I geometry = load<I>(hits.geometry + i);
    const Mask<W> hit = lanes_below<W>(i, end) & !(geometry < I(0));
    const I g = select(hit, geometry, I(0));
    const I flags = gather(scene.geometry.rows + 3, g * I(geometry_stride));
    const Mask<W> sphere = hit & ((flags & I(geometry_is_sphere)) != I(0));
    if (none(sphere)) continue;
    const auto row = gather_rows(scene.geometry.spheres, g * I(4));
    const Vec3<V> direction = load3<V>(rays.direction, i);
    const Vec3<V> to_centre = Vec3<V>(row.x, row.y, row.z) - load3<V>(rays.origin, i);
    const V middle = dot(to_centre, direction);
    const Vec3<V> off = fma(-middle, direction, to_centre);  // from the ray's closest point
    const V half_chord = sqrt(max(V(0.0f), fma(row.w, row.w, -dot(off, off))));
    const V distance = load<V>(hits.distance + i);
    const V refined = select(distance < middle, middle - half_chord, middle + half_chord);
    store(hits.distance + i, select(sphere, refined, distance));
  }
}

// Where a ray hits two triangles at one distance, on an edge they share or where they lie on each
// other, the one visited last counts. Incoherent modes all visit in the order of a single ray,
// coherent ones in an order of their own: they trace such hits again as single rays.

// Next to an edge, in barycentric coordinates: some ten times the tolerance of Embree's test, and
// still only a ray in a hundred thousand.
constexpr float edge_zone = 0x1p-18f;

template <int W>
Mask<W> may_tie(const SceneData& scene, const HitArray& hits, int i, Mask<W> hit) {
  using V = Float<W>;
  using I = Int<W>;
  const V u = load<V>(hits.u + i), v = load<V>(hits.v + i);
  Mask<W> tie = hit & (min(min(u, v), V(1.0f) - u - v) < V(edge_zone));
  if (!scene.coincident && none(tie)) return tie;
  const I row = select(hit, load<I>(hits.geometry + i), I(0)) * I(geometry_stride);
  if (scene.features & bit(Feature::Spheres)) {  // where u and v are always 0
    const I flags = gather(scene.geometry.rows + 3, row);
    hit = hit & ((flags & I(geometry_is_sphere)) == I(0));
    tie = tie & hit;
  }
  if (!scene.coincident) return tie;
  const I triangle = gather(scene.geometry.rows, row) + load<I>(hits.primitive + i);
  std::int32_t at[W], coincident[W];
  store(at, select(hit, triangle, I(0)));
  for (int lane = 0; lane < W; ++lane) coincident[lane] = scene.coincident[at[lane]];
  return tie | (hit & (load<I>(coincident) != I(0)));
}

void settle_ties(const SceneData& scene, const RayQueue& rays, int begin, int end, HitArray& hits) {
  constexpr int W = native_lanes;
  for (int i = begin; i < end; i += W) {
    const Mask<W> hit = lanes_below<W>(i, end) & !(load<Int<W>>(hits.geometry + i) < Int<W>(0));
    std::uint32_t left = bits(may_tie<W>(scene, hits, i, hit));
    for (; left != 0; left &= left - 1) {
      const int ray = i + std::countr_zero(left);
      closest_packets<1>(embree(scene), false, rays, ray, ray + 1, hits);
    }
  }
}

// Calls f(lanes, whether they are a stream's) with both known at compile time.
template <class F>
void with_packets(Packets packets, const F& f) {
  constexpr auto one = std::integral_constant<int, 1>();
  constexpr auto sixteen = std::integral_constant<int, 16>();
  switch (packets) {
    case Packets::Single:
      return f(one, std::false_type());
    case Packets::Four:
      return f(std::integral_constant<int, 4>(), std::false_type());
    case Packets::Eight:
      return f(std::integral_constant<int, 8>(), std::false_type());
    case Packets::Sixteen:
      return f(sixteen, std::false_type());
    case Packets::Stream1M:
      if constexpr (has_streams) return f(one, std::true_type());
      return;
    case Packets::StreamNM:
      if constexpr (has_streams) return f(sixteen, std::true_type());
      return;
  }
}

// Times slices in the middle of the queue, in each mode of the plan in turn: neighbouring rays cost
// about the same, distant ones do not.
template <class Trace>
void compare_modes(const TraversalPlan& plan, int rays, TraversalPolicy& policy,
                   const QueueClass& queue, const Trace& trace) {
  const int slice = std::min(trial_slice, rays / 2 / 16 * 16);
  const int slices = std::min(trial_slices, rays / slice / 2 * 2);
  const int first = (rays - slices * slice) / 2 / 16 * 16, last = first + slices * slice;
  double ticks[2] = {};  // in the plan's mode, in the trial's
  if (first > 0) trace(plan.mode, 0, first);
  for (int i = 0; i < slices; ++i) {
    // 0 1 1 0 1 0 0 1: neither mode comes first more often, nor further along.
    const bool trial = (std::popcount(unsigned(i)) % 2 == 1) != plan.trial_first;
    const int begin = first + i * slice;
    const std::uint64_t start = read_ticks();
    trace(trial ? *plan.trial : plan.mode, begin, begin + slice);
    ticks[trial] += double(read_ticks() - start);
  }
  if (last < rays) trace(plan.mode, last, rays);
  const double each = slices / 2 * slice;
  policy.record(queue, *plan.trial, ticks[1] / each, ticks[0] / each);
}

// How far the directions of neighbouring rays spread, from eight groups of eight.
LOCKSTEP_INLINE int spread_of(const Float3Array& direction, int rays) {
  constexpr int group = 8, groups = 8;
  using V = Float<4>;
  const int step = std::max(group, rays / groups / group * group);
  float length = 0.0f;
  int seen = 0;
  for (int i = 0; i + group <= rays && seen < groups; i += step, ++seen) {
    Vec3<V> sum = load3<V>(direction, i) + load3<V>(direction, i + 4);
    const auto total = [](V v) { return (v[0] + v[1]) + (v[2] + v[3]); };
    const float x = total(sum.x), y = total(sum.y), z = total(sum.z);
    length += sqrt(x * x + y * y + z * z);
  }
  return seen > 0 ? spread_class(length / float(group * seen)) : spreads - 1;
}

template <class Queue, class Trace>
void trace_planned(TraversalPolicy& policy, RayKind kind, int bounce, const Queue& rays,
                   TileCounts& counts, const Trace& trace) {
  if (rays.count == 0) return;
  const auto traced = [&](TraversalMode mode, int begin, int end) {
    trace(mode, begin, end);
    const int n = end - begin, width = lanes(mode.packets), packets = (n + width - 1) / width;
    counts.traced[int(kind)][index(mode)] += std::uint64_t(n);
    counts.packets += std::uint64_t(packets);
    counts.lanes += std::uint64_t(packets) * std::uint64_t(width);
    counts.active_lanes += std::uint64_t(n);
  };
  const QueueClass queue{kind, bounce, spread_of(rays.direction, rays.count)};
  const TraversalPlan plan = policy.plan(queue, rays.count);
  if (plan.trial) {
    compare_modes(plan, rays.count, policy, queue, traced);
  } else {
    traced(plan.mode, 0, rays.count);
  }
}

}  // namespace

void trace_closest(const SceneData& scene, TraversalMode mode, const RayQueue& rays, int begin,
                   int end, HitArray& hits) {
  with_packets(mode.packets, [&](auto lanes, auto stream) {
    if constexpr (stream) {
      closest_stream<lanes>(embree(scene), mode.coherent, rays, begin, end, hits);
    } else {
      closest_packets<lanes>(embree(scene), mode.coherent, rays, begin, end, hits);
    }
  });
  if (mode.coherent) settle_ties(scene, rays, begin, end, hits);
  if (scene.features & bit(Feature::Spheres)) refine_distances(scene, rays, begin, end, hits);
}

// Debian's Embree 3.13.5 may never return from rtcOccluded16 with the coherent flag, nor from
// coherent streams, which use it, where there are instances: compiled for AVX-512 it writes 16 bits
// of a mask and reads 64, the rest being what the stack held. Packets of eight find the same.
LOCKSTEP_INLINE Packets safe_packets(const SceneData& scene, TraversalMode mode) {
  const bool in_danger = native_lanes == 16 && mode.coherent && mode.packets > Packets::Eight &&
                         (scene.features & bit(Feature::Instances));
  return in_danger ? Packets::Eight : mode.packets;
}

void trace_occluded(const SceneData& scene, TraversalMode mode, ShadowQueue& shadows, int begin,
                    int end) {
  with_packets(safe_packets(scene, mode), [&](auto lanes, auto stream) {
    if constexpr (stream) {
      occluded_stream<lanes>(embree(scene), mode.coherent, shadows, begin, end);
    } else {
      occluded_packets<lanes>(embree(scene), mode.coherent, shadows, begin, end);
    }
  });
}

void trace_closest(const SceneData& scene, TraversalPolicy& policy, RayKind kind, int bounce,
                   const RayQueue& rays, HitArray& hits, TileCounts& counts) {
  trace_planned(policy, kind, bounce, rays, counts, [&](TraversalMode mode, int begin, int end) {
    trace_closest(scene, mode, rays, begin, end, hits);
  });
}

void trace_occluded(const SceneData& scene, TraversalPolicy& policy, int bounce,
                    ShadowQueue& shadows, TileCounts& counts) {
  trace_planned(policy, RayKind::Shadow, bounce, shadows, counts,
                [&](TraversalMode mode, int begin, int end) {
                  trace_occluded(scene, mode, shadows, begin, end);
                });
}

void replay(const SceneData& scene, const RayLog& log, QueueRange queues, TraversalPolicy& policy,
            std::uint64_t* ticks) {
  const FlushDenormals flush;
  const auto rays = std::make_unique<RayQueue>();
  const auto shadows = std::make_unique<ShadowQueue>();
  const auto hits = std::make_unique<HitArray>();
  TileCounts counts;
  for (std::size_t q = queues.begin; q < queues.end; ++q) {
    const RayLog::Queue& queue = log.queues[q];
    const float* from = log.values.data() + queue.first;
    const auto load_rays = [&](auto& to) {
      to.count = queue.count;
      for (float* array : {to.origin.x, to.origin.y, to.origin.z, to.direction.x, to.direction.y,
                           to.direction.z}) {
        std::memcpy(array, from, size_t(queue.count) * sizeof(float));
        from += queue.count;
      }
    };
    if (queue.kind == RayKind::Shadow) {
      load_rays(*shadows);
      std::memcpy(shadows->distance, from, size_t(queue.count) * sizeof(float));
    } else {
      load_rays(*rays);
    }
    const std::uint64_t start = read_ticks();
    if (queue.kind == RayKind::Shadow) {
      trace_occluded(scene, policy, queue.bounce, *shadows, counts);
    } else {
      trace_closest(scene, policy, queue.kind, queue.bounce, *rays, *hits, counts);
    }
    *ticks++ = read_ticks() - start;
  }
}

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
