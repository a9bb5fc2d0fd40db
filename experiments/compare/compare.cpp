#include "experiments/compare/compare.h"

#include "core/error.h"
#include "experiments/compare/compare_case.h"
#include "experiments/compare/compare_phase.h"
#include "experiments/compare/compare_ranks.h"
#include "experiments/compare/errors_csv.h"
#include "experiments/compare/reference.h"
#include "experiments/metrics/metrics.h"
#include "experiments/output/activity.h"
#include "experiments/output/machine.h"
#include "experiments/output/render_metadata.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>
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

Json begin_note(const CompareSettings& settings, const Desk* desk) {
  Json note = {{"begun", date_and_time()},
               {"lockstep", version()},
               {"machine", cpu_name()},
               {"scenes", settings.scenes},
               {"depths", settings.depths},
               {"samplers", Json::array()},
               {"spp", settings.rungs},
               {"seeds", settings.seeds},
               {"experiment", settings.experiment}};
  if (desk) note["ranks"] = desk->ranks();
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
  std::vector<CasePlan> plans;
  Journal& journal;
  ErrorsCsv& csv;
  Clock::time_point deadline;
  std::vector<SharedCase> shared = {};  // what ranks have measured, by case; empty without others
  Comparison comparison = {};

  double all_costs() const {
    double costs = 0.0;
    for (const CasePlan& plan : plans) costs += plan.cost;
    return costs;
  }

  void record(const JournalEntry& entry) {
    journal.add(entry);
    const auto* measured = std::get_if<MeasuredRun>(&entry.what);
    if (measured) csv.append(entry.scene, entry.depth, entry.sampler, measured->run);
  }
};

// One case, whose share of the whole work is [begin, end).
void compare_at(Run& run, const Scene& scene, const CasePlan& plan, double begin, double end) {
  const CompareSettings& settings = run.settings;
  run.comparison.scenes.push_back(describe(settings, plan, scene));
  SceneComparison& result = run.comparison.scenes.back();
  RenderSettings render_settings = settings.render;
  render_settings.depth = plan.depth;
  const double reference_work =
      has_reference(settings, result, scene) ? 0.0 : double(reference_spp(settings));
  const double total = reference_work + settings.seeds * work_per_seed(settings);
  const auto show = [&](double work, std::string_view label) {
    return !run.progress || run.progress(begin + (end - begin) * work / total, label);
  };
  Phase phase{settings,
              result,
              &scene,
              render_settings,
              run.journal.earlier(),
              run.journal.path(),
              [&](const JournalEntry& entry) { run.record(entry); },
              show};
  run.comparison.complete &= run_phase(phase, reference_work, run.deadline);
}

void compare_case(Run& run, std::size_t index, KeptScene& scene, double begin) {
  const CasePlan& plan = run.plans[index];
  if (!run.shared.empty() && run.shared[index].complete) {
    run.comparison.scenes.push_back(std::move(run.shared[index].result));
    return;
  }
  const Activity comparing("comparing renders of " + run.settings.scenes[plan.scene]);
  compare_at(run, scene.get(plan.scene), plan, begin, begin + plan.cost / run.all_costs());
  if (!run.scene_done || index + 1 == run.plans.size()) return;
  const bool complete = std::exchange(run.comparison.complete, false);
  run.scene_done(run.comparison);
  run.comparison.complete = complete;
}

void compare_all(Run& run) {
  try {
    double done = 0.0;
    KeptScene scene(run.settings);
    for (std::size_t c = 0; c < run.plans.size(); ++c) {
      compare_case(run, c, scene, done);
      done += run.plans[c].cost / run.all_costs();
    }
  } catch (const Cancelled&) {
    run.comparison.complete = false;
    std::vector<SceneComparison>& scenes = run.comparison.scenes;
    if (!scenes.empty() && scenes.back().runs.empty()) scenes.pop_back();
  }
}

// Has ranks do what they can, then takes it for what was measured before.
void share(Run& run, Desk& desk) {
  const auto record = [&](const JournalEntry& entry) { run.record(entry); };
  run.shared = measure_on_ranks(run.settings, run.plans, run.journal.earlier(), run.journal.path(),
                                record, desk, run.progress);
  for (const SharedCase& shared : run.shared) {
    run.journal.take_over(shared.entries);
  }
}

// As one process writes it.
std::string rows_of(const Comparison& comparison) {
  std::string rows = errors_csv_header() + '\n';
  for (const SceneComparison& scene : comparison.scenes) {
    for (const Measurement& run : scene.runs) {
      rows +=
          errors_csv_row(scene.scene, scene.depth,
                         to_string(comparison.settings.samplers[std::size_t(run.sampler)]), run) +
          '\n';
    }
  }
  return rows;
}

}  // namespace

Comparison compare(const CompareSettings& settings, const CompareProgress& progress,
                   const SceneDone& scene_done, Desk* desk) {
  check_settings(settings);
  std::vector<CasePlan> plans = plan_cases(settings);
  const fs::path directory(settings.directory);
  std::error_code error;
  const bool goes_on = settings.resume && fs::exists(directory / kJournalFile, error);
  Journal journal = open_journal(settings);
  if (!goes_on) set_aside((directory / "errors.csv").string());
  std::optional<ErrorsCsv> csv(std::in_place, settings.directory, rows_of(journal));
  Run run{settings,
          progress,
          scene_done,
          std::move(plans),
          journal,
          *csv,
          Clock::now() + std::chrono::duration_cast<Clock::duration>(
                             std::chrono::duration<double>(settings.max_seconds))};
  run.comparison.settings = settings;
  run.journal.add_note(begin_note(settings, desk));
  if (!settings.experiment.empty()) {
    write_text_file((fs::path(settings.directory) / "experiment.toml").string(),
                    settings.experiment);
  }
  if (desk) share(run, *desk);
  compare_all(run);
  if (desk && run.comparison.complete) {
    csv.reset();
    write_text_file((directory / "errors.csv").string(), rows_of(run.comparison));
  }
  Json end = {{run.comparison.complete ? "complete" : "stopped", date_and_time()}};
  if (desk) end["messages"] = traffic().messages, end["message_bytes"] = traffic().bytes;
  run.journal.add_note(end);
  return run.comparison;
}

}  // namespace lockstep
