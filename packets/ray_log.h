// The rays of a render, kept to be traced again: what traversal alone would cost.
#pragma once

#include "packets/traversal_mode.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace lockstep {

// Seven arrays, one value per ray.
struct RayArrays {
  const float* origin[3];
  const float* direction[3];
  const float* distance;  // up to which a shadow ray looks; null for closest hits
};

// [begin, end), by number.
struct QueueRange {
  std::size_t begin = 0, end = 0;
};

// In the order in which they were traced, queue by queue.
struct RayLog {
  struct Queue {
    RayKind kind;
    int bounce;  // interactions before the rays
    int count;
    std::size_t first;  // of its values: seven arrays of `count`, six for closest hits
  };
  std::vector<Queue> queues;
  std::vector<float> values;

  void append(RayKind kind, int bounce, int count, const RayArrays& rays);
};

}  // namespace lockstep
