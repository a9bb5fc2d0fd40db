#include "experiments/compare/summary.h"

#include "experiments/compare/equal_time.h"
#include "experiments/compare/time_to_error.h"
#include "experiments/compare/verdict.h"
#include "experiments/metrics/metrics.h"
#include "experiments/output/command_line.h"
#include "experiments/output/machine.h"
#include "experiments/output/render_command.h"
#include "experiments/output/render_metadata.h"

#include <fmt/format.h>

namespace lockstep {
namespace {

using Json = nlohmann::ordered_json;

// The metrics that tables show, and their headings: errors as numbers, as a viewer judges them, and
// as seen from afar.
constexpr std::pair<std::string_view, std::string_view> kTable[] = {
    {"rmse", "RMSE"},
    {"relmse", "relMSE"},
    {"flip_ldr", "FLIP"},
    {"yee_pixels", "Yee pixels"},
    {"low_pass_rmse", "low-pass RMSE"},
};

Json spread_json(const std::vector<double>& values) {
  const Spread spread = spread_of(values);
  return {{"median", spread.median}, {"p5", spread.p5}, {"p95", spread.p95}, {"mean", spread.mean}};
}

Json run_json(const Measurement& run) {
  Json json = {
      {"seed", run.seed}, {"cpu_seconds", run.cpu_seconds}, {"wall_seconds", run.wall_seconds}};
  for (std::size_t m = 0; m < metrics().size(); ++m)
    json[std::string(metrics()[m].name)] = run.errors[m];
  return json;
}

// Powers at the scene's "frequencies", and that of white noise of the same total power.
Json spectrum_json(const ErrorSpectrum& spectrum) {
  Json json = {{"white_noise", spectrum.white}, {"power", Json::array()}};
  for (const SpectrumRing& ring : spectrum.rings) json["power"].push_back(ring.power);
  return json;
}

Json frequencies_json(const SceneComparison& scene) {
  Json list = Json::array();
  if (scene.spectra.empty()) return list;
  for (const SpectrumRing& ring : scene.spectra.front().mean.rings) list.push_back(ring.frequency);
  return list;
}

template <class Get>
double median_of(const std::vector<const Measurement*>& runs, Get get) {
  return quantile(values_of(runs, get), 0.5);
}

// Times of all renders, those repeated for it included, and how well their median is known.
Json timing_json(const Rung& rung, double limit) {
  const std::optional<double> uncertainty = median_uncertainty(rung.cpu_times);
  Json json = spread_json(rung.cpu_times);
  json["renders"] = rung.cpu_times.size();
  json["median_uncertainty"] = nullptr;
  if (uncertainty) json["median_uncertainty"] = *uncertainty;
  json["steady"] = uncertainty.value_or(0.0) <= limit;
  return json;
}

// Metrics whose median is not far above the reference's own error.
Json near_reference_json(const SceneComparison& scene, const Rung& rung) {
  Json list = Json::array();
  for (std::size_t m = 0; m < metrics().size(); ++m) {
    if (is_near_reference(scene.reference, rung, m)) list.push_back(metrics()[m].name);
  }
  return list;
}

Json rung_json(const SceneComparison& scene, const CompareSettings& settings, int sampler, int spp,
               const Rung& rung) {
  const std::vector<const Measurement*>& runs = rung.runs;
  Json json = {
      {"spp", spp},
      {"pilot_spp", runs.front()->pilot_spp},
      {"mean_weight", median_of(runs, [](const Measurement& r) { return r.mean_weight; })},
      {"lanes", to_string(runs.front()->lanes)},
      {"lanes_active", median_of(runs, [](const Measurement& r) { return r.lanes_active; })}};
  std::uint64_t clamped = 0, nonfinite = 0;
  for (const Measurement* run : runs) clamped += run->clamped, nonfinite += run->nonfinite;
  json["clamped"] = clamped;
  json["nonfinite"] = nonfinite;
  json["nonfinite_samples"] = Json::array();
  for (const Measurement* run : runs) {
    for (const BadSample& bad : run->bad_samples) {
      json["nonfinite_samples"].push_back({{"pixel", {bad.x, bad.y}},
                                           {"sample", bad.sample},
                                           {"seed", run->seed},
                                           {"command", command_of(scene, settings, *run)}});
    }
  }
  json["cpu_seconds"] = timing_json(rung, settings.timing_spread);
  json["wall_seconds"] =
      spread_json(values_of(runs, [](const Measurement& run) { return run.wall_seconds; }));
  for (std::size_t m = 0; m < metrics().size(); ++m) {
    json[std::string(metrics()[m].name)] =
        spread_json(values_of(runs, [m](const Measurement& run) { return run.errors[m]; }));
  }
  json["near_reference"] = near_reference_json(scene, rung);
  for (const RunSpectrum& spectrum : scene.spectra) {
    if (spectrum.sampler == sampler && spectrum.spp == spp) {
      json["spectrum"] = spectrum_json(spectrum.mean);
    }
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

Json ratio_json(const std::optional<Ratio>& ratio) {
  if (!ratio) return nullptr;
  Json json = {{"value", ratio->value}};
  if (ratio->low) json["interval_95"] = {*ratio->low, *ratio->high};
  return json;
}

// Adds the ratio of the two medians, and whether it lies outside the interval by more than a tenth:
// then a few pixels or seeds decide what one of the two says.
void add_ratio_of_medians(Json& ratio, double own, double base) {
  if (ratio.is_null() || !(base > 0.0)) return;
  constexpr double margin = 1.1;
  ratio["of_medians"] = own / base;
  if (!ratio.contains("interval_95")) return;
  const double low = ratio["interval_95"][0], high = ratio["interval_95"][1];
  ratio["medians_disagree"] = own / base < low / margin || own / base > high * margin;
}

// Null where a sampler was not measured at `time`.
Json budget_json(const std::vector<SamplerSpec>& samplers, const std::vector<Rungs>& rungs,
                 double time) {
  Json json = {{"cpu_seconds", time}, {"samplers", Json::array()}};
  for (std::size_t s = 0; s < samplers.size(); ++s) {
    Json entry = {{"sampler", to_string(samplers[s])}};
    for (std::size_t m = 0; m < metrics().size(); ++m) {
      Json& cell = entry[std::string(metrics()[m].name)];
      const std::optional<double> error = error_at(median_curve(rungs[s], m), time);
      if (!error) continue;
      cell = {{"median", *error}, {"ratio", ratio_json(ratio_at(rungs[s], rungs[0], m, time))}};
      const std::optional<double> base = error_at(median_curve(rungs[0], m), time);
      if (base) add_ratio_of_medians(cell["ratio"], *error, *base);
    }
    json["samplers"].push_back(entry);
  }
  return json;
}

Json equal_time_json(const CompareSettings& settings, const std::vector<Rungs>& rungs) {
  Json json = {{"common_range", nullptr}, {"budgets", Json::array()}};
  const std::optional<TimeRange> range = common_times(rungs);
  if (range) json["common_range"] = {range->low, range->high};
  std::vector<double> budgets(settings.budgets.rbegin(), settings.budgets.rend());
  if (budgets.empty() && range) budgets = time_budgets(*range);
  for (double time : budgets)
    json["budgets"].push_back(budget_json(settings.samplers, rungs, time));
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
  json["own_errors"] = reference.errors;
  return json;
}

Json scene_json(const SceneComparison& scene, const CompareSettings& settings,
                const std::vector<Rungs>& rungs) {
  const std::vector<SamplerSpec>& samplers = settings.samplers;
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
               {"unlike_machines", unlike_machines(scene)},
               {"exposure", scene.exposure},
               {"reference", reference_json(scene)},
               {"frequencies", frequencies_json(scene)}};
  for (std::size_t s = 0; s < samplers.size(); ++s) {
    Json entry = {{"sampler", to_string(samplers[s])},
                  {"biased", !samplers[s].unbiased()},
                  {"rungs", Json::array()}};
    for (const auto& [spp, rung] : rungs[s]) {
      entry["rungs"].push_back(rung_json(scene, settings, int(s), spp, rung));
    }
    json["samplers"].push_back(entry);
  }
  json["equal_time"] = equal_time_json(settings, rungs);
  json["time_to_error"] = times_to_errors_json(settings, rungs);
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
               {"overrides", override_metadata(settings.overrides)},
               {"complete", comparison.complete},
               {"timing_spread", settings.timing_spread},
               {"clamp", nullptr},
               {"experiment", settings.experiment}};
  if (settings.render.clamp) json["clamp"] = *settings.render.clamp;
  for (const Metric& metric : metrics()) {
    json["metrics"].push_back({{"name", metric.name},
                               {"title", metric.title},
                               {"unit", metric.unit},
                               {"lower_is_better", metric.lower_is_better}});
  }
  for (const auto& [metric, heading] : kTable) {
    json["table"].push_back({{"name", metric}, {"heading", heading}});
  }
  json["verdicts"] = Json::array();
  json["scenes"] = Json::array();
  for (const SceneComparison& scene : comparison.scenes) {
    std::vector<Rungs> rungs;
    for (std::size_t s = 0; s < settings.samplers.size(); ++s) {
      rungs.push_back(rungs_of(scene, int(s)));
    }
    const Json verdict = verdict_json(scene, settings, rungs);
    if (!verdict.is_null()) json["verdicts"].push_back(verdict);
    json["scenes"].push_back(scene_json(scene, settings, rungs));
    json["scenes"].back()["render_command"] =
        scene_command(scene.scene, settings.render, scene.depth, scene.width, scene.height,
                      override_metadata(settings.overrides));
  }
  json["command"] = own_command_line();
  json["system"] = system_name();
  for (const auto& [component, number] : component_versions()) {
    json["versions"][component] = number;
  }
  return json;
}

}  // namespace lockstep
