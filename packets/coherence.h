// How alike the rays are that are traced together.
#pragma once

#include "core/scene_data.h"
#include "packets/ray_log.h"

#include <cstddef>
#include <vector>

namespace lockstep {

inline constexpr int coherence_lanes = 16;

// Means over packets of 16 rays that follow each other in their queues.
struct Coherence {
  double lanes_active = 0.0;  // share of lanes with a ray
  double cosine = 0.0;  // length of the mean of the unit directions: 1 where they are parallel
  // Different ones that the rays hit; 0 for shadow rays, whose hits nobody looks at.
  double triangles = 0.0;
  double materials = 0.0;

  double spread() const { return 1.0 - cosine; }  // of directions, 0 (parallel) to 1
};

// The coherence of each class of rays; `class_of_queue` holds a class below `classes` for each
// queue. Looks at some thousand packets of a class, evenly spaced.
std::vector<Coherence> coherence_of(const SceneData& scene, const RayLog& log,
                                    const std::vector<std::size_t>& class_of_queue,
                                    std::size_t classes);

}  // namespace lockstep
