// lockstep compare: samplers against each other at equal time.
#include "core/error.h"
#include "core/read_scene.h"
#include "experiments/commands/commands.h"
#include "experiments/commands/compare_run.h"
#include "experiments/commands/options.h"
#include "experiments/compare/compare_ranks.h"
#include "experiments/compare/experiment_file.h"
#include "experiments/distributed/agreement.h"
#include "experiments/distributed/session.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <memory>

namespace lockstep {
namespace {

namespace fs = std::filesystem;

struct CompareOptions {
  RendererOptions renderer;
  std::vector<std::string> scenes;
  std::string samplers, spp = "4,16,64,256", depths, budgets, targets;
  std::string reference, reference_folder, scenes_folder, directory;
  int seeds = 8;
  int reference_spp = 0;
  double timing_spread = 0.03;
  std::optional<int> timing_repeats;
  double rank_timeout = 60.0;
  bool resume = false;
  bool quiet = false;
};

// An experiment file in place of scenes, or before those that replace its own.
std::optional<std::string> take_experiment_file(CompareOptions& options) {
  if (options.scenes.empty() || !options.scenes[0].ends_with(".toml")) return {};
  std::string file = options.scenes[0];
  options.scenes.erase(options.scenes.begin());
  return file;
}

CLI::Option* option_of(CLI::App& command, const ExperimentKey& key) {
  if (key.name == "scenes") return command.get_option("SCENE");
  std::string name(key.name);
  std::replace(name.begin(), name.end(), '_', '-');
  return command.get_option("--" + name);
}

// Gives the command what the file says and the command line does not.
void apply_experiment(CLI::App& command, CompareOptions& options, const std::string& file) {
  for (const ExperimentEntry& entry : read_experiment(file)) {
    if (entry.key->name == "scenes") {
      if (options.scenes.empty()) options.scenes = entry.values;
      continue;
    }
    CLI::Option* option = option_of(command, *entry.key);
    const bool is_off = entry.key->kind == ValueKind::Switch && entry.values[0] == "false";
    if (option->count() > 0 || is_off) continue;
    try {
      option->add_result(fmt::format("{}", fmt::join(entry.values, ",")));
      option->run_callback();
    } catch (const CLI::ParseError& error) {
      throw error_at(file, entry.line, fmt::format("{}: {}", entry.key->name, error.what()));
    }
  }
}

// What the command line and the file say together.
std::string effective_experiment(CLI::App& command, const CompareOptions& options) {
  std::vector<ExperimentEntry> entries;
  for (const ExperimentKey& key : experiment_keys()) {
    if (key.name == "scenes") {
      if (!options.scenes.empty()) entries.push_back({&key, options.scenes, 0});
      continue;
    }
    const CLI::Option* option = option_of(command, key);
    if (option->count() == 0) continue;
    const std::string text = option->results().back();
    entries.push_back({&key, {text}, 0});
    if (!key.is_list) continue;
    entries.back().values =
        key.name == "samplers" ? split_sampler_list(text) : split_at_commas(text);
  }
  return experiment_text(entries);
}

// A scene that is not there as named is looked for in the folder of scenes.
std::string find_scene(const std::string& scene, const CompareOptions& options) {
  for (const BuiltinScene& builtin : builtin_scenes()) {
    if (builtin.name == scene) return scene;
  }
  std::error_code error;
  if (fs::exists(scene, error)) return scene;
  const fs::path path = fs::path(options.scenes_folder) / scene;
  if (!options.scenes_folder.empty() && fs::exists(path, error)) return path.string();
  const std::string where =
      options.scenes_folder.empty() ? "" : fmt::format(", nor is it in {}", options.scenes_folder);
  throw Error(fmt::format("{}: no such scene{}; name the folder that it is in with --scenes-dir",
                          scene, where));
}

CompareSettings compare_settings(const CompareOptions& options) {
  if (options.samplers.empty()) throw UsageError("--samplers is required");
  if (!options.reference.empty() && options.reference_spp > 0) {
    throw UsageError("--reference excludes --reference-spp: the image is there already");
  }
  CompareSettings settings;
  for (const std::string& scene : options.scenes) {
    settings.scenes.push_back(find_scene(scene, options));
  }
  for (const std::string& sampler : split_sampler_list(options.samplers)) {
    settings.samplers.push_back(parse_sampler(sampler));
  }
  settings.rungs = parse_sample_counts(options.spp);
  settings.seeds = options.seeds;
  settings.reference_file = options.reference;
  settings.reference_spp = options.reference_spp;
  settings.reference_folder = options.reference_folder;
  if (!options.depths.empty()) settings.depths = parse_depths(options.depths);
  if (!options.budgets.empty()) settings.budgets = parse_time_budgets(options.budgets);
  if (!options.targets.empty()) {
    for (auto& [metric, error] : parse_targets(options.targets)) {
      settings.targets.push_back({metric, error});
    }
  }
  if (!options.renderer.resolution.empty()) {
    settings.resolution = parse_resolution(options.renderer.resolution);
  }
  settings.overrides = scene_overrides(options.renderer);
  settings.render = render_settings(options.renderer);
  settings.directory = options.directory;
  settings.timing_spread = options.timing_spread;
  settings.timing_repeats = options.timing_repeats;
  settings.resume = options.resume;
  return settings;
}

void run_compare(CLI::App& command, CompareOptions& options) {
  if (const auto file = take_experiment_file(options)) apply_experiment(command, options, *file);
  CompareSettings settings = compare_settings(options);
  settings.experiment = effective_experiment(command, options);
  const Ranks ranks = start_ranks();
  agree(ranks, settings.render);
  if (ranks.rank > 0) {
    help_compare(settings);
    end_ranks();
  } else if (ranks.count > 1) {
    Desk desk(ranks, options.rank_timeout);
    run_comparison(settings, options.quiet, &desk);
    end_ranks(desk);
  } else {
    run_comparison(settings, options.quiet);
  }
}

void add_what(CLI::App& command, CompareOptions& options) {
  command
      .add_option("SCENE", options.scenes,
                  "Built-in scenes (see 'lockstep scenes') or scene files; or an experiment:\n"
                  "a .toml file with these options as keys, which the command line overrides")
      ->type_name("");
  command
      .add_option("--samplers", options.samplers,
                  "Samplers with their options, separated by commas; the others\n"
                  "are measured against the first")
      ->type_name("A,B,...");
  command.add_option("-o,--output", options.directory, "Folder for all results; made if missing")
      ->type_name("DIR");
  command
      .add_option("--scenes-dir", options.scenes_folder,
                  "Folder in which scenes are looked for that are not there as named")
      ->type_name("DIR")
      ->envname("LOCKSTEP_SCENES");
  command.add_option("--spp", options.spp, "Samples per pixel of the renders, pilot included")
      ->type_name("N,N,...")
      ->capture_default_str();
  command.add_option("--seeds", options.seeds, "Renders of each kind, with seeds 0, 1, ...")
      ->type_name("N")
      ->check(whole_number_between(1, 10000))
      ->capture_default_str();
  command
      .add_option("--time-budgets", options.budgets,
                  "CPU seconds to report at (default: the longest that all samplers\n"
                  "cover, and quarters of it)")
      ->type_name("S,S,...");
  command
      .add_option("--targets", options.targets,
                  "Errors whose time is compared, such as flip_ldr=0.05,rmse=0.01\n"
                  "(default: the lowest FLIP that all samplers reach)")
      ->type_name("METRIC=X,...");
}

void add_reference(CLI::App& command, CompareOptions& options) {
  command
      .add_option("--reference", options.reference,
                  "Image to measure against, for one scene (default: render one)")
      ->type_name("FILE");
  command
      .add_option("--reference-spp", options.reference_spp,
                  "Samples per pixel of the rendered reference (default: 1024 or\n"
                  "100 times the largest of --spp, whichever is more)")
      ->type_name("N")
      ->check(whole_number_between(2, 1 << 24));
  command
      .add_option("--reference-dir", options.reference_folder,
                  "Folder in which rendered references are kept and found again\n"
                  "(default: the output folder)")
      ->type_name("DIR");
}

void add_course(CLI::App& command, CompareOptions& options) {
  command.add_flag("--resume", options.resume,
                   "Go on with what DIR holds of this experiment (default: set it\n"
                   "aside and begin anew)");
  command
      .add_option("--timing-spread", options.timing_spread,
                  "Renders whose median time is uncertain by more than this share\n"
                  "are timed again")
      ->type_name("X")
      ->check(number_between(0, 10))
      ->capture_default_str();
  command
      .add_option("--timing-repeats", options.timing_repeats,
                  "At most so often for each sample count (default: half of --seeds)")
      ->type_name("N")
      ->check(whole_number_between(0, 10000));
  command.add_flag("--quiet", options.quiet, "No progress; results, warnings and errors only");
}

void add_options(CLI::App& command, CompareOptions& options) {
  add_what(command, options);
  add_reference(command, options);
  add_course(command, options);
  add_renderer_options(command, options.renderer);
  add_rank_options(command, options.rank_timeout);
  // A list, where other commands take one.
  command.remove_option(command.get_option("--depth"));
  command
      .add_option("--depth", options.depths,
                  "Surface interactions that are lit, each depth an experiment of its\n"
                  "own; 1 is direct light only (default: the scene's)")
      ->type_name("N,N,...")
      ->group("Renderer");
}

}  // namespace

void add_compare_command(CLI::App& program, RunCommand& run) {
  CLI::App* command = program.add_subcommand("compare", "Compare samplers at equal time");
  command->description(
      "Compare samplers at equal time\n\n"
      "Render every scene with every sampler, sample count and seed, measure all images against a\n"
      "reference, and compare errors at equal CPU time; pilot images, filters and weights are\n"
      "paid for. Takes minutes to hours: the reference and (sum of --spp) x seeds x samplers x\n"
      "scenes. What was stopped goes on with --resume; Ctrl-C finishes the current render and\n"
      "writes a report of what there is.");
  command->footer(
      "DIR receives errors.csv (a row for each render, as it is measured), journal.jsonl (what\n"
      "--resume needs), spectra.csv (the errors' power by frequency), summary.json, report.html,\n"
      "figures/ (for papers) and the first seed's images. Errors are interpolated between sample\n"
      "counts, never beyond them. Verdicts against random need it among the samplers, and at "
      "least\n"
      "4 seeds.\n"
      "\n"
      "Examples:\n"
      "  lockstep compare cornell --samplers random,cpt,rcs,owen -o out/cornell\n"
      "      about 15 minutes on two cores\n"
      "  lockstep compare scene.pbrt --samplers random,rcs:c=4,t=0.02,rcs:c=8 --spp 8,32 --seeds "
      "4\n"
      "      --reference reference.exr --depth 1 -o out/poster\n"
      "  lockstep compare experiment.toml --threads 1 -o out/one-thread\n"
      "  mpirun --map-by node --bind-to none lockstep compare experiment.toml -o out/cluster");
  auto options = std::make_shared<CompareOptions>();
  add_options(*command, *options);
  command->callback(
      [command, options, &run] { run = [command, options] { run_compare(*command, *options); }; });
}

}  // namespace lockstep
