#include "experiments/compare/compare.h"

#include "core/error.h"
#include "core/read_scene.h"
#include "experiments/compare/compare_phase.h"
#include "experiments/compare/reference.h"
#include "experiments/metrics/metrics.h"
#include "experiments/output/activity.h"
#include "experiments/output/machine.h"
#include "experiments/output/render_metadata.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <numeric>
#include <set>
#include <utility>

namespace lockstep {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;
using Json = nlohmann::ordered_json;

void check_reference(const CompareSettings& settings) {
  if (settings.reference_file.empty()) return;
  if (settings.scenes.size() > 1 || settings.depths.size() > 1) {
    throw UsageError(
        "--reference: one image is the reference of one scene at one depth; compare one at a time");
  }
  read_metadata(settings.reference_file);
}

void check_targets(const CompareSettings& settings) {
  for (const ErrorTarget& target : settings.targets) {
    const auto place = std::find_if(metrics().begin(), metrics().end(), [&](const Metric& metric) {
      return metric.name == target.metric;
    });
    if (place == metrics().end() || !place->lower_is_better) {
      std::string names;
      for (const Metric& metric : metrics()) {
        if (metric.lower_is_better) names += fmt::format(" {}", metric.name);
      }
      throw UsageError(fmt::format("--targets: '{}' is not one of{}", target.metric, names));
    }
  }
}

void check_settings(const CompareSettings& settings) {
  if (settings.scenes.empty()) throw UsageError("compare: name at least one SCENE");
  if (settings.samplers.empty()) throw UsageError("--samplers: name at least one sampler");
  if (settings.directory.empty()) throw UsageError("--output: name a folder for the results");
  check_reference(settings);
  check_targets(settings);
  std::set<std::string> names;
  for (const SamplerSpec& sampler : settings.samplers) {
    if (!names.insert(to_string(sampler)).second) {
      throw UsageError(
          fmt::format("--samplers: {} is named twice; name each once", to_string(sampler)));
    }
  }
}

// The scene's name, or its file's without folder and extension; with the folder where scenes would
// be called alike, and with the depth where there are several. Numbered where that is taken.
std::string unique_label(const CompareSettings& settings, const std::string& scene, int depth,
                         std::set<std::string>& taken) {
  const fs::path path(scene);
  const auto alike = std::count_if(
      settings.scenes.begin(), settings.scenes.end(),
      [&](const std::string& other) { return fs::path(other).stem() == path.stem(); });
  const std::string folder = path.parent_path().filename().string();
  std::string stem = file_name_safe((alike > 1 && !folder.empty() ? folder + '-' : std::string()) +
                                    path.stem().string());
  if (settings.depths.size() > 1) stem += fmt::format("-depth{}", depth);
  std::string label = stem;
  for (int n = 2; !taken.insert(label).second; ++n) label = fmt::format("{}-{}", stem, n);
  return label;
}

SceneDescription read_for(const CompareSettings& settings, const std::string& scene) {
  const Activity reading("reading the scene " + scene);
  SceneDescription description = read_scene(scene, settings.overrides);
  if (settings.resolution) {
    description.film.width = settings.resolution->x;
    description.film.height = settings.resolution->y;
  }
  return description;
}

SceneComparison describe(const Scene& scene, int depth, const std::string& name,
                         const std::string& label, std::optional<float> clamp) {
  const SceneDescription& description = scene.description();
  SceneComparison result;
  result.scene = name;
  result.label = label;
  result.width = description.film.width;
  result.height = description.film.height;
  result.depth = depth;
  result.triangles = scene.triangle_count();
  result.features = feature_names(scene.features());
  result.left_out = feature_names(all_features & ~scene.features());
  result.warnings = description.warnings;
  if (clamp)
    result.warnings.push_back(fmt::format("{}: all renders are {}", name, clamp_text(*clamp)));
  return result;
}

std::vector<int> depths_of(const CompareSettings& settings, const SceneDescription& scene) {
  return settings.depths.empty() ? std::vector<int>{scene.defaults.depth} : settings.depths;
}

// How long renders of one sample per pixel take, in units that are about the same for all scenes.
double cost_of(const CompareSettings& settings, const SceneDescription& scene) {
  double cost = 0.0;
  for (int depth : depths_of(settings, scene)) {
    cost += double(scene.film.width) * scene.film.height * (1.0 + depth);
  }
  return cost;
}

// Reads all scenes: a mistake in any of them is found before files are touched and hours are spent
// on the others. Returns their costs.
std::vector<double> check_scenes(const CompareSettings& settings) {
  for (const std::string& scene : settings.scenes) scene_format(scene);
  std::vector<double> costs;
  for (const std::string& scene : settings.scenes) {
    costs.push_back(cost_of(settings, read_for(settings, scene)));
  }
  return costs;
}

// The rows of all renders in the journal, each once.
std::string rows_of(const Journal& journal) {
  std::set<std::tuple<std::string, int, std::string, std::uint32_t, int>> seen;
  std::string rows;
  for (const JournalEntry& entry : journal.earlier()) {
    const auto* measured = std::get_if<MeasuredRun>(&entry.what);
    if (!measured) continue;
    const Measurement& run = measured->run;
    if (!seen.insert({entry.scene, entry.depth, entry.sampler, run.seed, run.spp}).second) continue;
    rows += errors_csv_row(entry.scene, entry.depth, entry.sampler, run) + '\n';
  }
  return rows;
}

Json begin_note(const CompareSettings& settings) {
  Json note = {{"begun", date_and_time()},
               {"lockstep", version()},
               {"machine", cpu_name()},
               {"scenes", settings.scenes},
               {"depths", settings.depths},
               {"samplers", Json::array()},
               {"spp", settings.rungs},
               {"seeds", settings.seeds},
               {"experiment", settings.experiment}};
  for (const SamplerSpec& sampler : settings.samplers) {
    note["samplers"].push_back(to_string(sampler));
  }
  return note;
}

Journal open_journal(const CompareSettings& settings) {
  if (!settings.reference_folder.empty()) make_output_directory(settings.reference_folder);
  make_output_directory(settings.directory);
  return Journal(settings.directory, settings.resume);
}

// The experiment while it runs.
struct Run {
  const CompareSettings& settings;
  const CompareProgress& progress;
  const SceneDone& scene_done;
  std::vector<double> costs;  // by scene
  Journal& journal;
  ErrorsCsv& csv;
  Clock::time_point deadline;
  std::set<std::string> labels = {};
  Comparison comparison = {};

