#include "packets/pass.h"

#include "core/cpu_clock.h"
#include "packets/signal_stack.h"

#include <tbb/blocked_range2d.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <cstring>
#include <mutex>
#include <new>
#include <numeric>

namespace lockstep {
namespace {

void* scratch_of(Worker& worker, std::size_t bytes) {
  if (!worker.scratch) {
    const std::size_t rounded = (bytes + 63) / 64 * 64;
    void* memory = std::aligned_alloc(64, rounded);
    if (!memory) throw std::bad_alloc();
    worker.scratch.reset(std::memset(memory, 0, rounded));
  }
  return worker.scratch.get();
}

void add(PassTotals& to, const PassTotals& from) {
  const TileCounts& f = from.counts;
  TileCounts& t = to.counts;
  for (std::uint64_t i = 0; i < std::min<std::uint64_t>(f.nonfinite, TileCounts::kept); ++i) {
    if (t.nonfinite + i < TileCounts::kept) t.bad[t.nonfinite + i] = f.bad[i];
  }
  for (int kind = 0; kind < ray_kinds; ++kind) {
    for (int mode = 0; mode < traversal_modes; ++mode) t.traced[kind][mode] += f.traced[kind][mode];
  }
  for (int stage = 0; stage < stages; ++stage) t.ticks.of[stage] += f.ticks.of[stage];
  for (const LayoutCount& layout : f.layouts) count_layout(t, layout);
  t.packets += f.packets;
  t.lanes += f.lanes;
  t.active_lanes += f.active_lanes;
  t.clamped += f.clamped;
  t.nonfinite += f.nonfinite;
  to.cpu_seconds += from.cpu_seconds;
}

// Says where the thread is for as long as this lives.
class SiteScope {
 public:
  explicit SiteScope(const RenderSite& site) { render_site() = site; }
  ~SiteScope() { render_site() = {}; }
  SiteScope(const SiteScope&) = delete;
  SiteScope& operator=(const SiteScope&) = delete;
};

// The tile that comes at this place of an order: every place has another.
int tile_at(TileOrder tile_order, int place, int tiles) {
  if (tile_order == TileOrder::Forward) return place;
  if (tile_order == TileOrder::Backward) return tiles - 1 - place;
  int step = std::max(1, int(0.618 * tiles));
  while (std::gcd(step, tiles) != 1) ++step;
  return int(std::int64_t(place) * step % tiles);
}

}  // namespace

void count_layout(TileCounts& counts, const LayoutCount& added) {
  if (added.paths == 0) return;
  LayoutCount* at = counts.layouts;
  const LayoutCount* last = std::end(counts.layouts) - 1;
  while (at != last && at->paths > 0 && at->lanes != added.lanes) ++at;
  if (at->paths == 0) at->lanes = added.lanes;
  at->paths += added.paths;
}

bool run_pass(const Pass& pass, Film& film, PassTotals& totals,
              const std::function<bool(double)>& tile_done) {
  const int columns = (film.width + tile_size - 1) / tile_size;
  const int rows = (film.height + tile_size - 1) / tile_size;
  std::mutex report;
  int done = 0;
  std::atomic<bool> stopped = false, skipped = false;

  const auto trace = [&](int tile) {
    give_signal_stack();
    const int column = tile % columns, row = tile / columns;
    Worker& worker = pass.workers->local();
    const double start = thread_cpu_seconds();
    TileJob job;
    job.scene = pass.scene, job.sampler = pass.sampler, job.path = pass.path;
    job.traversal_policy = &worker.traversal, job.layout_policy = &worker.layout;
    job.log = pass.log, job.site = &render_site();
    job.film = film.view();
    job.x0 = column * tile_size, job.x1 = std::min(job.x0 + tile_size, film.width);
    job.y0 = row * tile_size, job.y1 = std::min(job.y0 + tile_size, film.height);
    job.first_sample = film.samples;
    job.samples = pass.samples;
    const SiteScope site(pass.site);
    pass.kernel->trace_tile(job, scratch_of(worker, pass.kernel->scratch_bytes),
                            worker.totals.counts);
    worker.totals.cpu_seconds += thread_cpu_seconds() - start;
    const std::lock_guard lock(report);
    if (pass.watch) pass.watch(job);
    if (!tile_done(double(++done) / (double(columns) * rows))) stopped = true;
  };

  tbb::task_arena(pass.threads).execute([&] {
    tbb::parallel_for(
        tbb::blocked_range2d<int>(0, rows, 1, 0, columns, 1),
        [&](const tbb::blocked_range2d<int>& range) {
          for (int row = range.rows().begin(); row < range.rows().end(); ++row) {
            for (int column = range.cols().begin(); column < range.cols().end(); ++column) {
              if (stopped) {
                skipped = true;
              } else {
                trace(tile_at(pass.order, row * columns + column, columns * rows));
              }
            }
          }
        },
        tbb::simple_partitioner());
  });
  for (Worker& worker : *pass.workers) {
    add(totals, worker.totals);
    worker.totals = {};
  }
  if (skipped) return false;
  film.samples += pass.samples;
  return true;
}

}  // namespace lockstep
