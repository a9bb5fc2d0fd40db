#include "experiments/compare/compare_ranks.h"

#include "core/cpu_clock.h"
#include "core/error.h"
#include "experiments/compare/compare_phase.h"
#include "experiments/compare/compare_units.h"
#include "experiments/distributed/shared_tiles.h"
#include "experiments/output/activity.h"
#include "experiments/output/machine.h"
#include "experiments/output/progress.h"

#include <fmt/format.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <thread>
#include <utility>

namespace lockstep {
namespace {

using JsonMessage = nlohmann::json;

constexpr double kLastRenderSeconds = 10.0;
constexpr double kSharedFileSeconds = 20.0;  // until a file of another machine is seen

using Show = std::function<bool(double work, std::string_view label)>;
using Record = std::function<void(const JournalEntry&)>;

RenderSettings settings_at(const CompareSettings& settings, int depth) {
  RenderSettings render = settings.render;
  render.depth = depth;
  return render;
}

// Another machine has just written it.
void await_reference(const CompareSettings& settings, const SceneComparison& comparison,
                     const Scene& scene) {
  const double start = wall_seconds();
  while (!has_reference(settings, comparison, scene)) {
    if (wall_seconds() - start > kSharedFileSeconds) {
      throw Error(
          fmt::format("{}: the reference of {} is not there; put the output folder where "
                      "all machines see it",
                      settings.directory, comparison.scene));
    }
    say_alive();
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
}

// Measures units, on any rank.
class CaseWorker {
 public:
  CaseWorker(const CompareSettings& settings, KeptScene& scene, Record record, Show show)
      : settings_(settings), scene_(scene), record_(std::move(record)), show_(std::move(show)) {}

  void measure(const Unit& unit, const CasePlan& plan) {
    open(unit.plan, plan);
    phase_->done.clear();
    result_.runs.clear(), result_.repeats.clear();
    result_.spectra.clear(), result_.images.clear();
    if (unit.round >= 0) {
      std::vector<UnsteadyRung> rungs;
      for (const auto& [sampler, spp] : unit.rungs) rungs.push_back({sampler, spp});
      repeat_round(*phase_, unit.round, rungs, 0.0);
      return;
    }
    for (const auto& [sampler, spp] : unit.rungs) {
      phase_->done.insert({sampler, std::uint32_t(unit.seed), spp});
    }
    measure_seed(*phase_, unit.seed, 0.0);
  }

  // Forgets the scene, which is needed for something else.
  void close() { phase_.reset(); }

 private:
  void open(std::size_t index, const CasePlan& plan) {
    if (phase_ && index == index_) return;
    phase_.reset();
    const Scene& scene = scene_.get(plan.scene);
    result_ = describe(settings_, plan, scene);
    await_reference(settings_, result_, scene);
    index_ = index;
    phase_.emplace(Phase{settings_, result_, &scene, settings_at(settings_, plan.depth), none_, "",
                         record_, show_});
    open_phase(*phase_, 0.0);
    warm_up(*phase_, 0.0);
  }

  const CompareSettings& settings_;
  KeptScene& scene_;
  const Record record_;
  const Show show_;
  const std::vector<JournalEntry> none_;
  SceneComparison result_;
  std::optional<Phase> phase_;
  std::size_t index_ = 0;
};

JsonMessage unit_json(const Unit& unit, const CasePlan& plan) {
  return {{"plan", unit.plan}, {"scene", plan.scene}, {"depth", plan.depth}, {"label", plan.label},
          {"seed", unit.seed}, {"round", unit.round}, {"rungs", unit.rungs}};
}

std::pair<Unit, CasePlan> parse_unit(const JsonMessage& json) {
  return {{json.at("plan"), json.at("seed"), json.at("round"),
           json.at("rungs").get<std::vector<std::pair<int, int>>>()},
          {json.at("scene"), json.at("depth"), json.at("label"), 0.0}};
}

// Rank 0's side of a comparison.
struct Lead {
  const CompareSettings& settings;
  const std::vector<CasePlan>& plans;
  const std::vector<JournalEntry>& earlier;
  const std::string& journal_path;
  const Record& record;
  Desk& desk;
  const CompareProgress& progress;
  KeptScene scene{settings};
  std::vector<SceneComparison> described = {};  // with references
  std::vector<std::string> conditions = {};

  bool show(double fraction, std::string_view label) const {
    return !progress || progress(fraction, label);
  }

  // References count for as much as the renders that follow.
  void open(std::size_t index) {
    const CasePlan& plan = plans[index];
    const Activity opening("the reference of " + settings.scenes[plan.scene]);
    const Scene& read = scene.get(plan.scene);
    desk.expect_silence(scene.seconds());
    SceneComparison result = describe(settings, plan, read);
    const double count = double(plans.size());
    Phase phase{settings,
                result,
                &read,
                settings_at(settings, plan.depth),
                earlier,
                journal_path,
                record,
                [&](double work, std::string_view label) {
                  return show(0.5 * (double(index) + work) / count, label);
                }};
    phase.render_half = [&](const Scene& s, const SamplerSpec& sampler,
                            const RenderSettings& render_settings, int half, const Progress& p) {
      const JsonMessage what = {{"scene", plan.scene}, {"depth", plan.depth}, {"half", half}};
      return render(s, sampler, render_settings, p,
                    share_tiles(desk, what, render_settings.threads));
    };
    open_phase(phase, 1.0);
    show_reference(phase);
    described.push_back(result);
    conditions.push_back(phase.conditions);
    restore(phase);  // refuses what was measured under other conditions
  }

  SharedCase finish(std::size_t index, const std::vector<JournalEntry>& added, bool all) {
    SharedCase shared{described[index], false, added};
    std::vector<JournalEntry> entries = earlier;
    entries.insert(entries.end(), added.begin(), added.end());
    Phase phase{settings, shared.result, nullptr, settings_at(settings, plans[index].depth),
                entries,  journal_path,  record,  {}};
    phase.conditions = conditions[index];
    restore(phase);
    shared.complete = all && all_done(phase);
    return shared;
  }
};

void measure_units(Lead& lead, UnitPool& pool) {
  std::set<int> rejected;  // ranks whose results are wrong: they get no more
  std::mutex mutex;
  std::exception_ptr failure;  // of the journal, on the desk's thread
  std::atomic<bool> stop = false;
  Handout handout;
  handout.next = [&](const Helper& helper) -> std::vector<Outgoing> {
    if (stop || rejected.contains(helper.rank)) return {};
    const std::optional<Unit> unit = pool.take(helper.rank, helper.cpu);
    if (!unit) return {};
    return {{MessageKind::Unit, bytes_of(unit_json(*unit, lead.plans[unit->plan]).dump())}};
  };
  handout.result = [&](const Helper& helper, const Message& message) {
    if (MessageKind(message.kind) != MessageKind::Record) return;
    try {
      const std::string wrong = pool.add(parse_journal_line(text_of(message)));
      if (wrong.empty() || !rejected.insert(helper.rank).second) return;
      fmt::print(stderr, "lockstep: warning: rank {} ({}) measures nothing that counts: {}\n",
                 helper.rank, helper.host, wrong);
    } catch (...) {
      const std::lock_guard lock(mutex);
      failure = std::current_exception();
    }
  };
  handout.idle = handout.lost = [&](const Helper& helper) { pool.release(helper.rank); };
  struct Rest {
    Desk& desk;
    ~Rest() { desk.rest(); }
  } rest{lead.desk};
  lead.desk.serve(std::move(handout));

  const auto show = [&](double, std::string_view label) {
    if (!lead.show(0.5 + 0.5 * pool.share_done(), label)) stop = true;
    return !stop;
  };
  const Record add = [&](const JournalEntry& entry) {
    const std::string wrong = pool.add(entry);
    if (!wrong.empty()) throw Error("rank 0: " + wrong);
  };
  CaseWorker worker(lead.settings, lead.scene, add, show);
  while (!stop && !pool.done()) {
    {
      const std::lock_guard lock(mutex);
      if (failure) std::rethrow_exception(failure);
    }
    const std::optional<Unit> unit = pool.take(0, cpu_name());
    if (unit) {
      try {
        worker.measure(*unit, lead.plans[unit->plan]);
      } catch (const Cancelled&) {
        stop = true;
      }
      pool.release(0);
    } else {
      pool.wait(0.05);
      show(0.0, "waiting for other ranks");
    }
  }
  // They were asked to stop, too, and finish what they render.
  const double start = wall_seconds();
  while (stop && pool.is_taken() && wall_seconds() - start < kLastRenderSeconds) pool.wait(0.1);
}

}  // namespace

std::vector<SharedCase> measure_on_ranks(const CompareSettings& settings,
                                         const std::vector<CasePlan>& plans,
                                         const std::vector<JournalEntry>& earlier,
                                         const std::string& journal_path, const Record& record,
                                         Desk& desk, const CompareProgress& progress) {
  Lead lead{settings, plans, earlier, journal_path, record, desk, progress};
  for (std::size_t index = 0; index < plans.size(); ++index) lead.open(index);
  UnitPool pool(settings, plans, lead.conditions, earlier, record);
  measure_units(lead, pool);
  const bool all = pool.done();
  std::vector<SharedCase> result;
  for (std::size_t index = 0; index < plans.size(); ++index) {
    result.push_back(lead.finish(index, pool.entries(index), all));
  }
  return result;
}

void help_compare(const CompareSettings& settings) {
  KeptScene scene(settings);
  const auto record = [](const JournalEntry& entry) { send_record(journal_line(entry)); };
  const auto show = [](double, std::string_view) {
    say_alive();
    return !interrupted();
  };
  CaseWorker worker(settings, scene, record, show);
  Skills skills;
  skills.join = [&](const JsonMessage& render) {
    worker.close();
    const Scene& read = scene.get(render.at("scene"));
    const RenderSettings half =
        half_settings(settings, settings_at(settings, render.at("depth")), render.at("half"));
    return std::make_unique<TileRenderer>(read, reference_sampler(), half, [](double) {
      say_alive();
      return true;
    });
  };
  skills.unit = [&](const JsonMessage& json) {
    const auto [unit, plan] = parse_unit(json);
    worker.measure(unit, plan);
  };
  help(skills);
}

}  // namespace lockstep
