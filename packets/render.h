// The renderer as the experiments see it: a scene, a sampler and settings in; an image, its weight
// map and what was paid for it out.
#pragma once

#include "core/image.h"
#include "core/scene.h"
#include "packets/isa.h"
#include "samplers/sampler_spec.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace lockstep {

// How a packet's lanes map to pixels and samples: x * y pixels, `samples` of each.
struct LaneLayout {
  int x = 4;
  int y = 4;
  int samples = 1;
};

// "auto" or "XxYxS", powers of two whose product is at most 256. Throws UsageError.
LaneLayout parse_lane_layout(std::string_view text);

struct RenderSettings {
  std::uint32_t seed = 0;
  int spp = 16;               // samples per pixel in all, pilot included
  double time_seconds = 0.0;  // if positive: as many samples as fit into this wall time
  int depth = 5;              // surface interactions that are lit; 1 is direct light only
  int roulette_depth = 5;     // Russian roulette from this many interactions on
  int threads = 0;            // 0: all cores
  int width = 0;              // SIMD lanes: 1, 4, 8, 16; 0: the instruction set's default
  LaneLayout lanes;
  bool lanes_auto = true;     // 4x4x1, near the best layout wherever measured
  Isa isa = choose_isa();
  // If not empty: the film is kept in this file as the render goes on, and a render that finds it
  // there continues it. Throws Error where it was made with other settings.
  std::string resume_file;
};

struct RayCounts {
  std::uint64_t camera = 0;
  std::uint64_t bounce = 0;
  std::uint64_t shadow = 0;
};

// A sample whose radiance was not finite: left out of the image, and reported.
struct BadSample {
  int x = 0;
  int y = 0;
  std::uint32_t sample = 0;
};

// What a render cost; pilot, filter and weights are included in every figure.
struct RenderStats {
  double wall_seconds = 0.0;
  double cpu_seconds = 0.0;  // thread CPU time, summed over the threads that worked
  std::uint64_t paths = 0;
  RayCounts rays;
  double lanes_active = 1.0;  // share of packet lanes that carried a ray, over all packets traced
  std::uint64_t nonfinite = 0;
  std::vector<BadSample> bad_samples;  // the first few of them
  int spp = 0;                         // samples per pixel that were taken
  int pilot_spp = 0;                   // of which for the pilot
  double mean_weight = 0.0;            // of the perturbation; 1 for independent pixels
  int width = 0;
  LaneLayout lanes;
  int threads = 0;
};

struct RenderResult {
  Image image;
  std::optional<Image> weights;  // one channel, where the sampler made a map
  RenderStats stats;
};

// Called from time to time with the share of the work done, from one thread at a time.
// Returning false stops the render at the next tile (render() then throws Cancelled).
using Progress = std::function<bool(double fraction)>;

struct Cancelled : std::runtime_error {
  Cancelled() : std::runtime_error("stopped by the user") {}
};

RenderResult render(const Scene& scene, const SamplerSpec& sampler, const RenderSettings& settings,
                    const Progress& progress = {});

}  // namespace lockstep
