// One pass over the image: a range of samples of every pixel, tiles spread over threads.
#pragma once

#include "packets/film.h"
#include "packets/kernel.h"

#include <tbb/enumerable_thread_specific.h>

#include <cstdlib>
#include <functional>
#include <memory>

namespace lockstep {

// What passes have cost so far.
struct PassTotals {
  TileCounts counts;
  double cpu_seconds = 0.0;  // thread CPU time inside tiles
};

// What a thread keeps from tile to tile.
struct Worker {
  struct Free {
    void operator()(void* p) const { std::free(p); }
  };
  std::unique_ptr<void, Free> scratch;  // the kernel's working memory
  TraversalPolicy traversal;
  LayoutPolicy layout;
  PassTotals totals;

  Worker(const TraversalPolicy& t, const LayoutPolicy& l) : traversal(t), layout(l) {}
};

// One per thread that has worked so far. They outlive passes, and so does what they have learnt.
using Workers = tbb::enumerable_thread_specific<Worker>;

struct Pass {
  const Kernel* kernel = nullptr;
  const SceneData* scene = nullptr;
  const SamplerState* sampler = nullptr;
  Workers* workers = nullptr;
  RayLog* log = nullptr;
  RenderSite site;  // what is rendered, for a thread that crashes
  PathSettings path;
  std::uint32_t samples = 1;
  int threads = 1;
  TileOrder order = TileOrder::Forward;
  // If set, called after each tile, from one thread at a time, while nobody writes to that tile.
  std::function<void(const TileJob&)> watch;
};

void add(PassTotals& to, const PassTotals& from);

// Part of a pass: tiles first, first + 1, ... in the order of rows, and samples of one block.
struct TileWork {
  std::int32_t first = 0;
  std::int32_t tiles = 0;
  std::uint32_t first_sample = 0;
  std::uint32_t samples = 0;
};

// Pixels [x0, x1) x [y0, y1).
struct TileArea {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};

int tile_count(const Film& film);
TileArea tile_area(const Film& film, int tile);

// Renders the work into the film's `sums` alone. Returns false where `tile_done` (see run_pass)
// asked to stop before all was done. Costs are added to `totals`.
bool run_tiles(const Pass& pass, Film& film, const TileWork& work, PassTotals& totals,
               const std::function<bool(double)>& tile_done);

// Adds samples [film.samples, film.samples + pass.samples), of one block, to the film. `tile_done`
// is called after each tile, from one thread at a time, with the share of this pass that is done;
// once it returns false no further tile begins. Where that left tiles out, film.samples stays, and
// the function returns false. Costs are added to `totals`.
bool run_pass(const Pass& pass, Film& film, PassTotals& totals,
              const std::function<bool(double)>& tile_done);

}  // namespace lockstep
