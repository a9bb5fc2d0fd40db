// One render by several processes: one leads it and has the film, the others render tiles for it.
// How they talk to each other is not said here (experiments/distributed does).
#pragma once

#include "packets/render.h"
#include "packets/tile_pool.h"

#include <functional>
#include <memory>
#include <vector>

namespace lockstep {

// What all tiles of a pass have in common, beside scene, sampler and settings.
struct SharedPass {
  bool is_pilot = false;
  std::vector<float> weights;  // by pixel, where the sampler made a map for this pass
};

// How the process that leads gets help.
struct TileSharing {
  int parties = 1;  // processes, this one included
  // Others may take work from the pool from now on, and deliver it.
  std::function<void(const SharedPass& pass, TilePool& pool)> begin;
  // Nobody touches the pool any more once it returns.
  std::function<void()> end;
};

// The same image as render() without sharing, and who rendered what is no part of it.
RenderResult render(const Scene& scene, const SamplerSpec& sampler, const RenderSettings& settings,
                    const Progress& progress, const TileSharing& sharing);

// A process that helps: with the same scene, sampler and settings as the one that leads.
class TileRenderer {
 public:
  // `alive` is called after each tile, from one thread at a time; false stops (Cancelled).
  TileRenderer(const Scene& scene, const SamplerSpec& sampler, const RenderSettings& settings,
               Progress alive);
  ~TileRenderer();
  TileRenderer(const TileRenderer&) = delete;
  TileRenderer& operator=(const TileRenderer&) = delete;

  // What follows belongs to this pass.
  void begin(SharedPass pass);

  // Sums of the work, from `start` on (TilePool::start) or from 0 where that is empty. Costs are
  // added to `totals`.
  std::vector<double> render(const TileWork& work, const std::vector<double>& start,
                             PassTotals& totals);

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace lockstep
