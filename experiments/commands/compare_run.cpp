#include "experiments/commands/compare_run.h"

#include "core/error.h"
#include "experiments/compare/errors_csv.h"
#include "experiments/compare/summary.h"
#include "experiments/output/output_file.h"
#include "experiments/output/progress.h"
#include "experiments/output/render_command.h"
#include "experiments/report/figures.h"
#include "experiments/report/report.h"

#include <fmt/format.h>

#include <filesystem>
#include <utility>

namespace lockstep {
namespace {

namespace fs = std::filesystem;

// How many samples were not finite, and where the first was; summary.json has more of them.
void warn_of_nonfinite(const CompareSettings& settings, const SceneComparison& scene) {
  std::uint64_t nonfinite = 0;
  const Measurement* first = nullptr;
  for (const Measurement& run : scene.runs) {
    nonfinite += run.nonfinite;
    if (!first && !run.bad_samples.empty()) first = &run;
  }
  if (nonfinite == 0) return;
  fmt::print(stderr, "lockstep: warning: {}: {} samples were not finite and were left out\n",
             scene.scene, nonfinite);
  if (first)
    fmt::print(stderr, "{}",
               nonfinite_text(first->bad_samples.front(), first->seed,
                              command_of(scene, settings, *first)));
}

// A result that is worth less than it looks is pointed out where the user will see it.
void warn(const Comparison& comparison) {
  for (const SceneComparison& scene : comparison.scenes) {
    for (const std::string& warning : scene.warnings) {
      fmt::print(stderr, "lockstep: warning: {}\n", warning);
    }
    warn_of_nonfinite(comparison.settings, scene);
  }
}

void write_results(const Comparison& comparison, const nlohmann::ordered_json& summary) {
  const fs::path directory = comparison.settings.directory;
  const std::string text =
      summary.dump(1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  write_text_file((directory / "summary.json").string(), text + '\n');
  write_text_file((directory / "spectra.csv").string(), spectra_csv(comparison));
  write_text_file((directory / "report.html").string(),
                  report_html(summary, report_images(comparison, summary, kReportImageBytes)));
}

}  // namespace

void run_comparison(const CompareSettings& settings, bool quiet, Desk* desk) {
  ProgressMeter meter(quiet);
  const auto show = [&](double fraction, std::string_view label) {
    meter.show(fraction, label);
    return !interrupted();
  };
  // As they come: who looks in, or must kill the run, finds the scenes that are done.
  const auto scene_done = [](const Comparison& so_far) {
    write_results(so_far, summarize(so_far));
  };
  const Comparison comparison = compare(settings, show, scene_done, desk);
  meter.clear();
  warn(comparison);
  if (interrupted() && comparison.scenes.empty()) {
    throw Error("stopped by the user before anything was measured; --resume goes on from here");
  }
  const auto summary = summarize(comparison);
  write_results(comparison, summary);
  const fs::path directory = settings.directory;
  const std::string figures = write_figures(summary, directory.string());
  fmt::print("{}\n", results_table(summary));
  for (const auto& [what, file] : {std::pair{"Every render", "errors.csv"},
                                   {"Spectra", "spectra.csv"},
                                   {"Summary", "summary.json"},
                                   {"Images", "*.png"},
                                   {"Report", "report.html"}}) {
    fmt::print("{:14}{}\n", fmt::format("{}:", what), (directory / file).string());
  }
  fmt::print("{:14}{}\n", "Figures:", figures);
  if (interrupted())
    throw Error(
        "stopped by the user; what was measured until then is in the report, and --resume goes on "
        "from there");
}

}  // namespace lockstep
