// Boxes around what a scene holds.
#pragma once

#include "core/scene_description.h"

#include <glm/common.hpp>

#include <limits>

namespace lockstep {

// Along the axes; empty where `lo` is above `hi`.
struct Bounds {
  glm::vec3 lo{std::numeric_limits<float>::max()}, hi{-std::numeric_limits<float>::max()};

  bool empty() const { return lo.x > hi.x; }
  void grow(glm::vec3 p, glm::vec3 radius = glm::vec3(0.0f)) {
    lo = glm::min(lo, p - radius);
    hi = glm::max(hi, p + radius);
  }
};

// Around all shapes in the world; of instances around the boxes of their objects.
Bounds bounds_of(const SceneDescription& scene);

}  // namespace lockstep
