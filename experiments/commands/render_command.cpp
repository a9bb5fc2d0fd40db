// lockstep render: one image of one scene.
#include "experiments/output/render_command.h"
#include "core/error.h"
#include "experiments/commands/commands.h"
#include "experiments/commands/options.h"
#include "experiments/distributed/agreement.h"
#include "experiments/distributed/session.h"
#include "experiments/distributed/shared_tiles.h"
#include "experiments/output/activity.h"
#include "experiments/output/command_line.h"
#include "experiments/output/output_file.h"
#include "experiments/output/progress.h"
#include "experiments/output/render_metadata.h"
#include "experiments/output/render_stats_json.h"
#include "experiments/output/tev_display.h"

#include <fmt/format.h>

#include <memory>
#include <optional>

namespace lockstep {
namespace {

struct RenderOptions {
  RendererOptions renderer;
  std::string scene, output, sampler = "random", stats, weights, display;
  std::optional<int> spp;
  std::optional<double> time;
  std::uint32_t seed = 0;
  double rank_timeout = 60.0;
  bool resume = false;
  bool quiet = false;
};

// Everything about the command line that can be wrong is found before the scene is read.
void check_outputs(const RenderOptions& options, const SamplerSpec& sampler) {
  check_writable_image(options.output);
  const std::string* outputs[] = {&options.output, &options.stats, &options.weights};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < i; ++j) {
      if (!outputs[i]->empty() && *outputs[i] == *outputs[j]) {
        throw UsageError(fmt::format("{}: named for two outputs; give each its own", *outputs[i]));
      }
    }
  }
  if (!options.stats.empty()) check_writable(options.stats);
  if (options.weights.empty()) return;
  if (!sampler.has_pilot()) {
    throw UsageError(fmt::format(
        "--weights: {} makes no weight map; use rcs or leave --weights out", to_string(sampler)));
  }
  check_writable_image(options.weights);
}

void report_nonfinite(const RenderStats& stats, const RenderSettings& settings) {
  if (stats.nonfinite == 0) return;
  for (const BadSample& bad : stats.bad_samples) {
    fmt::print(stderr, "{}", nonfinite_text(bad, settings.seed, settings.command));
  }
  fmt::print(stderr,
             "lockstep: warning: {} samples were not finite and were left out of the image\n",
             stats.nonfinite);
}

void report_done(const RenderOptions& options, const RenderSettings& settings,
                 const RenderStats& stats) {
  const double rate =
      stats.cpu_seconds > 0.0 ? 1e-6 * double(stats.paths) / stats.cpu_seconds : 0.0;
  fmt::print(
      "{}: {} spp in {:.3g} s, {:.3g} s of CPU time on {} threads, {:.3g} Mpaths per CPU s\n",
      options.output, stats.spp, stats.wall_seconds, stats.cpu_seconds, stats.threads, rate);
  if (settings.clamp) {
    fmt::print("  {}: {} of {} samples\n", clamp_text(*settings.clamp), stats.clamped, stats.paths);
  }
}

RenderSettings settings_for(const RenderOptions& options, RenderSettings settings,
                            const RenderDefaults& defaults) {
  settings.seed = options.seed;
  settings.depth = options.renderer.depth.value_or(defaults.depth);
  settings.spp = options.spp.value_or(defaults.spp);
  settings.time_seconds = options.time.value_or(0.0);
  settings.scene_name = options.scene;
  settings.command = own_command_line();
  if (options.resume) settings.resume_file = options.output + ".state";
  return settings;
}

void write_outputs(const RenderOptions& options, const SceneOverrides& overrides,
                   const Scene& scene, const SamplerSpec& sampler, const RenderSettings& settings,
                   const RenderResult& result, int ranks) {
  const Metadata changes = override_metadata(overrides);
  Metadata metadata = render_metadata(options.scene, sampler, settings, result);
  metadata.insert(changes.begin(), changes.end());
  write_image(options.output, result.image, metadata);
  if (!options.weights.empty()) {
    if (!result.weights) throw Error("--weights: the render made no weight map");
    write_image(options.weights, *result.weights, metadata);
  }
  if (!options.stats.empty()) {
    auto json = render_stats_json(options.scene, scene, sampler, settings, result);
    json["overrides"] = changes;
    if (const Traffic sent = traffic(); sent.messages > 0) {
      json["ranks"] = ranks;
      json["messages"] = sent.messages;
      json["message_bytes"] = sent.bytes;
    }
    write_text_file(options.stats, json.dump(2) + '\n');
  }
}

// A view of the image as it forms, where one is asked for.
std::unique_ptr<TevDisplay> make_display(const RenderOptions& options,
                                         const std::optional<TevAddress>& address,
                                         const Scene& scene, RenderSettings& settings) {
  if (!address) return {};
  const FilmDescription& film = scene.description().film;
  auto display = std::make_unique<TevDisplay>(*address, options.output, film.width, film.height);
  settings.watch = [shown = display.get()](int x, int y, const Image& tile) {
    shown->update(x, y, tile);
  };
  return display;
}

Scene read_built(const RenderOptions& options, const SceneOverrides& overrides, Isa isa,
                 bool quiet = false) {
  const Activity reading("reading the scene " + options.scene);
  return Scene(read_described(options.scene, options.renderer, overrides, quiet), embree_isa(isa));
}

