// The comparisons beneath a folder, by their journals.
#pragma once

#include <nlohmann/json.hpp>

#include <string>
#include <string_view>
#include <vector>

namespace lockstep {

enum class RunState {
  Complete,
  Running,
  Stopped,  // by its user, by the time it was given, or by an error or a kill: --resume goes on
  Damaged   // the journal does not say what the experiment was
};

std::string_view name(RunState state);

struct ListedRun {
  std::string directory;
  RunState state = RunState::Damaged;
  std::string begun;  // local time, ISO 8601, of the last time that it was started
  std::vector<std::string> scenes, samplers;
  std::size_t renders = 0;  // that are done
  std::size_t planned = 0;
};

// By the time when they were begun. Folders that cannot be read are passed over. Throws Error where
// `directory` is none.
std::vector<ListedRun> list_runs(const std::string& directory);

// A line for each.
std::string run_table(const std::vector<ListedRun>& runs);

nlohmann::ordered_json runs_json(const std::vector<ListedRun>& runs);

}  // namespace lockstep
