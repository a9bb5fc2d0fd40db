// Whole renders: paths per second of CPU time on one thread, by scene, sampler, depth and width, on
// the widest instruction set available (LOCKSTEP_ISA forces another). Pilot, filter and weights
// count.
#include "core/read_scene.h"
#include "core/scene.h"
#include "packets/render.h"

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <map>
#include <memory>

namespace lockstep {
namespace {

constexpr std::uint32_t seed = 1;
constexpr int image_width = 160, image_height = 120, spp = 8;

// Scenes are built when the first benchmark asks for them.
const Scene& scene_named(const std::string& name) {
  static std::map<std::string, std::unique_ptr<Scene>> scenes;
  std::unique_ptr<Scene>& scene = scenes[name];
  if (!scene) {
    SceneDescription description = read_scene(name);
    description.film.width = image_width;
    description.film.height = image_height;
    scene = std::make_unique<Scene>(std::move(description), embree_isa(choose_isa()));
  }
  return *scene;
}

void trace(benchmark::State& loop, const std::string& name, const std::string& sampler,
           RenderSettings settings) {
  const Scene& scene = scene_named(name);
  const SamplerSpec spec = parse_sampler(sampler);
  RenderStats stats;
  double paths = 0.0;
  for (auto _ : loop) {
    stats = render(scene, spec, settings).stats;
    loop.SetIterationTime(stats.cpu_seconds);
    paths += double(stats.paths);
  }
  loop.counters["paths"] = benchmark::Counter(paths, benchmark::Counter::kIsRate);
  loop.counters["lanes"] = stats.lanes_active;
}

void register_all() {
  RenderSettings settings;
  settings.seed = seed;
  settings.spp = spp;
  settings.threads = 1;
  for (const char* scene : {"cornell", "reef", "meadow", "spheres"}) {
    for (const int depth : {1, 5}) {
      for (const char* sampler : {"random", "owen", "cpt", "rcs"}) {
        for (const int width : {1, 4, 8, 16}) {
          settings.depth = depth;
          settings.width = width;
          const std::string label = fmt::format("path/{}/{}/{}/depth:{}/width:{}/seed:{}", scene,
                                                sampler, name(settings.isa), depth, width, seed);
          benchmark::RegisterBenchmark(label.c_str(), trace, scene, sampler, settings)
              ->UseManualTime()
              ->Unit(benchmark::kMillisecond)
              ->MinTime(0.15);
        }
      }
    }
  }
}

}  // namespace
}  // namespace lockstep

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  lockstep::register_all();
  benchmark::RunSpecifiedBenchmarks();
}
