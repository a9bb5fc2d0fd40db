// The tile pipeline: one tile of 16x16 pixels with 16 samples, from camera to film, by width and
// lane layout. Kernels for all features, and rays in packets of the kernel's width, so that widths
// are comparable. Every iteration traces the same paths: caches are warm. Counters give the time
// per path and each stage's share of it.
#include "bench_main.h"
#include "bench_scene.h"
#include "bench_traversal_mode.h"
#include "packets/film.h"
#include "packets/kernel.h"
#include "samplers/make_state.h"

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <cstdlib>
#include <cstring>
#include <memory>

namespace lockstep {
namespace {

constexpr std::uint32_t seed = 1;
constexpr std::uint32_t samples = 16;
constexpr int depth = 5;

constexpr const char* stage_names[] = {"sampling", "traversal", "shading", "film"};  // by Stage

struct Free {
  void operator()(void* p) const { std::free(p); }
};

std::unique_ptr<void, Free> make_scratch(const Kernel& kernel) {
  const std::size_t bytes = (kernel.scratch_bytes + 63) / 64 * 64;
  std::unique_ptr<void, Free> scratch(std::aligned_alloc(64, bytes));
  std::memset(scratch.get(), 0, bytes);
  return scratch;
}

void report(benchmark::State& loop, const TileCounts& counts) {
  loop.counters["per_path"] = benchmark::Counter(
      double(tile_size * tile_size) * samples,
      benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
  double all = 0.0;
  for (const std::uint64_t ticks : counts.ticks.of) all += double(ticks);
  for (int stage = 0; stage < stages; ++stage) {
    loop.counters[stage_names[stage]] = double(counts.ticks.of[stage]) / all;
  }
  loop.counters["lanes"] = double(counts.active_lanes) / double(counts.lanes);
}

void trace(benchmark::State& loop, const std::string& scene_name, const std::string& sampler,
           int width, LaneLayout lanes) {
  const Scene& scene = bench_scene(scene_name);
  const Kernel& kernel = find_kernel(choose_isa(), width);
  const SamplerState state = make_state(parse_sampler(sampler), seed);
  TraversalPolicy traversal(packets_of(width), width);
  LayoutPolicy layout(lanes);
  Film film(scene.data().camera.width, scene.data().camera.height);
  TileJob job;
  job.scene = &scene.data(), job.sampler = &state;
  job.traversal_policy = &traversal, job.layout_policy = &layout;
  job.path.depth = depth;
  job.film = film.view();
  job.x0 = film.width / 2 / tile_size * tile_size, job.x1 = job.x0 + tile_size;
  job.y0 = film.height / 2 / tile_size * tile_size, job.y1 = job.y0 + tile_size;
  job.samples = samples;
  const auto scratch = make_scratch(kernel);
  TileCounts counts;
  for (auto _ : loop) kernel.trace_tile(job, scratch.get(), counts);
  report(loop, counts);
}

void register_all() {
  for (const char* scene : {"cornell", "reef"}) {
    for (const char* sampler : {"owen", "cpt"}) {
      for (const LaneLayout lanes : {LaneLayout{4, 4, 1}, {2, 2, 4}, {1, 1, 16}}) {
        for (const int width : {1, 4, 8, 16}) {
          const std::string label =
              fmt::format("tile/{}/{}/{}/depth:{}/lanes:{}/width:{}/seed:{}", scene, sampler,
                          name(choose_isa()), depth, to_string(lanes), width, seed);
          benchmark::RegisterBenchmark(label.c_str(), trace, scene, sampler, width, lanes)
              ->Unit(benchmark::kMillisecond)
              ->MinTime(0.2);
        }
      }
    }
  }
}

}  // namespace
}  // namespace lockstep

int main(int argc, char** argv) {
  return lockstep::run_benchmarks(argc, argv, lockstep::register_all);
}
