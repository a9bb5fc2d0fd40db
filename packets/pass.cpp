#include "packets/pass.h"

#include "core/cpu_clock.h"
#include "packets/signal_stack.h"

#include <tbb/blocked_range.h>
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

void count_layout(TileCounts& counts, const LayoutCount& added) {
  if (added.paths == 0) return;
  LayoutCount* at = counts.layouts;
  const LayoutCount* last = std::end(counts.layouts) - 1;
  while (at != last && at->paths > 0 && at->lanes != added.lanes) ++at;
  if (at->paths == 0) at->lanes = added.lanes;
  at->paths += added.paths;
}

namespace {

int columns_of(const Film& film) { return (film.width + tile_size - 1) / tile_size; }
int rows_of(const Film& film) { return (film.height + tile_size - 1) / tile_size; }

// What renders tiles of a film on any thread, until it is asked to stop.
struct Tracer {
  const Pass& pass;
  Film& film;
  TileWork work;
  const std::function<bool(double)>& tile_done;
  std::mutex report = {};
  int done = 0;
  std::atomic<bool> stopped = false, skipped = false;

  void operator()(int tile) {
    if (stopped) {
      skipped = true;
    } else {
      trace(tile);
    }
  }

  void trace(int tile) {
    give_signal_stack();
    Worker& worker = pass.workers->local();
    const double start = thread_cpu_seconds();
    const TileArea area = tile_area(film, tile);
    TileJob job;
    job.scene = pass.scene, job.sampler = pass.sampler, job.path = pass.path;
    job.traversal_policy = &worker.traversal, job.layout_policy = &worker.layout;
    job.log = pass.log, job.site = &render_site();
    job.film = film.view();
    job.x0 = area.x0, job.x1 = area.x1;
    job.y0 = area.y0, job.y1 = area.y1;
    job.first_sample = work.first_sample;
    job.samples = work.samples;
    const SiteScope site(pass.site);
    pass.kernel->trace_tile(job, scratch_of(worker, pass.kernel->scratch_bytes),
                            worker.totals.counts);
    worker.totals.cpu_seconds += thread_cpu_seconds() - start;
    const std::lock_guard lock(report);
    if (pass.watch) pass.watch(job);
    if (!tile_done(double(++done) / double(work.tiles))) stopped = true;
  }

  // Returns whether all was done.
  bool finish(PassTotals& totals) {
    for (Worker& worker : *pass.workers) {
      add(totals, worker.totals);
      worker.totals = {};
    }
    return !skipped;
  }
};

}  // namespace

int tile_count(const Film& film) { return columns_of(film) * rows_of(film); }

TileArea tile_area(const Film& film, int tile) {
  const int x0 = tile % columns_of(film) * tile_size, y0 = tile / columns_of(film) * tile_size;
  return {x0, y0, std::min(x0 + tile_size, film.width), std::min(y0 + tile_size, film.height)};
}

bool run_tiles(const Pass& pass, Film& film, const TileWork& work, PassTotals& totals,
               const std::function<bool(double)>& tile_done) {
  Tracer tracer{pass, film, work, tile_done};
  tbb::task_arena(pass.threads).execute([&] {
    tbb::parallel_for(
        tbb::blocked_range<int>(work.first, work.first + work.tiles),
        [&](const tbb::blocked_range<int>& range) {
          for (int tile = range.begin(); tile < range.end(); ++tile) tracer(tile);
        },
        tbb::simple_partitioner());
  });
  return tracer.finish(totals);
}

bool run_pass(const Pass& pass, Film& film, PassTotals& totals,
              const std::function<bool(double)>& tile_done) {
  begin_block(film);
  const int columns = columns_of(film), rows = rows_of(film);
  Tracer tracer{pass, film, {0, columns * rows, film.samples, pass.samples}, tile_done};
  tbb::task_arena(pass.threads).execute([&] {
    tbb::parallel_for(
        tbb::blocked_range2d<int>(0, rows, 1, 0, columns, 1),
        [&](const tbb::blocked_range2d<int>& range) {
          for (int row = range.rows().begin(); row < range.rows().end(); ++row) {
            for (int column = range.cols().begin(); column < range.cols().end(); ++column) {
              tracer(tile_at(pass.order, row * columns + column, columns * rows));
            }
          }
        },
        tbb::simple_partitioner());
  });
  if (!tracer.finish(totals)) return false;
  film.samples += pass.samples;
  return true;
}

}  // namespace lockstep