// Of a rank other than 0: renders tiles for that one.
void help_render(const RenderOptions& options, const SamplerSpec& sampler,
                 const RenderSettings& settings, const SceneOverrides& overrides) {
  std::optional<Scene> scene;
  Skills skills;
  skills.prepare = [&] { scene.emplace(read_built(options, overrides, settings.isa, true)); };
  skills.join = [&](const nlohmann::json&) {
    RenderSettings own = settings_for(options, settings, scene->description().defaults);
    own.resume_file.clear();
    return std::make_unique<TileRenderer>(*scene, sampler, own, [](double) {
      say_alive();
      return true;
    });
  };
  help(skills);
}

void run_render(const RenderOptions& options) {
  if (!options.renderer.resolution.empty()) parse_resolution(options.renderer.resolution);
  const SamplerSpec sampler = parse_sampler(options.sampler);
  RenderSettings settings = render_settings(options.renderer);
  const SceneOverrides overrides = scene_overrides(options.renderer);
  std::optional<TevAddress> address;
  if (!options.display.empty()) address = parse_tev_address(options.display);
  const Ranks ranks = start_ranks();
  agree(ranks, settings);
  if (ranks.rank > 0) {
    help_render(options, sampler, settings, overrides);
    end_ranks();
    return;
  }
  check_outputs(options, sampler);
  Desk desk(ranks, options.rank_timeout);

  const Scene scene = read_built(options, overrides, settings.isa);
  settings = settings_for(options, settings, scene.description().defaults);
  const std::unique_ptr<TevDisplay> display = make_display(options, address, scene, settings);
  ProgressMeter meter(options.quiet);
  const auto show = [&](double fraction) {
    meter.show(fraction, options.output);
    return !interrupted();
  };
  const Activity rendering("rendering " + options.output);
  const RenderResult result =
      ranks.count > 1 ? render(scene, sampler, settings, show,
                               share_tiles(desk, nlohmann::json::object(), settings.threads))
                      : render(scene, sampler, settings, show);
  meter.clear();
  if (display) display->update(0, 0, result.image);
  report_nonfinite(result.stats, settings);
  write_outputs(options, overrides, scene, sampler, settings, result, ranks.count);
  if (!options.quiet) report_done(options, settings, result.stats);
  end_ranks(desk);
}

void add_options(CLI::App& command, RenderOptions& options) {
  command
      .add_option("SCENE", options.scene, "Built-in scene (see 'lockstep scenes') or scene file")
      ->type_name("")
      ->required();
  command
      .add_option("-o,--output", options.output,
                  "Image to write: .exr keeps radiance and settings; .png is 8-bit sRGB")
      ->type_name("FILE")
      ->required();
  command
      .add_option("--sampler", options.sampler, "Sampler with options (see 'lockstep samplers')")
      ->type_name("SPEC")
      ->capture_default_str();
  CLI::Option* spp = command.add_option("--spp", options.spp,
                                        "Samples per pixel, pilot included (default: the scene's)");
  spp->type_name("N")->check(whole_number_between(1, 1 << 24));
  command
      .add_option("--time", options.time,
                  "Render for this many seconds of wall time instead of a number\nof samples")
      ->type_name("SECONDS")
      ->check(number_between(1e-3, 1e9))
      ->excludes(spp);
  command
      .add_option("--seed", options.seed, "Seed; the same settings and seed give the same image")
      ->type_name("N")
      ->check(whole_number_between(0, 4294967295))
      ->capture_default_str();
  command.add_option("--stats", options.stats, "Write what the render cost, as JSON")
      ->type_name("FILE");
  command
      .add_option("--weights", options.weights, "Write the weight map that the sampler made (rcs)")
      ->type_name("FILE");
  command.add_flag("--resume", options.resume,
                   "Keep the state in FILE.state, and go on from it if it is there:\n"
                   "after an interruption, or with more --spp (rcs: with a fixed pilot=N)");
  command
      .add_option("--display", options.display,
                  "Show the image as it forms in a running tev viewer (port 14158\n"
                  "where none is given)")
      ->type_name("HOST:PORT");
  command.add_flag("--quiet", options.quiet,
                   "No progress and no summary; warnings and errors only");
  add_renderer_options(command, options.renderer);
  add_rank_options(command, options.rank_timeout);
}

}  // namespace

void add_render_command(CLI::App& program, RunCommand& run) {
  CLI::App* command = program.add_subcommand("render", "Render one image");
  command->description(
      "Render one image\n\n"
      "Render SCENE to an image file. Takes from a second to hours, by samples and resolution.");
  command->footer(
      "Examples:\n"
      "  lockstep render cornell -o cornell.exr --spp 64\n"
      "  lockstep render scene.pbrt -o out.exr --sampler rcs:c=4,t=0.02 --time 30 --stats "
      "out.json\n"
      "  lockstep render cornell -o out.exr --width 8 --isa avx2 --lanes 2x2x4 --threads 1\n"
      "  mpirun --map-by node --bind-to none lockstep render scene.pbrt -o out.exr --spp 4096");
  auto options = std::make_shared<RenderOptions>();
  add_options(*command, *options);
  command->callback([options, &run] { run = [options] { run_render(*options); }; });
}

}  // namespace lockstep
