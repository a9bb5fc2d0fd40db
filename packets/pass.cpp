#include "packets/pass.h"

#include "core/cpu_clock.h"

#include <tbb/blocked_range2d.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <mutex>
#include <new>

namespace lockstep {
namespace {

// A kernel's working memory and what it counted, one per thread.
struct Worker {
  struct Free {
    void operator()(void* p) const { std::free(p); }
  };
  std::unique_ptr<void, Free> scratch;
  PassTotals totals;
};

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
  t.rays.camera += f.rays.camera;
  t.rays.bounce += f.rays.bounce;
  t.rays.shadow += f.rays.shadow;
  t.lanes += f.lanes;
  t.active_lanes += f.active_lanes;
  t.nonfinite += f.nonfinite;
  to.cpu_seconds += from.cpu_seconds;
}

}  // namespace

bool run_pass(const Pass& pass, Film& film, PassTotals& totals,
              const std::function<bool(double)>& tile_done) {
  const int columns = (film.width + tile_size - 1) / tile_size;
  const int rows = (film.height + tile_size - 1) / tile_size;
  tbb::enumerable_thread_specific<Worker> workers;
  std::mutex report;
  int done = 0;
  std::atomic<bool> stopped = false, skipped = false;

  const auto trace = [&](int column, int row) {
    Worker& worker = workers.local();
    const double start = thread_cpu_seconds();
    TileJob job{pass.scene, pass.sampler, pass.path, film.view()};
    job.x0 = column * tile_size, job.x1 = std::min(job.x0 + tile_size, film.width);
    job.y0 = row * tile_size, job.y1 = std::min(job.y0 + tile_size, film.height);
    job.first_sample = film.samples;
    job.samples = pass.samples;
    pass.kernel->trace_tile(job, scratch_of(worker, pass.kernel->scratch_bytes),
                            worker.totals.counts);
    worker.totals.cpu_seconds += thread_cpu_seconds() - start;
    const std::lock_guard lock(report);
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
                trace(column, row);
              }
            }
          }
        },
        tbb::simple_partitioner());
  });
  for (const Worker& worker : workers) add(totals, worker.totals);
  if (skipped) return false;
  film.samples += pass.samples;
  return true;
}

}  // namespace lockstep