  double all_costs() const { return std::accumulate(costs.begin(), costs.end(), 0.0); }
};

// One scene at one depth, whose share of the whole work is [begin, end).
void compare_at(Run& run, const Scene& scene, const std::string& name, int depth, double begin,
                double end) {
  const CompareSettings& settings = run.settings;
  run.comparison.scenes.push_back(describe(
      scene, depth, name, unique_label(settings, name, depth, run.labels), settings.render.clamp));
  SceneComparison& result = run.comparison.scenes.back();
  RenderSettings render_settings = settings.render;
  render_settings.depth = depth;
  const double reference_work =
      has_reference(settings, result, scene) ? 0.0 : double(reference_spp(settings));
  const double total = reference_work + settings.seeds * work_per_seed(settings);
  const auto show = [&](double work, std::string_view label) {
    return !run.progress || run.progress(begin + (end - begin) * work / total, label);
  };
  Phase phase{settings, result, scene, render_settings, run.journal, run.csv, show};
  run.comparison.complete &= run_phase(phase, reference_work, run.deadline);
}

void compare_scene(Run& run, std::size_t index, double done) {
  const std::string& name = run.settings.scenes[index];
  const Activity comparing("comparing renders of " + name);
  const Scene scene(read_for(run.settings, name), embree_isa(run.settings.render.isa));
  const std::vector<int> depths = depths_of(run.settings, scene.description());
  const double share = run.costs[index] / run.all_costs() / double(depths.size());
  for (std::size_t d = 0; d < depths.size(); ++d) {
    const double begin = done + double(d) * share;
    compare_at(run, scene, name, depths[d], begin, begin + share);
    const bool last = index + 1 == run.settings.scenes.size() && d + 1 == depths.size();
    if (!run.scene_done || last) continue;
    const bool complete = std::exchange(run.comparison.complete, false);
    run.scene_done(run.comparison);
    run.comparison.complete = complete;
  }
}

void compare_all(Run& run) {
  try {
    double done = 0.0;
    for (std::size_t s = 0; s < run.settings.scenes.size(); ++s) {
      compare_scene(run, s, done);
      done += run.costs[s] / run.all_costs();
    }
  } catch (const Cancelled&) {
    run.comparison.complete = false;
    std::vector<SceneComparison>& scenes = run.comparison.scenes;
    if (!scenes.empty() && scenes.back().runs.empty()) scenes.pop_back();
  }
}

}  // namespace

Comparison compare(const CompareSettings& settings, const CompareProgress& progress,
                   const SceneDone& scene_done) {
  check_settings(settings);
  const std::vector<double> costs = check_scenes(settings);
  const fs::path directory(settings.directory);
  std::error_code error;
  const bool goes_on = settings.resume && fs::exists(directory / kJournalFile, error);
  Journal journal = open_journal(settings);
  if (!goes_on) set_aside((directory / "errors.csv").string());
  ErrorsCsv csv(settings.directory, rows_of(journal));
  Run run{settings,
          progress,
          scene_done,
          costs,
          journal,
          csv,
          Clock::now() + std::chrono::duration_cast<Clock::duration>(
                             std::chrono::duration<double>(settings.max_seconds))};
  run.comparison.settings = settings;
  run.journal.add_note(begin_note(settings));
  if (!settings.experiment.empty()) {
    write_text_file((fs::path(settings.directory) / "experiment.toml").string(),
                    settings.experiment);
  }
  compare_all(run);
  run.journal.add_note({{run.comparison.complete ? "complete" : "stopped", date_and_time()}});
  return run.comparison;
}

}  // namespace lockstep
