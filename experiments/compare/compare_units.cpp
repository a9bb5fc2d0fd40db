#include "experiments/compare/compare_units.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <numeric>
#include <utility>
#include <variant>

namespace lockstep {

UnitPool::UnitPool(const CompareSettings& settings, const std::vector<CasePlan>& plans,
                   std::vector<std::string> conditions, const std::vector<JournalEntry>& earlier,
                   std::function<void(const JournalEntry&)> record)
    : settings_(settings),
      plans_(plans),
      conditions_(std::move(conditions)),
      record_(std::move(record)),
      order_(plans.size()),
      cases_(plans.size()) {
  std::iota(order_.begin(), order_.end(), std::size_t(0));
  std::stable_sort(order_.begin(), order_.end(),
                   [&](std::size_t a, std::size_t b) { return plans_[a].cost > plans_[b].cost; });
  for (const JournalEntry& entry : earlier) {
    const std::optional<std::size_t> plan = plan_of(entry);
    const int sampler = place_of(settings_, entry.sampler);
    if (plan && sampler >= 0) note(*plan, entry, sampler);
  }
}

std::optional<std::size_t> UnitPool::plan_of(const JournalEntry& entry) const {
  for (std::size_t p = 0; p < plans_.size(); ++p) {
    const CasePlan& plan = plans_[p];
    if (settings_.scenes[plan.scene] == entry.scene && plan.depth == entry.depth) return p;
  }
  return {};
}

void UnitPool::note(std::size_t plan, const JournalEntry& entry, int sampler) {
  Case& c = cases_[plan];
  c.unsteady.reset();
  if (const auto* repeat = std::get_if<TimingRepeat>(&entry.what)) {
    c.measured.repeats.push_back(*repeat);
    c.measured.repeats.back().sampler = sampler;
    return;
  }
  const Measurement& run = std::get<MeasuredRun>(entry.what).run;
  const bool is_wanted =
      run.seed < std::uint32_t(settings_.seeds) &&
      std::find(settings_.rungs.begin(), settings_.rungs.end(), run.spp) != settings_.rungs.end();
  if (!is_wanted || !c.renders[run.seed][run.cpu].insert({sampler, run.spp}).second) return;
  c.measured.runs.push_back(run);
  c.measured.runs.back().sampler = sampler;
}

bool UnitPool::is_complete(const Case& c, int seed) const {
  const auto place = c.renders.find(std::uint32_t(seed));
  if (place == c.renders.end()) return false;
  const std::size_t all = settings_.samplers.size() * settings_.rungs.size();
  return std::any_of(place->second.begin(), place->second.end(),
                     [all](const auto& of_cpu) { return of_cpu.second.size() == all; });
}

bool UnitPool::are_seeds_complete(const Case& c) const {
  for (int seed = 0; seed < settings_.seeds; ++seed) {
    if (!is_complete(c, seed)) return false;
  }
  return true;
}

// Also works out what the round is for.
bool UnitPool::wants_round(Case& c) const {
  if (repeats_so_far(c.measured) >= most_repeats(settings_)) return false;
  if (!c.unsteady) c.unsteady = unsteady_rungs(c.measured, settings_);
  return !c.unsteady->empty();
}

std::optional<Unit> UnitPool::unit_of(std::size_t plan, int rank, const std::string& cpu) {
  Case& c = cases_[plan];
  for (int seed = 0; seed < settings_.seeds; ++seed) {
    if (is_complete(c, seed) || c.owners.contains(seed)) continue;
    c.owners[seed] = rank;
    Unit unit{plan, seed, -1, {}};
    const Renders& done = c.renders[std::uint32_t(seed)][cpu];
    unit.rungs.assign(done.begin(), done.end());
    return unit;
  }
  if (c.round_owner || !are_seeds_complete(c) || !wants_round(c)) return {};
  c.round_owner = rank;
  Unit unit{plan, 0, repeats_so_far(c.measured), {}};
  for (const UnsteadyRung& rung : *c.unsteady) unit.rungs.emplace_back(rung.sampler, rung.spp);
  return unit;
}

std::optional<Unit> UnitPool::take(int rank, const std::string& cpu) {
  const std::lock_guard lock(mutex_);
  for (std::size_t plan : order_) {
    if (std::optional<Unit> unit = unit_of(plan, rank, cpu)) return unit;
  }
  return {};
}

std::string UnitPool::add(const JournalEntry& entry) {
  const std::lock_guard lock(mutex_);
  const std::optional<std::size_t> plan = plan_of(entry);
  const int sampler = place_of(settings_, entry.sampler);
  if (!plan || sampler < 0) return "it measures another comparison";
  if (entry.conditions != conditions_[*plan]) {
    return fmt::format("it measures under other conditions ({}) than rank 0 ({})", entry.conditions,
                       conditions_[*plan]);
  }
  Case& c = cases_[*plan];
  if (const auto* measured = std::get_if<MeasuredRun>(&entry.what)) {
    const Measurement& run = measured->run;
    // By a rank that was given up too early, and by the one that has its work.
    if (c.renders[run.seed][run.cpu].contains({sampler, run.spp})) return {};
  }
  record_(entry);
  c.added.push_back(entry);
  note(*plan, entry, sampler);
  change_.notify_all();
  return {};
}

void UnitPool::release(int rank) {
  const std::lock_guard lock(mutex_);
  for (Case& c : cases_) {
    std::erase_if(c.owners, [rank](const auto& owner) { return owner.second == rank; });
    if (c.round_owner == rank) c.round_owner.reset();
  }
  change_.notify_all();
}

void UnitPool::wait(double seconds) {
  std::unique_lock lock(mutex_);
  change_.wait_for(lock, std::chrono::duration<double>(seconds));
}

bool UnitPool::done() const {
  const std::lock_guard lock(mutex_);
  return std::all_of(cases_.begin(), cases_.end(), [&](Case& c) {
    return are_seeds_complete(c) && !c.round_owner && !wants_round(c);
  });
}

bool UnitPool::is_taken() const {
  const std::lock_guard lock(mutex_);
  return std::any_of(cases_.begin(), cases_.end(),
                     [](const Case& c) { return !c.owners.empty() || c.round_owner; });
}

double UnitPool::share_done() const {
  const std::lock_guard lock(mutex_);
  double done = 0.0, all = 0.0;
  for (std::size_t p = 0; p < plans_.size(); ++p) {
    const double cost = plans_[p].cost;
    all += cost * settings_.seeds * work_per_seed(settings_);
    for (const auto& [seed, cpus] : cases_[p].renders) {
      double most = 0.0;
      for (const auto& [cpu, renders] : cpus) {
        double samples = 0.0;
        for (const auto& [sampler, spp] : renders) samples += spp;
        most = std::max(most, samples);
      }
      done += cost * most;
    }
  }
  return all > 0.0 ? done / all : 1.0;
}

}  // namespace lockstep
