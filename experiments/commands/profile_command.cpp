// lockstep profile: packet coherence against weight.
#include "core/error.h"
#include "experiments/commands/commands.h"
#include "experiments/commands/options.h"
#include "experiments/output/activity.h"
#include "experiments/output/output_file.h"
#include "experiments/output/progress.h"
#include "experiments/profile/profile.h"
#include "experiments/profile/profile_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <memory>
#include <optional>
#include <string_view>

namespace lockstep {
namespace {

struct ProfileOptions {
  RendererOptions renderer;
  std::string scene, directory, sampler = "rcs", weights = "0,0.03125,0.125,0.5,1";
  std::string maps = "1:0.02,4:0.02,16:0.02";
  int spp = 16, repeats = 5, seeds = 3;
  std::optional<int> reference_spp;
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

// The items of a list with commas.
std::vector<std::string> items_of(const std::string& text) {
  std::vector<std::string> items;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t comma = std::min(text.find(',', at), text.size());
    items.push_back(text.substr(at, comma - at));
    at = comma + 1;
  }
  return items;
}

// The whole text as a number from 0 to 1e6.
float map_number(std::string_view text, const std::string& item) {
  float value = 0.0f;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() ||
      !(value >= 0.0f && value <= 1e6f)) {
    throw UsageError(fmt::format(
        "--maps: '{}' is no map; use C:T with two numbers of 0 or more, as 4:0.02", item));
  }
  return value;
}

// "0,0.5,1" and "4:0.02,1:0.02"; the latter may be empty or "none".
std::vector<ProfileWeight> parse_profile_weights(const ProfileOptions& options) {
  std::vector<ProfileWeight> weights;
  for (const float weight : parse_weights(options.weights)) weights.push_back({weight, {}});
  if (options.maps.empty() || options.maps == "none") return weights;
  for (const std::string& item : items_of(options.maps)) {
    const std::size_t colon = std::min(item.find(':'), item.size());
    const std::string_view text = item;
    const float c = map_number(text.substr(0, colon), item);
    const float t = map_number(text.substr(std::min(colon + 1, item.size())), item);
    weights.push_back({1.0f, ProfileWeight::Map{c, t}});
  }
  return weights;
}

// "4x4x1,1x1x16"; "auto" stands for the three that the renderer chooses among.
std::vector<LaneLayout> parse_layouts(std::string text) {
  if (text == "auto") text = "4x4x1,2x2x4,1x1x16";
  std::vector<LaneLayout> layouts;
  for (const std::string& item : items_of(text)) layouts.push_back(parse_lane_layout(item));
  return layouts;
}

std::string in_directory(const ProfileOptions& options, const char* file) {
  return (std::filesystem::path(options.directory) / file).string();
}

void run_profile_command(const ProfileOptions& options) {
  if (!options.renderer.resolution.empty()) parse_resolution(options.renderer.resolution);
  ProfileSettings settings;
  settings.scene = options.scene;
  settings.sampler = profiled_sampler(options);
  settings.weights = parse_profile_weights(options);
  settings.layouts = parse_layouts(options.renderer.lanes);
  settings.repeats = options.repeats;
  settings.seeds = options.seeds;
  settings.reference_spp = options.reference_spp.value_or(std::max(256, 16 * options.spp));
  RendererOptions renderer = options.renderer;
  renderer.lanes = "auto";
  settings.render = render_settings(renderer);
  const SceneOverrides overrides = scene_overrides(options.renderer);
  make_output_directory(options.directory);

  const Activity profiling("the profile of " + options.scene);
  SceneDescription description = read_described(options.scene, options.renderer, overrides);
  settings.render.depth = options.renderer.depth.value_or(description.defaults.depth);
  settings.render.spp = options.spp;
  settings.render.seed = options.seed;
  settings.overrides = override_metadata(overrides);
  const Scene scene(std::move(description), embree_isa(settings.render.isa));
  ProgressMeter meter(options.quiet);
  const Profile profile = run_profile(scene, settings, [&](double share, const std::string& label) {
    meter.show(share, label);
    return !interrupted();
  });
  meter.clear();
  const auto write = [&](const char* file, const std::string& text) {
    write_text_file(in_directory(options, file), text);
  };
  write("profile.csv", profile_csv(profile, settings));
  write("renders.csv", profile_renders_csv(profile, settings));
  write("coherence.csv", profile_coherence_csv(profile, settings));
  if (!profile.errors.empty()) write("errors.csv", profile_errors_csv(profile, settings));
  write("profile.html", profile_html(profile, settings));
  fmt::print("{}", profile_table(profile));
}

void add_options(CLI::App& command, ProfileOptions& options) {
  command
      .add_option("SCENE", options.scene, "Built-in scene (see 'lockstep scenes') or scene file")
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
      .add_option("--maps", options.maps,
                  "Weight maps from a pilot beside them: w = min(1, c d) where the\n"
                  "pilot's relative difference d is t or more; or none")
      ->type_name("C:T,C:T,...")
      ->capture_default_str();
  command
      .add_option("--sampler", options.sampler,
                  "Sampler whose weight varies (see 'lockstep samplers')")
      ->type_name("SPEC")
      ->capture_default_str();
  command.add_option("--spp", options.spp, "Samples per pixel")
      ->type_name("N")
      ->check(whole_number_between(1, 4096))
      ->capture_default_str();
  command.add_option("--repeats", options.repeats, "Times that each is measured; medians count")
      ->type_name("N")
      ->check(whole_number_between(1, 1000))
      ->capture_default_str();
  command
      .add_option("--reference-spp", options.reference_spp,
                  "Samples per pixel of the image that errors are measured against\n"
                  "(default: 16 times --spp, at least 256); 0: measure no errors")
      ->type_name("N")
      ->check(whole_number_between(0, 1 << 20));
  command.add_option("--seeds", options.seeds, "Renders that errors are means of")
      ->type_name("N")
      ->check(whole_number_between(1, 1000))
      ->capture_default_str();
  command.add_option("--seed", options.seed, "Seed")
      ->type_name("N")
      ->check(whole_number_between(0, 4294967295))
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
      "coherent rays are one by one (locality) and how much packets add (SIMD), and what "
      "coherence\n"
      "does to the image. Speed is measured with one thread; keeps 30 bytes per ray in memory.");
  command->footer(
      "DIR receives profile.csv (rays per CPU second by weight, lanes, kind, bounce and mode),\n"
      "renders.csv (paths per CPU second, time by stage, hardware counters), coherence.csv (lanes\n"
      "active, directions, triangles and materials per packet), errors.csv (metrics at equal "
      "samples\n"
      "and at equal time) and profile.html, which shows them all.\n"
      "\n"
      "Examples:\n"
      "  lockstep profile cornell -o out/profile --resolution 256x256\n"
      "  lockstep profile reef --weights 0,0.25,1 --lanes 4x4x1 --depth 3 -o out/reef");
  auto options = std::make_shared<ProfileOptions>();
  add_options(*command, *options);
  command->callback([options, &run] { run = [options] { run_profile_command(*options); }; });
}

}  // namespace lockstep
