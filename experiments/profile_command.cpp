// lockstep profile: packet coherence against weight.
#include "core/error.h"
#include "experiments/commands.h"
#include "experiments/options.h"
#include "experiments/output_file.h"
#include "experiments/profile.h"
#include "experiments/progress.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>

namespace lockstep {
namespace {

struct ProfileOptions {
  RendererOptions renderer;
  std::string scene, directory, sampler = "rcs", weights = "0,0.03125,0.125,0.5,1";
  int spp = 16, repeats = 5;
  std::uint32_t seed = 0;
  bool quiet = false;
};

SamplerSpec profiled_sampler(const ProfileOptions& options) {
  SamplerSpec sampler = parse_sampler(options.sampler);
  if (!sampler.shared() || sampler.perturbation == PerturbationId{}) {
    throw UsageError(fmt::format(
        "--sampler: {} has no weight to vary; choose one whose pixels leave a shared sequence, "
        "such as rcs",
        options.sampler));
  }
  return sampler;
}

// "4x4x1,1x1x16"; "auto" stands for the three that the renderer chooses among.
std::vector<LaneLayout> parse_layouts(std::string text) {
  if (text == "auto") text = "4x4x1,2x2x4,1x1x16";
  std::vector<LaneLayout> layouts;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t comma = std::min(text.find(',', at), text.size());
    layouts.push_back(parse_lane_layout(text.substr(at, comma - at)));
    at = comma + 1;
  }
  return layouts;
}

std::string in_directory(const ProfileOptions& options, const char* file) {
  return (std::filesystem::path(options.directory) / file).string();
}

void run_profile_command(const ProfileOptions& options) {
  ProfileSettings settings;
  settings.scene = options.scene;
  settings.sampler = profiled_sampler(options);
  settings.weights = parse_weights(options.weights);
  settings.layouts = parse_layouts(options.renderer.lanes);
  settings.repeats = options.repeats;
  RendererOptions renderer = options.renderer;
  renderer.lanes = "auto";
  settings.render = render_settings(renderer);
  const SceneOverrides overrides = scene_overrides(options.renderer);
  make_output_directory(options.directory);

  SceneDescription description = read_described(options.scene, options.renderer, overrides);
  settings.render.depth = options.renderer.depth.value_or(description.defaults.depth);
  settings.render.spp = options.spp;
  settings.render.seed = options.seed;
  const Scene scene(std::move(description), embree_isa(settings.render.isa));
  ProgressMeter meter(options.quiet);
  const Profile profile = run_profile(scene, settings, [&](double share, const std::string& label) {
    meter.show(share, label);
    return !interrupted();
  });
  meter.clear();
  write_text_file(in_directory(options, "profile.csv"), profile_csv(profile, settings));
  write_text_file(in_directory(options, "renders.csv"), profile_renders_csv(profile, settings));
  fmt::print("{}", profile_table(profile));
}

void add_options(CLI::App& command, ProfileOptions& options) {
  command.add_option("SCENE", options.scene, "Built-in scene (see 'lockstep scenes') or scene file")
      ->type_name("")
      ->required();
  command.add_option("-o,--output", options.directory, "Folder for all results; made if missing")
      ->type_name("DIR")
      ->required();
  command
      .add_option("--weights", options.weights,
                  "Weights, from 0 (all pixels share their random numbers) to 1\n"
                  "(independent)")
      ->type_name("W,W,...")
      ->capture_default_str();
  command
      .add_option("--sampler", options.sampler,
                  "Sampler whose weight varies (see 'lockstep samplers')")
      ->type_name("SPEC")
      ->capture_default_str();
  command.add_option("--spp", options.spp, "Samples per pixel")
      ->type_name("N")
      ->check(number_between(1, 4096))
      ->capture_default_str();
  command.add_option("--repeats", options.repeats, "Times that each is measured; medians count")
      ->type_name("N")
      ->check(number_between(1, 1000))
      ->capture_default_str();
  command.add_option("--seed", options.seed, "Seed")
      ->type_name("N")
      ->check(number_between(0, 4294967295.0))
      ->capture_default_str();
  command.add_flag("--quiet", options.quiet, "No progress; results, warnings and errors only");
  add_renderer_options(command, options.renderer);
}

}  // namespace

void add_profile_command(CLI::App& program, RunCommand& run) {
  CLI::App* command = program.add_subcommand("profile", "Profile coherence against weight");
  command->description(
      "Profile coherence against weight\n\n"
      "Render with each weight and lane layout (--lanes takes a list here), and trace the rays of\n"
      "the render again in every traversal mode. Shows by bounce and kind of ray how much faster\n"
      "coherent rays are one by one (locality) and how much packets add (SIMD). One thread; keeps\n"
      "30 bytes per ray in memory.");
  command->footer(
      "DIR receives profile.csv (rays per CPU second by weight, lanes, kind, bounce and mode) and\n"
      "renders.csv (paths per CPU second and time by stage).\n"
      "\n"
      "Examples:\n"
      "  lockstep profile cornell -o out/profile --resolution 256x256\n"
      "  lockstep profile reef --weights 0,0.25,1 --lanes 4x4x1 --depth 3 -o out/reef");
  auto options = std::make_shared<ProfileOptions>();
  add_options(*command, *options);
  command->callback([options, &run] { run = [options] { run_profile_command(*options); }; });
}

}  // namespace lockstep
