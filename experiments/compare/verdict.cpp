#include "experiments/compare/verdict.h"

#include "experiments/compare/time_to_error.h"
#include "experiments/metrics/metrics.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace lockstep {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view kJudge = "flip_ldr";
constexpr std::string_view kRival = "random";

std::size_t judge() {
  const std::vector<Metric>& table = metrics();
  const auto place = std::find_if(table.begin(), table.end(),
                                  [](const Metric& metric) { return metric.name == kJudge; });
  return std::size_t(place - table.begin());
}

bool is_above(const Ratio& ratio) { return ratio.low && *ratio.low > 1.0; }
bool is_below(const Ratio& ratio) { return ratio.high && *ratio.high < 1.0; }

struct RatioAt {
  double seconds = 0.0;
  Ratio ratio;
};

// One sampler against the rival; longest time first.
struct Standing {
  std::string sampler;
  std::vector<RatioAt> ratios;

  std::vector<RatioAt> losses() const {
    std::vector<RatioAt> lost;
    for (const RatioAt& at : ratios) {
      if (is_above(at.ratio)) lost.push_back(at);
    }
    return lost;
  }
};

// The lowest median at the longest time that all samplers cover.
struct Best {
  double seconds = 0.0;
  std::string sampler;
  std::vector<std::string> level;  // those that it is not shown to beat
};

// Where samplers stand, as lists of names and ratios.
struct Verdict {
  bool has_rival = false;
  bool has_intervals = true;
  std::vector<Standing> lost, won, level;  // lost: at any time; the others: at the longest
  std::vector<std::string> unjudged;
  std::optional<Best> best;
};

// The times asked for, as far as all cover them, longest first; those of the range where none is.
std::vector<double> budgets_of(const CompareSettings& settings, const std::vector<Rungs>& rungs) {
  const std::optional<TimeRange> range = common_times(rungs);
  if (!range) return {};
  std::vector<double> budgets;
  for (double time : settings.budgets) {
    if (time >= range->low && time <= range->high) budgets.insert(budgets.begin(), time);
  }
  return budgets.empty() ? time_budgets(*range) : budgets;
}

std::optional<Best> best_of(const CompareSettings& settings, const std::vector<Rungs>& rungs) {
  const std::vector<SamplerSpec>& samplers = settings.samplers;
  const std::vector<double> times = budgets_of(settings, rungs);
  if (times.empty()) return {};
  std::vector<double> errors;
  for (const Rungs& own : rungs) errors.push_back(*error_at(median_curve(own, judge()), times[0]));
  const std::size_t winner =
      std::size_t(std::min_element(errors.begin(), errors.end()) - errors.begin());
  Best best{times[0], to_string(samplers[winner]), {}};
  for (std::size_t s = 0; s < samplers.size(); ++s) {
    if (s == winner) continue;
    const auto ratio = ratio_at(rungs[s], rungs[winner], judge(), best.seconds);
    if (!ratio || !is_above(*ratio)) best.level.push_back(to_string(samplers[s]));
  }
  return best;
}

Standing standing_of(const std::string& sampler, const Rungs& own, const Rungs& rival,
                     const std::vector<double>& times) {
  Standing standing{sampler, {}};
  for (double time : times) {
    if (const auto ratio = ratio_at(own, rival, judge(), time)) {
      standing.ratios.push_back({time, *ratio});
    }
  }
  return standing;
}

void sort_in(Verdict& verdict, const Standing& standing) {
  if (standing.ratios.empty()) {
    verdict.unjudged.push_back(standing.sampler);
    return;
  }
  const Ratio& longest = standing.ratios.front().ratio;
  verdict.has_intervals &= longest.low.has_value();
  if (!standing.losses().empty()) {
    verdict.lost.push_back(standing);
  } else {
    (is_below(longest) ? verdict.won : verdict.level).push_back(standing);
  }
}

Verdict judged(const CompareSettings& settings, const std::vector<Rungs>& rungs) {
  const std::vector<SamplerSpec>& samplers = settings.samplers;
  Verdict verdict;
  verdict.best = best_of(settings, rungs);
  const auto is_rival = [](const SamplerSpec& spec) { return to_string(spec) == kRival; };
  const auto place = std::find_if(samplers.begin(), samplers.end(), is_rival);
  verdict.has_rival = place != samplers.end();
  if (!verdict.has_rival) return verdict;
  const Rungs& rival = rungs[std::size_t(place - samplers.begin())];
  const std::vector<double> shared = budgets_of(settings, rungs);
  for (std::size_t s = 0; s < samplers.size(); ++s) {
    if (is_rival(samplers[s])) continue;
    const std::vector<double> times =
        shared.empty() ? budgets_of(settings, {rungs[s], rival}) : shared;
    sort_in(verdict, standing_of(to_string(samplers[s]), rungs[s], rival, times));
  }
  return verdict;
}

std::vector<std::string> names_of(const std::vector<Standing>& standings) {
  std::vector<std::string> names;
  for (const Standing& standing : standings) names.push_back(standing.sampler);
  return names;
}

// "cpt (x1.31 [1.22, 1.40] at 0.49 s)"
std::string loss_text(const Standing& standing) {
  std::vector<std::string> ratios;
  for (const RatioAt& at : standing.losses()) {
    ratios.push_back(fmt::format("x{:.3g} [{:.3g}, {:.3g}] at {:.2g} s", at.ratio.value,
                                 *at.ratio.low, *at.ratio.high, at.seconds));
  }
  return fmt::format("{} ({})", standing.sampler, fmt::join(ratios, ", "));
}

