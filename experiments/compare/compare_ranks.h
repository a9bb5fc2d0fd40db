// A comparison on several ranks: references are rendered by all together, tile by tile; then each
// measures units (compare_units.h). Rank 0 keeps the journal, and measures as the others do. All
// see the output folder: images are written by the rank that renders them.
#pragma once

#include "experiments/compare/compare_case.h"
#include "experiments/compare/journal.h"
#include "experiments/distributed/desk.h"

#include <functional>
#include <string>
#include <vector>

namespace lockstep {

// What was measured of one case.
struct SharedCase {
  SceneComparison result;
  bool complete = false;              // the result is
  std::vector<JournalEntry> entries;  // that are new
};

// For rank 0. Throws Error, and Cancelled where it was asked to stop before the references were
// there.
std::vector<SharedCase> measure_on_ranks(const CompareSettings& settings,
                                         const std::vector<CasePlan>& plans,
                                         const std::vector<JournalEntry>& earlier,
                                         const std::string& journal_path,
                                         const std::function<void(const JournalEntry&)>& record,
                                         Desk& desk, const CompareProgress& progress);

// For all other ranks: measures what rank 0 asks for.
void help_compare(const CompareSettings& settings);

}  // namespace lockstep
