// What threads give: whole renders with one thread and with several in turn, with the settings that
// users get. Counters, medians over the repeats:
//   speedup    wall time with one thread / with several; quartiles beside it,
//   cpu_ratio  CPU time with several threads / with one: above 1 where they get in each other's
//   way.
#include "bench_main.h"
#include "bench_scene.h"
#include "bench_statistics.h"
#include "packets/render.h"

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <set>
#include <thread>

namespace lockstep {
namespace {

constexpr std::uint32_t seed = 1;
constexpr int spp = 8, depth = 5, repeats = 7;

void measure(benchmark::State& loop, const std::string& scene_name, int threads) {
  const Scene& scene = bench_scene(scene_name);
  const SamplerSpec sampler = parse_sampler("owen");
  RenderSettings settings;
  settings.seed = seed;
  settings.spp = spp;
  settings.depth = depth;
  const auto render_with = [&](int n) {
    settings.threads = n;
    return render(scene, sampler, settings).stats;
  };
  std::vector<double> speedup, cpu_ratio, seconds;
  for (auto _ : loop) {
    render_with(threads);  // the first render starts the threads
    for (int repeat = 0; repeat < repeats; ++repeat) {
      const bool several_first = repeat % 2 == 1;
      const RenderStats first = render_with(several_first ? threads : 1);
      const RenderStats second = render_with(several_first ? 1 : threads);
      const RenderStats& one = several_first ? second : first;
      const RenderStats& several = several_first ? first : second;
      seconds.push_back(several.wall_seconds);
      speedup.push_back(one.wall_seconds / several.wall_seconds);
      cpu_ratio.push_back(several.cpu_seconds / one.cpu_seconds);
    }
    loop.SetIterationTime(median(seconds));
  }
  loop.counters["speedup"] = median(speedup);
  loop.counters["speedup_q1"] = quantile(speedup, 0.25);
  loop.counters["speedup_q3"] = quantile(speedup, 0.75);
  loop.counters["cpu_ratio"] = median(cpu_ratio);
}

void register_all() {
  const std::set<int> thread_counts{2, std::max(2, int(std::thread::hardware_concurrency()))};
  for (const char* scene : {"reef", "cornell"}) {
    for (const int threads : thread_counts) {
      const std::string label = fmt::format("threads/{}/owen/{}/depth:{}/threads:{}/seed:{}", scene,
                                            name(choose_isa()), depth, threads, seed);
      benchmark::RegisterBenchmark(label.c_str(), measure, scene, threads)
          ->UseManualTime()
          ->Unit(benchmark::kMillisecond)
          ->Iterations(1);
    }
  }
}

}  // namespace
}  // namespace lockstep

int main(int argc, char** argv) {
  return lockstep::run_benchmarks(argc, argv, lockstep::register_all);
}
