// The renderer as the experiments see it: a scene, a sampler and settings in; an image, its weight
// map and what was paid for it out.
#pragma once

#include "core/image.h"
#include "core/scene.h"
#include "packets/isa.h"
#include "packets/lane_layout.h"
#include "packets/stage_clock.h"
#include "packets/tile_order.h"
#include "packets/traversal_mode.h"
#include "samplers/sampler_spec.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace lockstep {

struct RayLog;

struct RenderSettings {
  std::uint32_t seed = 0;
  int spp = 16;               // samples per pixel in all, pilot included
  double time_seconds = 0.0;  // if positive: as many samples as fit into this wall time
  int depth = 5;              // surface interactions that are lit; 1 is direct light only
  int roulette_depth = 5;     // Russian roulette from this many interactions on
  int threads = 0;            // 0: all cores
  int width = 0;              // SIMD lanes: 1, 4, 8, 16; 0: the instruction set's default
  // Measured and chosen while rendering where not given.
  std::optional<LaneLayout> lanes;
  std::optional<TraversalMode> traversal;
  // If set: the luminance that a sample may have at most; brighter ones are scaled down to it. That
  // takes away fireflies, and the light they stand for: the image is biased.
  std::optional<float> clamp;
  TileOrder tile_order = TileOrder::Forward;
  bool specialized = true;  // kernels without the code that the scene does not need
  Isa isa = choose_isa();
  std::string scene_name;  // for messages, as is
  std::string command;     // that renders the image again; may be empty
  RayLog* log = nullptr;   // if set, gets all rays; with one thread only
  // If not empty: the film is kept in this file as the render goes on, and a render that finds it
  // there continues it. Throws Error where it was made with other settings.
  std::string resume_file;
  // If set, gets the image as it forms: each tile that samples were added to, and where its upper
  // left pixel is. Means of the pilot's samples while that is rendered, then of those that follow.
  // From one thread at a time; the render waits for it.
  std::function<void(int x, int y, const Image& tile)> watch;
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
  std::uint64_t traced[ray_kinds][traversal_modes] = {};  // rays, by RayKind and index(mode)
  std::uint64_t packets = 0;
  double stage_seconds[stages] = {};  // CPU time by Stage
  double lanes_active = 1.0;  // share of packet lanes that carried a ray, over all packets traced
  std::uint64_t clamped = 0;  // samples: see RenderSettings::clamp
  std::uint64_t nonfinite = 0;
  std::vector<BadSample> bad_samples;  // the first few of them
  int spp = 0;                         // samples per pixel that were taken
  int pilot_spp = 0;                   // of which for the pilot
  double mean_weight = 0.0;            // of the perturbation; 1 for independent pixels
  double zero_weights = 0.0;           // share of pixels with weight 0
  std::size_t film_bytes = 0;          // sums and image, pilot included
  int width = 0;
  LaneLayout lanes;  // of most paths
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
