// lockstep demo: the comparison that shows what the program is for, in a minute and a half.
#include "core/read_scene.h"
#include "experiments/commands/commands.h"
#include "experiments/commands/compare_run.h"
#include "experiments/commands/demo_plan.h"
#include "experiments/commands/options.h"
#include "experiments/output/output_file.h"

#include <fmt/format.h>

#include <chrono>
#include <memory>

namespace lockstep {
namespace {

constexpr const char* kScene = "reef";
// owen beside them: it tells what a good sequence gains without any coherence.
constexpr const char* kSamplers[] = {"random", "owen", "cpt", "rcs", "strata"};
constexpr glm::ivec2 kFullResolution{480, 320};
constexpr double kPlannedSeconds = 65.0;  // of 90: the rest is for a machine that slows down
constexpr double kLatestSeconds = 75.0;   // no seed begins that would end later

struct DemoOptions {
  std::string directory = "out/demo";
  int threads = 0;
  bool quiet = false;
};

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// Seconds per path of a small render, after one that warms up.
double path_cost(const Scene& scene, const char* sampler, RenderSettings settings) {
  const SamplerSpec spec = parse_sampler(sampler);
  settings.spp = 4;
  render(scene, spec, settings);
  settings.spp = 8;
  const RenderStats stats = render(scene, spec, settings).stats;
  return stats.wall_seconds / double(std::max<std::uint64_t>(1, stats.paths));
}

PathCost measure_cost(RenderSettings settings) {
  SceneDescription description = read_scene(kScene);
  description.film.width = kFullResolution.x / 3;
  description.film.height = kFullResolution.y / 3;
  const Scene scene(std::move(description), embree_isa(settings.isa));
  settings.depth = scene.description().defaults.depth;
  PathCost cost;
  for (const char* sampler : kSamplers) {
    cost.sampled += path_cost(scene, sampler, settings) / double(std::size(kSamplers));
  }
  cost.reference = path_cost(scene, "owen", settings);
  return cost;
}

void run_demo(const DemoOptions& options) {
  const Clock::time_point start = Clock::now();
  make_output_directory(options.directory);
  CompareSettings settings;
  settings.scenes = {kScene};
  settings.directory = options.directory;
  settings.render.threads = options.threads;
  for (const char* sampler : kSamplers) settings.samplers.push_back(parse_sampler(sampler));

  const PathCost cost = measure_cost(settings.render);
  const int samplers = int(std::size(kSamplers));
  const DemoPlan plan =
      plan_demo(cost, kFullResolution, samplers, kPlannedSeconds - seconds_since(start));
  settings.resolution = plan.resolution;
  settings.rungs = plan.rungs;
  settings.seeds = plan.seeds;
  settings.reference_spp = plan.reference_spp;
  settings.timing_repeats = 0;  // the time is planned for other things
  settings.max_seconds = kLatestSeconds - seconds_since(start);
  if (!options.quiet) {
    fmt::print(
        "{} at {}x{}: {} with {} to {} samples per pixel and {} seeds,\n"
        "against a reference of {}. This takes about {:.0f} s.\n",
        kScene, plan.resolution.x, plan.resolution.y, fmt::join(kSamplers, ", "),
        plan.rungs.front(), plan.rungs.back(), plan.seeds, plan.reference_spp,
        plan.seconds + seconds_since(start));
    std::fflush(stdout);
  }
  run_comparison(settings, options.quiet);
}

}  // namespace

void add_demo_command(CLI::App& program, RunCommand& run) {
  CLI::App* command = program.add_subcommand("demo", "See an equal-time comparison in 90 seconds");
  command->description(
      "See an equal-time comparison in 90 seconds\n\n"
      "Compare independent sampling (random), coherent path tracing (cpt) and randomized coherent\n"
      "sampling (rcs) at equal time on a built-in scene, with the same low-discrepancy sequence\n"
      "in every pixel (owen) to tell its gain from that of coherence. Measures this machine's\n"
      "speed first and chooses resolution and repetitions so that all fits in 90 seconds.");
  command->footer(
      "Afterwards open DIR/report.html.\n"
      "\n"
      "Examples:\n"
      "  lockstep demo\n"
      "  lockstep demo -o out/one-thread --threads 1");
  auto options = std::make_shared<DemoOptions>();
  command->add_option("-o,--output", options->directory, "Folder for all results; made if missing")
      ->type_name("DIR")
      ->capture_default_str();
  command->add_option("--threads", options->threads, "Threads; 0 means one for each processor")
      ->type_name("N")
      ->check(whole_number_between(0, 4096))
      ->capture_default_str();
  command->add_flag("--quiet", options->quiet, "No progress; results, warnings and errors only");
  command->callback([options, &run] { run = [options] { run_demo(*options); }; });
}

}  // namespace lockstep
