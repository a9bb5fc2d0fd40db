#include "packets/ray_log.h"

namespace lockstep {

void RayLog::append(RayKind kind, int bounce, int count, const RayArrays& rays) {
  if (count == 0) return;
  queues.push_back({kind, bounce, count, values.size()});
  const auto add = [&](const float* array) { values.insert(values.end(), array, array + count); };
  for (const float* array : rays.origin) add(array);
  for (const float* array : rays.direction) add(array);
  if (rays.distance) add(rays.distance);
}

}  // namespace lockstep
