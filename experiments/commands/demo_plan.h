// How much of a comparison fits into a given time on this machine.
#pragma once

#include <glm/vec2.hpp>

#include <vector>

namespace lockstep {

// Seconds of wall time for one path, measured with short renders.
struct PathCost {
  double sampled = 0.0;    // mean over the samplers compared
  double reference = 0.0;  // with the reference's sampler
};

struct DemoPlan {
  glm::ivec2 resolution{0};
  std::vector<int> rungs;
  int seeds = 0;
  int reference_spp = 0;
  double seconds = 0.0;  // what it should take
};

// The largest image, up to `full`, and the most samples for which at least four seeds fit into
// `seconds`; then as many seeds as fit.
DemoPlan plan_demo(const PathCost& cost, glm::ivec2 full, int samplers, double seconds);

}  // namespace lockstep
