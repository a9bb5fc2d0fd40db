#include "experiments/commands/demo_plan.h"

#include <algorithm>
#include <numeric>

namespace lockstep {
namespace {

constexpr int kFewestSeeds = 4;
constexpr int kMostSeeds = 16;

struct Samples {
  std::vector<int> rungs;
  int reference_spp;
};

// A size of comparison: a factor on the image's sides, and how many samples.
struct Candidate {
  double scale;
  Samples samples;
};

// Best first. Small images and few samples both make a poor show: they shrink in turn.
std::vector<Candidate> candidates() {
  const Samples many{{4, 8, 16, 32, 64}, 1024};
  const Samples some{{4, 8, 16, 32}, 512};
  const Samples few{{4, 8, 16}, 256};
  return {{1.0, many}, {0.75, many}, {0.75, some}, {0.5, many},         {0.5, some},
          {0.5, few},  {0.375, few}, {0.25, few},  {0.25, {{4, 8}, 64}}};
}

DemoPlan plan_at(const PathCost& cost, glm::ivec2 full, const Candidate& candidate, int samplers,
                 double seconds) {
  const auto& [scale, samples] = candidate;
  DemoPlan plan;
  plan.resolution = {std::max(16, int(full.x * scale)), std::max(16, int(full.y * scale))};
  plan.rungs = samples.rungs;
  plan.reference_spp = samples.reference_spp;
  const double pixels = double(plan.resolution.x) * plan.resolution.y;
  const double reference = pixels * samples.reference_spp * cost.reference;
  const double seed = pixels * cost.sampled * samplers *
                      std::accumulate(samples.rungs.begin(), samples.rungs.end(), 0);
  const double affordable = std::max(0.0, (seconds - reference) / std::max(seed, 1e-12));
  plan.seeds = int(std::clamp(affordable, double(kFewestSeeds), double(kMostSeeds)));
  plan.seconds = reference + plan.seeds * seed;
  return plan;
}

}  // namespace

DemoPlan plan_demo(const PathCost& cost, glm::ivec2 full, int samplers, double seconds) {
  DemoPlan plan;
  for (const Candidate& candidate : candidates()) {
    plan = plan_at(cost, full, candidate, samplers, seconds);
    if (plan.seconds <= seconds) break;
  }
  return plan;
}

}  // namespace lockstep
