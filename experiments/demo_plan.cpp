#include "experiments/demo_plan.h"

#include <algorithm>
#include <numeric>

namespace lockstep {
namespace {

constexpr int kFewestSeeds = 4;
constexpr int kMostSeeds = 16;
constexpr double kScales[] = {1.0, 0.75, 0.5, 0.375, 0.25};  // of the image's sides

struct Samples {
  std::vector<int> rungs;
  int reference_spp;
};

DemoPlan plan_at(const PathCost& cost, glm::ivec2 full, double scale, const Samples& samples,
                 int samplers, double seconds) {
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
  const Samples choices[] = {{{4, 8, 16, 32, 64}, 1024}, {{4, 8, 16}, 256}, {{4, 8}, 64}};
  DemoPlan plan;
  for (const Samples& samples : choices) {
    for (double scale : kScales) {
      plan = plan_at(cost, full, scale, samples, samplers, seconds);
      if (plan.seconds <= seconds) return plan;
    }
  }
  return plan;
}

}  // namespace lockstep
