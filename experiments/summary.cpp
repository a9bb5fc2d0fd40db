#include "experiments/summary.h"

#include "experiments/machine.h"
#include "experiments/metrics.h"
#include "experiments/render_metadata.h"
#include "experiments/statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

namespace lockstep {
namespace {

using Json = nlohmann::ordered_json;

// One sampler's runs by sample count; each list is in the order of the seeds.
using Rungs = std::map<int, std::vector<const Measurement*>>;

Rungs rungs_of(const SceneComparison& scene, int sampler) {
  Rungs rungs;
  for (const Measurement& run : scene.runs) {
    if (run.sampler == sampler) rungs[run.spp].push_back(&run);
  }
  for (auto& [spp, runs] : rungs) {
    std::sort(runs.begin(), runs.end(),
              [](const Measurement* a, const Measurement* b) { return a->seed < b->seed; });
  }
  return rungs;
}

template <class Get>
std::vector<double> values_of(const std::vector<const Measurement*>& runs, Get get) {
  std::vector<double> values;
  for (const Measurement* run : runs) values.push_back(get(*run));
  return values;
}

template <class Get>
Json spread_json(const std::vector<const Measurement*>& runs, Get get) {
  const Spread spread = spread_of(values_of(runs, get));
  return {{"median", spread.median}, {"p5", spread.p5}, {"p95", spread.p95}};
}

double cpu_median(const std::vector<const Measurement*>& runs) {
  return quantile(values_of(runs, [](const Measurement& run) { return run.cpu_seconds; }), 0.5);
}

// The median error of each rung at its median time.
std::vector<CurvePoint> median_curve(const Rungs& rungs, std::size_t metric) {
  std::vector<CurvePoint> curve;
  for (const auto& [spp, runs] : rungs) {
    const auto error = [&](const Measurement& run) { return run.errors[metric]; };
    curve.push_back({cpu_median(runs), quantile(values_of(runs, error), 0.5)});
  }
  return curve;
}

// One seed's errors at the rungs' median times: noise in a single timing stays out of the ratio.
std::vector<CurvePoint> seed_curve(const Rungs& rungs, std::uint32_t seed, std::size_t metric) {
  std::vector<CurvePoint> curve;
  for (const auto& [spp, runs] : rungs) {
    for (const Measurement* run : runs) {
      if (run->seed == seed) curve.push_back({cpu_median(runs), run->errors[metric]});
    }
  }
  return curve;
}

Json run_json(const Measurement& run) {
  Json json = {
      {"seed", run.seed}, {"cpu_seconds", run.cpu_seconds}, {"wall_seconds", run.wall_seconds}};
  for (std::size_t m = 0; m < metrics().size(); ++m)
    json[std::string(metrics()[m].name)] = run.errors[m];
  return json;
}

Json rung_json(const SceneComparison& scene, int sampler, int spp,
               const std::vector<const Measurement*>& runs) {
  Json json = {
      {"spp", spp},
      {"pilot_spp", runs.front()->pilot_spp},
      {"mean_weight",
       quantile(values_of(runs, [](const Measurement& r) { return r.mean_weight; }), 0.5)},
      {"lanes", to_string(runs.front()->lanes)},
      {"lanes_active",
       quantile(values_of(runs, [](const Measurement& r) { return r.lanes_active; }), 0.5)}};
  std::uint64_t nonfinite = 0;
  for (const Measurement* run : runs) nonfinite += run->nonfinite;
  json["nonfinite"] = nonfinite;
  json["cpu_seconds"] = spread_json(runs, [](const Measurement& run) { return run.cpu_seconds; });
  json["wall_seconds"] = spread_json(runs, [](const Measurement& run) { return run.wall_seconds; });
  for (std::size_t m = 0; m < metrics().size(); ++m) {
    json[std::string(metrics()[m].name)] =
        spread_json(runs, [m](const Measurement& run) { return run.errors[m]; });
  }
  for (const Measurement* run : runs) json["runs"].push_back(run_json(*run));
  for (const RunImages& images : scene.images) {
    if (images.sampler != sampler || images.spp != spp) continue;
    json["exr"] = images.exr;
    json["png"] = images.png;
    if (!images.weights_png.empty()) json["weights_png"] = images.weights_png;
  }
  return json;
}

// Ratio to the base sampler at `time`, over the seeds that both have at every rung around it.
Json ratio_json(const Rungs& rungs, const Rungs& base, std::size_t metric, double time) {
  std::set<std::uint32_t> seeds;
  for (const auto& [spp, runs] : rungs) {
    for (const Measurement* run : runs) seeds.insert(run->seed);
  }
  std::vector<double> errors, base_errors;
  for (std::uint32_t seed : seeds) {
    const std::optional<double> error = error_at(seed_curve(rungs, seed, metric), time);
    const std::optional<double> base_error = error_at(seed_curve(base, seed, metric), time);
    if (!error || !base_error) continue;
    errors.push_back(*error);
    base_errors.push_back(*base_error);
  }
  const std::optional<Ratio> ratio = paired_ratio(errors, base_errors);
  if (!ratio) return nullptr;
  Json json = {{"value", ratio->value}};
  if (ratio->low) json["interval_95"] = {*ratio->low, *ratio->high};
  return json;
}

Json budget_json(const std::vector<SamplerSpec>& samplers, const std::vector<Rungs>& rungs,
                 double time) {
  Json json = {{"cpu_seconds", time}, {"samplers", Json::array()}};
  for (std::size_t s = 0; s < samplers.size(); ++s) {
    Json entry = {{"sampler", to_string(samplers[s])}};
    for (std::size_t m = 0; m < metrics().size(); ++m) {
      const std::optional<double> error = error_at(median_curve(rungs[s], m), time);
      if (!error) continue;
      entry[std::string(metrics()[m].name)] = {{"median", *error},
                                               {"ratio", ratio_json(rungs[s], rungs[0], m, time)}};
    }
    json["samplers"].push_back(entry);
  }
  return json;
}

Json equal_time_json(const std::vector<SamplerSpec>& samplers, const std::vector<Rungs>& rungs) {
  std::vector<std::vector<CurvePoint>> curves;
  for (const Rungs& sampler_rungs : rungs) curves.push_back(median_curve(sampler_rungs, 0));
  Json json = {{"common_range", nullptr}, {"budgets", Json::array()}};
  const std::optional<TimeRange> range = common_times(curves);
  if (!range) return json;
  json["common_range"] = {range->low, range->high};
  for (double time : time_budgets(*range)) {
    json["budgets"].push_back(budget_json(samplers, rungs, time));
  }
  return json;
}

Json reference_json(const SceneComparison& scene) {
  const Reference& reference = scene.reference;
  Json json = {{"origin", reference.origin},
               {"file", reference.file},
               {"png", scene.reference_png},
               {"spp", nullptr},
               {"relmse_estimate", nullptr}};
  if (reference.spp > 0) json["spp"] = reference.spp;
  if (reference.relmse) json["relmse_estimate"] = *reference.relmse;
  return json;
}

Json scene_json(const SceneComparison& scene, const std::vector<SamplerSpec>& samplers) {
  Json json = {{"scene", scene.scene},
               {"label", scene.label},
               {"resolution", {scene.width, scene.height}},
               {"depth", scene.depth},
               {"width", scene.packet_width},
               {"threads", scene.threads},
               {"triangles", scene.triangles},
               {"features", scene.features},
               {"left_out", scene.left_out},
               {"warnings", scene.warnings},
               {"exposure", scene.exposure},
               {"reference", reference_json(scene)}};
  std::vector<Rungs> rungs;
  for (std::size_t s = 0; s < samplers.size(); ++s) {
    rungs.push_back(rungs_of(scene, int(s)));
    Json entry = {{"sampler", to_string(samplers[s])},
                  {"biased", !samplers[s].unbiased()},
                  {"rungs", Json::array()}};
    for (const auto& [spp, runs] : rungs.back()) {
      entry["rungs"].push_back(rung_json(scene, int(s), spp, runs));
    }
    json["samplers"].push_back(entry);
  }
  json["equal_time"] = equal_time_json(samplers, rungs);
  return json;
}

}  // namespace

Json summarize(const Comparison& comparison) {
  const CompareSettings& settings = comparison.settings;
  Json json = {{"lockstep", version()},
               {"date", date_and_time()},
               {"machine", {{"cpu", cpu_name()}, {"processors", cpu_count()}}},
               {"isa", name(settings.render.isa)},
               {"seeds", settings.seeds},
               {"spp", settings.rungs},
               {"complete", comparison.complete}};
  for (const Metric& metric : metrics()) {
    json["metrics"].push_back({{"name", metric.name},
                               {"title", metric.title},
                               {"unit", metric.unit},
                               {"lower_is_better", metric.lower_is_better}});
  }
  json["scenes"] = Json::array();
  for (const SceneComparison& scene : comparison.scenes) {
    json["scenes"].push_back(scene_json(scene, settings.samplers));
  }
  return json;
}

}  // namespace lockstep
