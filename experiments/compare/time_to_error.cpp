#include "experiments/compare/time_to_error.h"

#include "experiments/metrics/metrics.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

namespace lockstep {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view kDefaultMetric = "flip_ldr";

std::size_t metric_named(std::string_view name) {
  const std::vector<Metric>& table = metrics();
  const auto place = std::find_if(table.begin(), table.end(),
                                  [name](const Metric& metric) { return metric.name == name; });
  return std::size_t(place - table.begin());
}

double rounded_up(double value) {
  const double unit = std::pow(10.0, std::floor(std::log10(value)) - 1.0);
  return std::ceil(value / unit - 1e-9) * unit;
}

// The lowest error that every seed of every sampler comes down to from above.
std::optional<double> common_error(const std::vector<Rungs>& samplers, std::size_t metric) {
  double low = 0.0, high = HUGE_VAL;
  for (const Rungs& rungs : samplers) {
    if (rungs.empty()) return {};
    std::map<std::uint32_t, double> lowest;  // by seed
    for (const auto& [spp, rung] : rungs) {
      for (const Measurement* run : rung.runs) {
        const double error = run->errors[metric];
        const auto [place, is_new] = lowest.try_emplace(run->seed, error);
        place->second = std::min(place->second, error);
        if (spp == rungs.begin()->first) high = std::min(high, error);
      }
    }
    for (const auto& [seed, error] : lowest) low = std::max(low, error);
  }
  if (!(low > 0.0 && low < high)) return {};
  const double rounded = rounded_up(low);
  return rounded < high ? rounded : low;
}

std::size_t seeds_of(const Rungs& rungs) {
  std::set<std::uint32_t> seeds;
  for (const auto& [spp, rung] : rungs) {
    for (const Measurement* run : rung.runs) seeds.insert(run->seed);
  }
  return seeds.size();
}

// The first of the samplers is what the others are measured against.
TimesToError times_to(const std::vector<Rungs>& rungs, const std::vector<std::size_t>& samplers,
                      std::size_t metric, double error) {
  TimesToError times{metric, error, seeds_of(rungs[0]), {}};
  for (std::size_t s : samplers) {
    times.samplers.push_back({s, time_at(median_curve(rungs[s], metric), error),
                              time_ratio(rungs[s], rungs[0], metric, error)});
  }
  return times;
}

// For errors that all have in common or, where there is none, each with the first.
std::vector<TimesToError> times_to_common_errors(const std::vector<Rungs>& rungs,
                                                 const std::vector<std::size_t>& all,
                                                 std::size_t metric) {
  if (const auto error = common_error(rungs, metric)) return {times_to(rungs, all, metric, *error)};
  std::vector<TimesToError> pairs;
  for (std::size_t s = 1; s < rungs.size(); ++s) {
    const std::optional<double> error = common_error({rungs[0], rungs[s]}, metric);
    if (error) pairs.push_back(times_to(rungs, {0, s}, metric, *error));
  }
  return pairs;
}

// Two digits behind the point; two digits in all where that would be too few.
std::string factor_text(double value) {
  return value >= 0.1 && value < 100.0 ? fmt::format("{:.2f}", value)
                                       : fmt::format("{:.2g}", value);
}

Json time_ratio_json(const std::optional<Ratio>& ratio) {
  if (!ratio) return nullptr;
  Json json = {{"value", ratio->value}, {"seeds", ratio->pairs}};
  if (ratio->low) json["interval_95"] = {*ratio->low, *ratio->high};
  return json;
}

Json times_json(const TimesToError& times, const CompareSettings& settings) {
  Json json = {{"metric", metrics()[times.metric].name},
               {"error", times.error},
               {"sentence", time_sentence(times, settings)},
               {"samplers", Json::array()}};
  for (const TimeOfSampler& time : times.samplers) {
    Json entry = {{"sampler", to_string(settings.samplers[time.sampler])},
                  {"cpu_seconds", nullptr},
                  {"ratio", time_ratio_json(time.ratio)}};
    if (time.cpu_seconds) entry["cpu_seconds"] = *time.cpu_seconds;
    json["samplers"].push_back(entry);
  }
  return json;
}

}  // namespace

std::vector<TimesToError> times_to_errors(const CompareSettings& settings,
                                          const std::vector<Rungs>& rungs) {
  std::vector<std::size_t> samplers(rungs.size());
  std::iota(samplers.begin(), samplers.end(), std::size_t(0));
  if (settings.targets.empty()) {
    return times_to_common_errors(rungs, samplers, metric_named(kDefaultMetric));
  }
  std::vector<TimesToError> all;
  for (const ErrorTarget& target : settings.targets) {
    all.push_back(times_to(rungs, samplers, metric_named(target.metric), target.error));
  }
  return all;
}

std::string time_sentence(const TimesToError& times, const CompareSettings& settings) {
  const std::string base = to_string(settings.samplers[0]);
  const std::string goal = fmt::format("{} {:.3g}", metrics()[times.metric].title, times.error);
  std::vector<std::string> clauses, level, unknown;
  for (const TimeOfSampler& time : times.samplers) {
    if (time.sampler == 0) continue;
    const std::string name = to_string(settings.samplers[time.sampler]);
    const std::optional<Ratio>& ratio = time.ratio;
    if (!ratio || ratio->pairs < times.seeds) {
      unknown.push_back(name);
    } else if (!ratio->low || (*ratio->low <= 1.0 && *ratio->high >= 1.0)) {
      level.push_back(name);
    } else {
      clauses.push_back(fmt::format("{} needs {}x the time of {} for {}, 95 % interval {}-{}", name,
                                    factor_text(ratio->value), base, goal, factor_text(*ratio->low),
                                    factor_text(*ratio->high)));
    }
  }
  if (!level.empty()) {
    clauses.push_back(fmt::format("no difference shown to {} in the time for {}: {}", base, goal,
                                  fmt::join(level, ", ")));
  }
  if (!unknown.empty()) {
    clauses.push_back(
        fmt::format("not in all seeds measured down to {}: {}", goal, fmt::join(unknown, ", ")));
  }
  return fmt::format("{}", fmt::join(clauses, "; "));
}

Json times_to_errors_json(const CompareSettings& settings, const std::vector<Rungs>& rungs) {
  Json list = Json::array();
  for (const TimesToError& times : times_to_errors(settings, rungs)) {
    list.push_back(times_json(times, settings));
  }
  return list;
}

}  // namespace lockstep
