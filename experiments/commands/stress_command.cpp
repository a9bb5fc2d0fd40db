// lockstep stress: extreme inputs with known answers.
#include "core/error.h"
#include "core/image_module.h"
#include "experiments/commands/commands.h"
#include "experiments/commands/options.h"
#include "experiments/output/output_file.h"
#include "experiments/output/progress.h"
#include "experiments/stress/stress.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>

namespace lockstep {
namespace {

constexpr int kQuickSeeds = 16;
constexpr int kFullSeeds = 32;

struct StressOptions {
  std::string directory, pattern;
  int seeds = 0;
  int threads = 0;
  bool quick = false, list = false, quiet = false;
};

std::string in_folder(const StressOptions& options, const char* name) {
  return (std::filesystem::path(options.directory) / name).string();
}

void list_cases(const std::vector<StressCase>& cases) {
  for (const StressCase& c : cases) fmt::print("{:<8} {:<30} {}\n", c.family, c.name, c.extreme);
}

StressPlan plan_of(const StressOptions& options) {
  StressPlan plan;
  plan.quick = options.quick;
  plan.seeds = options.seeds > 0 ? options.seeds : options.quick ? kQuickSeeds : kFullSeeds;
  plan.threads = options.threads;
  plan.folder = in_folder(options, "inputs");
  return plan;
}

// Rows are written as cases end, so that a run that is cut short keeps them, and in the order of
// the cases at last.
std::vector<StressResult> run_all(const std::vector<StressCase>& cases, const StressPlan& plan,
                                  const StressOptions& options) {
  const std::string csv = in_folder(options, "stress.csv");
  write_text_file(csv, stress_csv_header());
  AppendFile file(csv);
  ProgressMeter meter(options.quiet);
  auto results = run_stress(cases, plan, [&](const StressResult& done, double share) {
    file.append(stress_csv_rows(done));
    meter.show(share, done.tested.name);
  });
  std::string text = stress_csv_header();
  for (const StressResult& result : results) text += stress_csv_rows(result);
  write_text_file(csv, text);
  return results;
}

void run_stress_command(const StressOptions& options) {
  const std::vector<StressCase> cases = matching_cases(stress_cases(), options.pattern);
  if (cases.empty()) {
    throw UsageError(
        fmt::format("--case: no case matches '{}'; --list names them", options.pattern));
  }
  if (options.list) return list_cases(cases);
  if (options.directory.empty()) throw UsageError("--output is required");
  check_image_module();
  make_output_directory(options.directory);
  const StressPlan plan = plan_of(options);
  make_output_directory(plan.folder);
  const auto results = run_all(cases, plan, options);
  write_text_file(in_folder(options, "stress.html"), stress_page(results, plan));
  fmt::print("{}", stress_table(results));
  if (interrupted()) throw Cancelled();
  const auto failed = std::count_if(results.begin(), results.end(), [](const StressResult& r) {
    return verdict(r) == StressVerdict::Wrong || verdict(r) == StressVerdict::Vague;
  });
  if (failed > 0) {
    throw Error(fmt::format("{} of {} stress cases failed; {} shows them", failed, results.size(),
                            in_folder(options, "stress.html")));
  }
}

void add_options(CLI::App& command, StressOptions& options) {
  command.add_option("-o,--output", options.directory, "Folder for all results; made if missing")
      ->type_name("DIR");
  command.add_flag("--quick", options.quick,
                   "30 seconds: fewer seeds, and one at all widths but the first");
  command
      .add_option("--case", options.pattern,
                  "Only cases whose name has this in it, or matches it where it\nholds * or ?")
      ->type_name("NAME");
  command.add_flag("--list", options.list, "Name the cases and what is extreme about them");
  command
      .add_option("--seeds", options.seeds,
                  "Renders per case, width and sampler (default: 32,\nquick 16)")
      ->type_name("N")
      ->check(whole_number_between(2, 10000));
  command
      .add_option("--threads", options.threads, "Cases at a time; 0 means one for each processor")
      ->type_name("N")
      ->check(whole_number_between(0, 4096))
      ->capture_default_str();
  command.add_flag("--quiet", options.quiet, "No progress; results, warnings and errors only");
}

}  // namespace

void add_stress_command(CLI::App& program, RunCommand& run) {
  CLI::App* command = program.add_subcommand("stress", "Test extreme inputs with known answers");
  command->description(
      "Test extreme inputs with known answers\n\n"
      "Render scenes of extreme scale, light and material whose answers are known, and feed\n"
      "samplers, sums and weight maps with extreme numbers, at packet widths 1, 8 and 16 with "
      "five\n"
      "samplers. Takes up to 5 minutes on two cores.");
  command->footer(
      "DIR receives stress.csv, stress.html and inputs/, the images that scenes refer to. A case\n"
      "that is neither right nor refused with a clear message is an error (status 1).\n"
      "\n"
      "Examples:\n"
      "  lockstep stress -o out/stress\n"
      "  lockstep stress -o out/stress --quick\n"
      "  lockstep stress -o out/furnace --case 'furnace*' --seeds 64");
  auto options = std::make_shared<StressOptions>();
  add_options(*command, *options);
  command->callback([options, &run] { run = [options] { run_stress_command(*options); }; });
}

}  // namespace lockstep
