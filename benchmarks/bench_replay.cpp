// How close whole renders come to the speed of traversal alone. The rays of a render are recorded
// and traced again in every fixed mode; counters give
//   limit_share    time of the best single mode for all rays / CPU time of the render,
//   limit_by_class the same with the best mode for each kind of ray and bounce,
//   policy         time of the best mode of each class / time under the measuring policy, the mode
//                  chosen in other repeats than it is timed in,
//   gain_single    single rays' time / time under the policy,
//   paths          camera paths per second of CPU time.
// Renders and replays alternate; figures are medians. One thread.
#include "bench_main.h"
#include "bench_scene.h"
#include "packets/replay.h"

#include <benchmark/benchmark.h>
#include <fmt/format.h>

namespace lockstep {
namespace {

constexpr std::uint32_t seed = 1;

void measure(benchmark::State& loop, const std::string& scene, const std::string& sampler,
             int depth) {
  RenderSettings settings;
  settings.seed = seed;
  settings.depth = depth;
  settings.spp = 16;
  Replay r;
  for (auto _ : loop) {
    r = replay(bench_scene(scene), parse_sampler(sampler), settings, 5);
    loop.SetIterationTime(r.render_seconds);
  }
  const double fixed = r.seconds(r.best_mode()), by_class = r.best_by_class_seconds();
  const double policy = r.seconds(policy_replay);
  loop.counters["limit_share"] = fixed / r.render_seconds;
  loop.counters["limit_by_class"] = by_class / r.render_seconds;
  loop.counters["policy"] = r.policy_share();
  loop.counters["gain_single"] = r.seconds(index({Packets::Single, false})) / policy;
  loop.counters["paths"] = double(r.stats.paths) / r.render_seconds;
  loop.SetLabel(to_string(traversal_mode(r.best_mode())));
}

void register_all() {
  for (const std::string& scene : bench_scene_names()) {
    for (const int depth : {1, 5}) {
      for (const char* sampler : {"owen", "cpt"}) {
        const std::string label =
            fmt::format("replay/{}/{}/depth:{}/seed:{}", scene, sampler, depth, seed);
        benchmark::RegisterBenchmark(label.c_str(), measure, scene, sampler, depth)
            ->UseManualTime()
            ->Unit(benchmark::kMillisecond)
            ->Iterations(1);
      }
    }
  }
}

}  // namespace
}  // namespace lockstep

int main(int argc, char** argv) {
  return lockstep::run_benchmarks(argc, argv, lockstep::register_all);
}
