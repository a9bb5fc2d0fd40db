// lockstep runs: the comparisons that there are.
#include "experiments/commands/commands.h"
#include "experiments/compare/run_list.h"

#include <fmt/format.h>

#include <memory>

namespace lockstep {
namespace {

struct RunsOptions {
  std::string directory = "out";
  bool json = false;
};

void print_runs(const RunsOptions& options) {
  const std::vector<ListedRun> runs = list_runs(options.directory);
  if (options.json) {
    using Json = nlohmann::ordered_json;
    fmt::print("{}\n", runs_json(runs).dump(2, ' ', false, Json::error_handler_t::replace));
  } else if (runs.empty()) {
    fmt::print("{}: no comparisons\n", options.directory);
  } else {
    fmt::print("{}", run_table(runs));
  }
}

}  // namespace

void add_runs_command(CLI::App& program, RunCommand& run) {
  CLI::App* command = program.add_subcommand("runs", "List the comparisons in a folder");
  command->description(
      "List the comparisons in a folder\n\n"
      "List the comparisons in DIR and its folders: when each was begun, whether it is complete,\n"
      "how many of its renders are done, its scenes and samplers. What was stopped goes on with\n"
      "lockstep compare DIR/experiment.toml --resume.");
  auto options = std::make_shared<RunsOptions>();
  command->add_option("DIR", options->directory, "Folder to look in")
      ->type_name("")
      ->capture_default_str();
  command->add_flag("--json", options->json, "As JSON");
  command->callback([options, &run] { run = [options] { print_runs(*options); }; });
}

}  // namespace lockstep
