// What several ranks measure of a comparison, unit by unit: all renders of one case and seed, which
// are paired and stay on one machine, or a round of repeats for their times. Nothing here knows how
// ranks talk to each other.
#pragma once

#include "experiments/compare/compare_case.h"
#include "experiments/compare/compare_phase.h"
#include "experiments/compare/journal.h"

#include <condition_variable>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace lockstep {

struct Unit {
  std::size_t plan = 0;  // which case
  int seed = 0;
  int round = -1;  // of repeats; -1: the unit is a seed
  // Samplers and sample counts that are done of the seed, or that the round is for.
  std::vector<std::pair<int, int>> rungs;
};

// All members may be called from any thread.
class UnitPool {
 public:
  // `conditions` by case (see Phase); `record` keeps an entry that is new, one at a time.
  UnitPool(const CompareSettings& settings, const std::vector<CasePlan>& plans,
           std::vector<std::string> conditions, const std::vector<JournalEntry>& earlier,
           std::function<void(const JournalEntry&)> record);

  // The next unit for a rank with that CPU, those of the longest cases first. Empty where there is
  // none now; there may be one when others are done.
  std::optional<Unit> take(int rank, const std::string& cpu);

  // What some rank has measured. Returns what is wrong with it; empty where nothing is. Throws what
  // `record` throws.
  std::string add(const JournalEntry& entry);

  // The rank works no more at what it took: what is missing of it is for others.
  void release(int rank);

  void wait(double seconds);  // for a change, but no longer than this
  bool done() const;
  bool is_taken() const;      // something, by some rank
  double share_done() const;  // of all renders, by their cost

  // What was added of a case.
  const std::vector<JournalEntry>& entries(std::size_t plan) const { return cases_[plan].added; }

 private:
  using Renders = std::set<std::pair<int, int>>;  // sampler, spp
  struct Case {
    std::map<std::uint32_t, std::map<std::string, Renders>> renders;  // by seed and CPU
    std::map<int, int> owners;                          // rank by seed that is being measured
    std::optional<int> round_owner;                     // rank that repeats
    SceneComparison measured;                           // times alone
    std::optional<std::vector<UnsteadyRung>> unsteady;  // as far as it is known
    std::vector<JournalEntry> added;
  };

  void note(std::size_t plan, const JournalEntry& entry, int sampler);
  bool is_complete(const Case& c, int seed) const;
  bool are_seeds_complete(const Case& c) const;
  bool wants_round(Case& c) const;
  std::optional<Unit> unit_of(std::size_t plan, int rank, const std::string& cpu);
  std::optional<std::size_t> plan_of(const JournalEntry& entry) const;

  const CompareSettings& settings_;
  const std::vector<CasePlan> plans_;
  const std::vector<std::string> conditions_;
  const std::function<void(const JournalEntry&)> record_;
  std::vector<std::size_t> order_;  // of the cases, the longest first
  mutable std::mutex mutex_;
  std::condition_variable change_;
  mutable std::vector<Case> cases_;  // wants_round() remembers what it has found
};

}  // namespace lockstep