std::string rival_text(const Verdict& verdict) {
  if (!verdict.has_rival) return "random was not run";
  std::vector<std::string> clauses, lost;
  for (const Standing& standing : verdict.lost) lost.push_back(loss_text(standing));
  if (!lost.empty()) {
    clauses.push_back(fmt::format("loses to random at equal time: {}", fmt::join(lost, ", ")));
  } else if (!verdict.won.empty() || (!verdict.level.empty() && verdict.has_intervals)) {
    clauses.push_back("none loses to random at equal time");
  }
  if (!verdict.level.empty()) {
    clauses.push_back(fmt::format(
        "no difference to random shown: {}{}", fmt::join(names_of(verdict.level), ", "),
        verdict.has_intervals ? "" : fmt::format(" (an interval needs {} seeds)", kFewestPairs)));
  }
  if (!verdict.unjudged.empty()) {
    clauses.push_back(fmt::format("not judged, with no time in common or an error of 0: {}",
                                  fmt::join(verdict.unjudged, ", ")));
  }
  return fmt::format("{}", fmt::join(clauses, "; "));
}

std::string best_text(const std::optional<Best>& best) {
  if (!best) return "no time is common to all, so none is best";
  std::string text = fmt::format("best at {:.2g} s: {}", best->seconds, best->sampler);
  if (!best->level.empty()) {
    text += fmt::format(" (no difference shown to {})", fmt::join(best->level, ", "));
  }
  return text;
}

// "random at 4 spp, owen at 4 and 16 spp" of the rungs that `holds` picks.
template <class Holds>
std::string rungs_text(const CompareSettings& settings, const std::vector<Rungs>& rungs,
                       Holds holds) {
  std::vector<std::string> parts;
  for (std::size_t s = 0; s < rungs.size(); ++s) {
    std::vector<int> counts;
    for (const auto& [spp, rung] : rungs[s]) {
      if (holds(rung)) counts.push_back(spp);
    }
    if (counts.empty()) continue;
    parts.push_back(
        fmt::format("{} at {} spp", to_string(settings.samplers[s]), fmt::join(counts, ", ")));
  }
  return fmt::format("{}", fmt::join(parts, ", "));
}

// What stands behind the verdict as further sentences, each with a space before it.
std::string further_text(const SceneComparison& scene, const CompareSettings& settings,
                         const std::vector<Rungs>& rungs) {
  std::string text;
  std::vector<std::string> times;
  for (const TimesToError& to : times_to_errors(settings, rungs)) {
    const std::string sentence = time_sentence(to, settings);
    if (!sentence.empty()) times.push_back(sentence);
  }
  if (const std::string unlike = unlike_machines(scene); !unlike.empty()) text += ' ' + unlike;
  if (!times.empty()) text += fmt::format(" In time: {}.", fmt::join(times, "; "));
  const std::string unsteady = rungs_text(settings, rungs, [&](const Rung& rung) {
    return median_uncertainty(rung.cpu_times).value_or(0.0) > settings.timing_spread;
  });
  if (!unsteady.empty()) {
    text +=
        fmt::format(" The timing spread is large, medians are uncertain by more than {:.3g} %: {}.",
                    100.0 * settings.timing_spread, unsteady);
  }
  const std::string near = rungs_text(settings, rungs, [&](const Rung& rung) {
    return is_near_reference(scene.reference, rung, judge());
  });
  if (!near.empty()) {
    text += fmt::format(" Less than three times the reference's own error: {}.", near);
  }
  return text;
}

Json standings_json(const std::vector<Standing>& standings) {
  Json list = Json::array();
  for (const Standing& standing : standings) {
    Json json = {{"sampler", standing.sampler}, {"ratios", Json::array()}};
    for (const RatioAt& at : standing.ratios) {
      Json entry = {{"cpu_seconds", at.seconds}, {"value", at.ratio.value}};
      if (at.ratio.low) entry["interval_95"] = {*at.ratio.low, *at.ratio.high};
      entry["loses"] = is_above(at.ratio);
      json["ratios"].push_back(entry);
    }
    list.push_back(json);
  }
  return list;
}

}  // namespace

Json verdict_json(const SceneComparison& scene, const CompareSettings& settings,
                  const std::vector<Rungs>& rungs) {
  const std::vector<SamplerSpec>& samplers = settings.samplers;
  if (samplers.size() < 2) return nullptr;
  const Verdict verdict = judged(settings, rungs);
  Json json = {
      {"scene", scene.scene},
      {"depth", scene.depth},
      {"metric", kJudge},
      {"sentence", fmt::format("{}, depth {}, by {}: {}; {}.{}", scene.scene, scene.depth,
                               metrics()[judge()].title, rival_text(verdict),
                               best_text(verdict.best), further_text(scene, settings, rungs))},
      {"loses_to_random", standings_json(verdict.lost)},
      {"beats_random", standings_json(verdict.won)},
      {"no_difference_shown", standings_json(verdict.level)},
      {"not_judged", verdict.unjudged},
      {"best", nullptr}};
  if (verdict.best) {
    json["best"] = {{"sampler", verdict.best->sampler},
                    {"cpu_seconds", verdict.best->seconds},
                    {"no_difference_shown_to", verdict.best->level}};
  }
  return json;
}

}  // namespace lockstep
