// Traversal alone: the rays of a render traced again in every mode, on one thread. A line per kind
// of ray and bounce (interactions before the ray), whose counters are rays per second of CPU time
// by mode: the fixed ones, and `auto` for the measuring policy. The label names the fastest fixed
// mode, the time is the policy's. All lines of a scene and sampler come from one measurement, of
// medians, so --benchmark_repetitions repeats its figures.
#include "bench_main.h"
#include "bench_scene.h"
#include "packets/replay.h"

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace lockstep {
namespace {

constexpr std::uint32_t seed = 1;
constexpr int pixels = 256;  // the image's longer side
constexpr int spp = 2, depth = 3, repeats = 3;

struct RayClass {
  RayKind kind;
  int bounce;
};
constexpr RayClass classes[] = {{RayKind::Camera, 0}, {RayKind::Shadow, 0}, {RayKind::Bounce, 1},
                                {RayKind::Shadow, 1}, {RayKind::Bounce, 2}, {RayKind::Shadow, 2}};

constexpr const char* kind_names[] = {"camera", "bounce", "shadow"};  // by RayKind

const Replay& replay_of(const std::string& scene, const std::string& sampler) {
  static std::map<std::pair<std::string, std::string>, Replay> replays;
  const auto [entry, is_new] = replays.try_emplace({scene, sampler});
  if (is_new) {
    RenderSettings settings;
    settings.seed = seed;
    settings.depth = depth;
    settings.spp = spp;
    entry->second = replay(bench_scene(scene, pixels), parse_sampler(sampler), settings, repeats);
  }
  return entry->second;
}

void measure(benchmark::State& loop, const std::string& scene, const std::string& sampler,
             RayClass wanted) {
  const Replay& r = replay_of(scene, sampler);
  const auto c = std::find_if(r.classes.begin(), r.classes.end(), [&](const ReplayClass& x) {
    return x.kind == wanted.kind && x.bounce == wanted.bounce && x.rays > 0;
  });
  if (c == r.classes.end()) return loop.SkipWithError("the render has no such rays");
  for (auto _ : loop) loop.SetIterationTime(c->seconds[policy_replay]);
  for (int mode = 0; mode < replay_modes; ++mode) {
    if (c->seconds[mode] <= 0.0) continue;
    loop.counters[replay_name(mode)] = double(c->rays) / c->seconds[mode];
  }
  loop.SetLabel(replay_name(c->best_mode()));
}

void register_all() {
  for (const std::string& scene : bench_scene_names({"reef", "cornell", "killeroo-quad"})) {
    for (const char* sampler :
         {"owen", "cpt", "rcs:weight=0.03125,offset=constant", "rcs:weight=0.125,offset=constant",
          "rcs:weight=1,offset=constant"}) {
      for (const RayClass c : classes) {
        const std::string label =
            fmt::format("traversal/{}/{}/{}/{}{}/seed:{}", scene, sampler, name(choose_isa()),
                        kind_names[int(c.kind)], c.bounce, seed);
        benchmark::RegisterBenchmark(label.c_str(), measure, scene, sampler, c)
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
