#include "experiments/compare/run_list.h"

#include "core/error.h"
#include "experiments/compare/journal.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <tuple>

namespace lockstep {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

// What the last start of the experiment set out to do.
void read_begin(const Json& note, ListedRun& run) {
  run.begun = note.at("begun").get<std::string>();
  run.scenes = note.at("scenes").get<std::vector<std::string>>();
  run.samplers = note.at("samplers").get<std::vector<std::string>>();
  run.planned = run.scenes.size() * std::max<std::size_t>(1, note.at("depths").size()) *
                run.samplers.size() * note.at("spp").size() * note.at("seeds").get<std::size_t>();
  run.state = RunState::Stopped;
}

using RenderKey = std::tuple<std::string, int, std::string, std::uint32_t, int>;

RenderKey key_of(const Json& line) {
  const Json& render = line.at("run");
  return {line.at("scene"), line.at("depth"), line.at("sampler"), render.at("seed"),
          render.at("spp")};
}

ListedRun listed(const fs::path& journal) {
  ListedRun run;
  run.directory = journal.parent_path().string();
  std::set<RenderKey> renders;
  for (const Json& line : read_journal_lines(journal.string())) {
    try {
      if (line.contains("run")) renders.insert(key_of(line));
      if (!line.contains("note")) continue;
      if (line["note"].contains("begun")) read_begin(line["note"], run);
      if (line["note"].contains("complete")) run.state = RunState::Complete;
    } catch (const Json::exception&) {
      continue;  // a line of another version
    }
  }
  run.renders = renders.size();
  if (is_being_appended(journal.string())) run.state = RunState::Running;
  return run;
}

}  // namespace

std::string_view name(RunState state) {
  switch (state) {
    case RunState::Complete:
      return "complete";
    case RunState::Running:
      return "running";
    case RunState::Stopped:
      return "stopped";
    case RunState::Damaged:
      return "damaged";
  }
  return "";
}

std::vector<ListedRun> list_runs(const std::string& directory) {
  std::error_code error;
  if (!fs::is_directory(directory, error)) {
    throw Error(directory + ": no such folder; name one that comparisons were written to");
  }
  std::vector<ListedRun> runs;
  fs::recursive_directory_iterator place(directory, fs::directory_options::skip_permission_denied,
                                         error);
  for (; !error && place != fs::recursive_directory_iterator(); place.increment(error)) {
    if (place->path().filename() == kJournalFile) runs.push_back(listed(place->path()));
  }
  std::sort(runs.begin(), runs.end(), [](const ListedRun& a, const ListedRun& b) {
    return std::tie(a.begun, a.directory) < std::tie(b.begun, b.directory);
  });
  return runs;
}

std::string run_table(const std::vector<ListedRun>& runs) {
  std::size_t width = std::string_view("folder").size();
  for (const ListedRun& run : runs) width = std::max(width, run.directory.size());
  std::string text = fmt::format("{:{}}  {:24}  {:8}  {:>11}  {}\n", "folder", width, "begun",
                                 "state", "renders", "scenes: samplers");
  for (const ListedRun& run : runs) {
    text += fmt::format("{:{}}  {:24}  {:8}  {:>11}  {}: {}\n", run.directory, width, run.begun,
                        name(run.state), fmt::format("{}/{}", run.renders, run.planned),
                        fmt::join(run.scenes, ", "), fmt::join(run.samplers, ","));
  }
  return text;
}

Json runs_json(const std::vector<ListedRun>& runs) {
  Json list = Json::array();
  for (const ListedRun& run : runs) {
    list.push_back({{"directory", run.directory},
                    {"begun", run.begun},
                    {"state", name(run.state)},
                    {"renders", run.renders},
                    {"planned", run.planned},
                    {"scenes", run.scenes},
                    {"samplers", run.samplers}});
  }
  return list;
}

}  // namespace lockstep
