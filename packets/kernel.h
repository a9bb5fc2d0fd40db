// The boundary between host code and kernels: what a tile job is, and the table of kernels compiled
// for each instruction set and width.
#pragma once

#include "core/scene_data.h"
#include "packets/isa.h"
#include "packets/layout_policy.h"
#include "packets/ray_log.h"
#include "packets/render.h"
#include "packets/render_site.h"
#include "packets/stage_clock.h"
#include "packets/traversal_policy.h"
#include "samplers/sampler_state.h"

#include <cstddef>
#include <cstdint>
#include <limits>

namespace lockstep {

inline constexpr int tile_size = share_tile;  // pixels along each side

struct PathSettings {
  int depth = 5;
  int roulette_depth = 5;
  float clamp = std::numeric_limits<float>::infinity();  // see RenderSettings
};

// Sums over the samples of each pixel, in double: 2^24 samples of 1 would stop growing in float.
// A pixel belongs to one tile, so tiles run side by side without locks.
struct FilmView {
  int width = 0;
  double* sums = nullptr;  // RGB and the number of finite samples, per pixel
};

// Camera paths that were traced in one lane layout.
struct LayoutCount {
  LaneLayout lanes;
  std::uint64_t paths = 0;
};

struct TileCounts {
  std::uint64_t traced[ray_kinds][traversal_modes] = {};  // rays
  std::uint64_t packets = 0;                              // traced; single rays are packets of one
  std::uint64_t lanes = 0;                                // of all packets traced
  std::uint64_t active_lanes = 0;                         // of which carried a ray
  LayoutCount layouts[3] = {};  // the first come, of which there are no more
  StageTicks ticks;
  std::uint64_t clamped = 0;  // samples
  std::uint64_t nonfinite = 0;
  static constexpr int kept = 8;
  BadSample bad[kept];  // the first min(nonfinite, kept)
};

// Adds to the paths counted for that layout; a fourth layout counts with the last.
void count_layout(TileCounts& counts, const LayoutCount& added);

// Samples [first_sample, first_sample + samples) of the pixels [x0, x1) x [y0, y1).
struct TileJob {
  const SceneData* scene = nullptr;
  const SamplerState* sampler = nullptr;
  TraversalPolicy* traversal_policy = nullptr;
  LayoutPolicy* layout_policy = nullptr;
  RayLog* log = nullptr;       // gets all rays, if set
  RenderSite* site = nullptr;  // is kept up to date, if set
  PathSettings path;
  FilmView film;
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  std::uint32_t first_sample = 0;
  std::uint32_t samples = 1;
  LaneLayout lanes;  // of a wave
};

struct Kernel {
  Isa isa;
  int width;
  FeatureMask features;       // that it is compiled for: scenes with others need another kernel
  std::size_t scratch_bytes;  // 64-byte aligned memory that trace_tile works in
  void (*trace_tile)(const TileJob& job, void* scratch, TileCounts& counts);
  // Traces the rays of some of the log's queues again as the policy says, and tells the ticks of
  // each queue.
  void (*replay)(const SceneData& scene, const RayLog& log, QueueRange queues,
                 TraversalPolicy& policy, std::uint64_t* ticks);
  // Values of one pair for a batch: what the path integrator draws, exposed for the tests.
  void (*fill_pair)(const SamplerState&, const SampleBatch&, int pair, float* u, float* v);
};

// The kernel for an instruction set and 1, 4, 8 or 16 lanes (0: the default width) with the least
// code that a scene with these features needs. Throws UsageError for another width.
const Kernel& find_kernel(Isa isa, int width, FeatureMask features = all_features);

}  // namespace lockstep
