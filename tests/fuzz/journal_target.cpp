// Journals of comparisons: one that is damaged is listed, and refused with its line or gone on
// with.
#include "experiments/compare/journal.h"
#include "experiments/compare/run_list.h"
#include "experiments/metrics/metrics.h"
#include "tests/fuzz/fuzz_target.h"
#include "tests/fuzz/own_errors.h"
#include "tests/fuzz/playground.h"

#include <string>
#include <variant>
#include <vector>

namespace lockstep::fuzz {
namespace {

void resume(const std::string& folder) {
  Journal journal(folder, true);
  for (const JournalEntry& entry : journal.earlier()) {
    if (const auto* measured = std::get_if<MeasuredRun>(&entry.what)) {
      require(measured->run.errors.size() == metrics().size(), "a render lacks metrics");
    }
    journal.add(entry);
  }
  const std::size_t entries = journal.earlier().size();
  if (entries == 0) return;
  const std::string last =
      read_journal_lines(journal.path())
          .back()
          .dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  require(last != "null", "what is written cannot be read");
}

void list(const std::string& folder) {
  const std::vector<ListedRun> runs = list_runs(folder);
  require(!run_table(runs).empty() || runs.empty(), "no table");
  runs_json(runs).dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace
}  // namespace lockstep::fuzz

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace lockstep;
  static const fuzz::Playground playground;
  playground.write(std::string(kJournalFile), data, size);
  fuzz::expect_own_errors("runs", [] { fuzz::list(playground.path("")); });
  fuzz::expect_own_errors("journal", [] { fuzz::resume(playground.path("")); });
  return 0;
}
