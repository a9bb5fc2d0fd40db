#include "packets/coherence.h"

#include "core/embree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace lockstep {
namespace {

constexpr std::size_t most_packets = 4000;  // of a class that are looked at

// Value `field` of ray i: origin and direction, three each.
float value(const RayLog& log, const RayLog::Queue& queue, int field, int i) {
  return log.values[queue.first + std::size_t(field) * std::size_t(queue.count) + std::size_t(i)];
}

RTCHit closest_hit(RTCScene scene, const RayLog& log, const RayLog::Queue& queue, int i) {
  ClosestQuery query = closest_query(false);
  RTCRayHit ray{};
  ray.ray.org_x = value(log, queue, 0, i);
  ray.ray.org_y = value(log, queue, 1, i);
  ray.ray.org_z = value(log, queue, 2, i);
  ray.ray.dir_x = value(log, queue, 3, i);
  ray.ray.dir_y = value(log, queue, 4, i);
  ray.ray.dir_z = value(log, queue, 5, i);
  ray.ray.tfar = std::numeric_limits<float>::infinity();
  ray.ray.mask = ~0u;
  ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  trace(rtcIntersect1, scene, query, &ray);
  return ray.hit;
}

template <class T>
double distinct(std::vector<T>& values) {
  std::sort(values.begin(), values.end());
  return double(std::unique(values.begin(), values.end()) - values.begin());
}

// The length of the mean direction of rays [begin, end).
double mean_length(const RayLog& log, const RayLog::Queue& queue, int begin, int end) {
  double sum[3] = {};
  for (int i = begin; i < end; ++i) {
    double direction[3], square = 0.0;
    for (int axis = 0; axis < 3; ++axis) {
      direction[axis] = double(value(log, queue, 3 + axis, i));
      square += direction[axis] * direction[axis];
    }
    if (square <= 0.0) continue;
    for (int axis = 0; axis < 3; ++axis) sum[axis] += direction[axis] / std::sqrt(square);
  }
  return std::hypot(sum[0], sum[1], sum[2]) / double(end - begin);
}

void add_packet(const SceneData& scene, const RayLog& log, const RayLog::Queue& queue, int begin,
                Coherence& sum) {
  const int end = std::min(begin + coherence_lanes, queue.count);
  sum.lanes_active += double(end - begin) / coherence_lanes;
  sum.cosine += mean_length(log, queue, begin, end);
  if (queue.kind == RayKind::Shadow) return;
  std::vector<std::tuple<unsigned, unsigned, unsigned>> triangles;
  std::vector<std::int32_t> materials;
  for (int i = begin; i < end; ++i) {
    const RTCHit hit = closest_hit(static_cast<RTCScene>(scene.embree_scene), log, queue, i);
    if (hit.geomID == RTC_INVALID_GEOMETRY_ID) continue;
    triangles.emplace_back(hit.instID[0], hit.geomID, hit.primID);
    materials.push_back(scene.geometry.rows[std::size_t(hit.geomID) * geometry_stride + 1]);
  }
  sum.triangles += distinct(triangles);
  sum.materials += distinct(materials);
}

}  // namespace

std::vector<Coherence> coherence_of(const SceneData& scene, const RayLog& log,
                                    const std::vector<std::size_t>& class_of_queue,
                                    std::size_t classes) {
  const auto packets_of = [](const RayLog::Queue& queue) {
    return std::size_t(queue.count + coherence_lanes - 1) / coherence_lanes;
  };
  std::vector<std::size_t> packets(classes), seen(classes), taken(classes);
  for (std::size_t q = 0; q < log.queues.size(); ++q) {
    packets[class_of_queue[q]] += packets_of(log.queues[q]);
  }
  std::vector<Coherence> result(classes);
  for (std::size_t q = 0; q < log.queues.size(); ++q) {
    const std::size_t c = class_of_queue[q];
    const std::size_t step = (packets[c] + most_packets - 1) / most_packets;
    for (std::size_t p = 0; p < packets_of(log.queues[q]); ++p) {
      if (seen[c]++ % step != 0) continue;
      add_packet(scene, log, log.queues[q], int(p) * coherence_lanes, result[c]);
      ++taken[c];
    }
  }
  for (std::size_t c = 0; c < classes; ++c) {
    const double scale = 1.0 / double(std::max<std::size_t>(taken[c], 1));
    for (double* mean :
         {&result[c].lanes_active, &result[c].cosine, &result[c].triangles, &result[c].materials}) {
      *mean *= scale;
    }
  }
  return result;
}

}  // namespace lockstep
