// The boundary between host code and kernels: what a tile job is, and the table of kernels compiled
// for each instruction set and width.
#pragma once

#include "core/scene_data.h"
#include "packets/isa.h"
#include "packets/render.h"
#include "samplers/sampler_state.h"

#include <cstddef>
#include <cstdint>

namespace lockstep {

inline constexpr int tile_size = 16;  // pixels along each side

struct PathSettings {
  int depth = 5;
  int roulette_depth = 5;
  LaneLayout lanes;
  // Embree's coherent flag on the first interaction's shadow rays. It decides how rays are traced,
  // never what they hit.
  bool coherent_shadows = false;
};

// Sums over the samples of each pixel, in double: 2^24 samples of 1 would stop growing in float.
// A pixel belongs to one tile, so tiles run side by side without locks.
struct FilmView {
  int width = 0;
  double* sum = nullptr;           // RGB per pixel
  std::uint32_t* count = nullptr;  // finite samples per pixel
};

struct TileCounts {
  RayCounts rays;
  std::uint64_t lanes = 0;         // of all packets traced
  std::uint64_t active_lanes = 0;  // of which carried a ray
  std::uint64_t nonfinite = 0;
  static constexpr int kept = 8;
  BadSample bad[kept];  // the first min(nonfinite, kept)
};

// Samples [first_sample, first_sample + samples) of the pixels [x0, x1) x [y0, y1).
struct TileJob {
  const SceneData* scene = nullptr;
  const SamplerState* sampler = nullptr;
  PathSettings path;
  FilmView film;
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  std::uint32_t first_sample = 0;
  std::uint32_t samples = 1;
};

struct Kernel {
  Isa isa;
  int width;
  std::size_t scratch_bytes;  // 64-byte aligned memory that trace_tile works in
  void (*trace_tile)(const TileJob& job, void* scratch, TileCounts& counts);
  // Values of one pair for a batch: what the path integrator draws, exposed for the tests.
  void (*fill_pair)(const SamplerState&, const SampleBatch&, int pair, float* u, float* v);
};

// The kernel for an instruction set and 1, 4, 8 or 16 lanes (0: the default width).
// Throws UsageError for another width.
const Kernel& find_kernel(Isa isa, int width);

}  // namespace lockstep
