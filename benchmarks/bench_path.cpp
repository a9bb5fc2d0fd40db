// Whole renders on one thread, pilot, filter and weights included, on the widest instruction set
// available (LOCKSTEP_ISA forces another).
//   path/...           camera paths per second of CPU time by scene, sampler, depth and width. So
//                      that widths are comparable, rays go in packets of the kernel's width and
//                      kernels are those for all features.
//   path/features/...  what kernels without the code that a scene does not need save: gain is the
//                      CPU time of the general kernel over that of the specialised one, median of
//                      renders in turn, with quartiles. The label lists what was left out.
#include "bench_main.h"
#include "bench_scene.h"
#include "bench_statistics.h"
#include "bench_traversal_mode.h"
#include "packets/kernel.h"

#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace lockstep {
namespace {

constexpr std::uint32_t seed = 1;
constexpr int pixels = 160;  // the image's longer side
constexpr int pairs = 7;

RenderSettings settings_for(int width, int depth, int spp) {
  RenderSettings settings;
  settings.seed = seed;
  settings.spp = spp;
  settings.depth = depth;
  settings.threads = 1;
  settings.width = width;
  settings.lanes = LaneLayout{};
  settings.traversal = packets_of(width);
  settings.specialized = false;
  return settings;
}

void trace(benchmark::State& loop, const std::string& scene, const std::string& sampler,
           const RenderSettings& settings) {
  const SamplerSpec spec = parse_sampler(sampler);
  RenderStats stats;
  double paths = 0.0;
  for (auto _ : loop) {
    stats = render(bench_scene(scene, pixels), spec, settings).stats;
    loop.SetIterationTime(stats.cpu_seconds);
    paths += double(stats.paths);
  }
  loop.counters["paths"] = benchmark::Counter(paths, benchmark::Counter::kIsRate);
  loop.counters["lanes"] = stats.lanes_active;
}

void compare_kernels(benchmark::State& loop, const std::string& scene_name,
                     RenderSettings settings) {
  const Scene& scene = bench_scene(scene_name, pixels);
  const SamplerSpec owen = parse_sampler("owen");
  std::vector<double> seconds[2], gains;  // by `specialized`
  double paths = 0.0;
  for (auto _ : loop) {
    for (int pair = 0; pair < pairs; ++pair) {
      for (const bool second : {false, true}) {
        settings.specialized = second != (pair % 2 == 1);  // in turn, so that drift cancels
        const RenderStats stats = render(scene, owen, settings).stats;
        seconds[settings.specialized].push_back(stats.cpu_seconds);
        paths = double(stats.paths);
      }
      gains.push_back(seconds[false].back() / seconds[true].back());
    }
    loop.SetIterationTime(median(seconds[true]));
  }
  loop.counters["general"] = paths / median(seconds[false]);
  loop.counters["specialised"] = paths / median(seconds[true]);
  loop.counters["gain"] = median(gains);
  loop.counters["gain_q1"] = quantile(gains, 0.25);
  loop.counters["gain_q3"] = quantile(gains, 0.75);
  const FeatureMask compiled = find_kernel(settings.isa, settings.width, scene.features()).features;
  loop.SetLabel(
      compiled == all_features
          ? "no smaller kernel for this scene"
          : fmt::format("without {}", fmt::join(feature_names(all_features & ~compiled), ", ")));
}

void register_widths() {
  for (const std::string& scene : bench_scene_names()) {
    for (const int depth : {1, 5}) {
      for (const char* sampler : {"random", "owen", "cpt", "rcs"}) {
        for (const int width : {1, 4, 8, 16}) {
          const RenderSettings settings = settings_for(width, depth, 4);
          const std::string label = fmt::format("path/{}/{}/{}/depth:{}/width:{}/seed:{}", scene,
                                                sampler, name(settings.isa), depth, width, seed);
          benchmark::RegisterBenchmark(label.c_str(), trace, scene, sampler, settings)
              ->UseManualTime()
              ->Unit(benchmark::kMillisecond)
              ->MinTime(0.1);
        }
      }
    }
  }
}

void register_features() {
  const int width = default_width(choose_isa());
  for (const std::string& scene :
       bench_scene_names({"killeroo-quad", "cornell", "reef", "meadow"})) {
    const RenderSettings settings = settings_for(width, 5, 8);
    const std::string label = fmt::format("path/features/{}/owen/{}/depth:{}/width:{}/seed:{}",
                                          scene, name(settings.isa), settings.depth, width, seed);
    benchmark::RegisterBenchmark(label.c_str(), compare_kernels, scene, settings)
        ->UseManualTime()
        ->Unit(benchmark::kMillisecond)
        ->Iterations(1);
  }
}

void register_all() {
  register_widths();
  register_features();
}

}  // namespace
}  // namespace lockstep

int main(int argc, char** argv) {
  return lockstep::run_benchmarks(argc, argv, lockstep::register_all);
}
