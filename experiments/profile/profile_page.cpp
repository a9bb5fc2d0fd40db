#include "experiments/profile/profile_page.h"

#include "experiments/metrics/metrics.h"
#include "experiments/output/html_page.h"
#include "experiments/report/report.h"

#include <utility>

namespace lockstep {
namespace {

using Json = nlohmann::ordered_json;

Json class_json(const ReplayClass& c) {
  Json modes;
  for (int mode = 0; mode < replay_modes; ++mode) {
    if (c.seconds[mode] > 0.0) modes[replay_name(mode)] = rays_per_second(c, mode);
  }
  return {{"kind", name(c.kind)},
          {"bounce", c.bounce},
          {"rays", c.rays},
          {"modes", modes},
          {"best", replay_name(c.best_mode())},
          {"policy", to_string(c.policy_mode)},
          {"lanes_active", c.coherence.lanes_active},
          {"spread", c.coherence.spread()},
          {"triangles", c.coherence.triangles},
          {"materials", c.coherence.materials}};
}

Json counts_json(const std::optional<HardwareCounts>& counts, std::uint64_t paths) {
  if (!counts) return nullptr;
  return {{"cycles_per_path", counts->cycles / double(paths)},
          {"instructions_per_path", counts->instructions / double(paths)},
          {"cache_misses_per_path", counts->cache_misses / double(paths)},
          {"instructions_per_cycle", counts->instructions_per_cycle()}};
}

Json point_json(const ProfilePoint& point) {
  const Replay& r = point.replay;
  const double* stage = r.stats.stage_seconds;
  Json json = {{"weight", to_string(point.weight)},
               {"mean_weight", r.stats.mean_weight},
               {"lanes", to_string(point.lanes)},
               {"paths_per_second", double(r.stats.paths) / r.render_seconds},
               {"lanes_active", r.stats.lanes_active},
               {"policy_share", r.policy_share()},
               {"gain_over_single", gain_over_single(r)},
               {"stages",
                {{"sampling", stage[int(Stage::Sampling)]},
                 {"traversal", stage[int(Stage::Traversal)]},
                 {"shading", stage[int(Stage::Shading)]},
                 {"film", stage[int(Stage::Film)]}}},
               {"counters", counts_json(point.counts, r.stats.paths)},
               {"classes", Json::array()}};
  for (const ReplayClass& c : r.classes) json["classes"].push_back(class_json(c));
  return json;
}

Json errors_json(const ProfileErrors& errors) {
  Json values;
  for (std::size_t i = 0; i < errors.values.size(); ++i) {
    values[std::string(metrics()[i].name)] = errors.values[i];
  }
  return {{"spp", errors.spp}, {"cpu_seconds", errors.cpu_seconds}, {"values", values}};
}

}  // namespace

Json profile_json(const Profile& profile, const ProfileSettings& settings) {
  const ProfilePoint& base = base_point(profile);
  Json json = {{"scene", settings.scene},
               {"sampler", to_string(settings.sampler)},
               {"spp", settings.render.spp},
               {"depth", settings.render.depth},
               {"isa", std::string(name(settings.render.isa))},
               {"width", base.replay.stats.width},
               {"repeats", settings.repeats},
               {"seeds", settings.seeds},
               {"reference_spp", settings.reference_spp},
               {"packet_lanes", coherence_lanes},
               {"no_counters", profile.no_counters},
               {"base", {{"weight", to_string(base.weight)}, {"lanes", to_string(base.lanes)}}},
               {"metrics", Json::array()},
               {"weights", Json::array()},
               {"points", Json::array()},
               {"errors", Json::array()}};
  for (const Metric& metric : metrics()) {
    json["metrics"].push_back({{"name", std::string(metric.name)},
                               {"title", std::string(metric.title)},
                               {"lower_is_better", metric.lower_is_better}});
  }
  for (const ProfileWeight& weight : settings.weights) {
    json["weights"].push_back({{"weight", to_string(weight)},
                               {"lanes", to_string(fastest_point(profile, weight).lanes)}});
  }
  for (const ProfilePoint& point : profile.points) json["points"].push_back(point_json(point));
  for (const WeightErrors& errors : profile.errors) {
    json["errors"].push_back({{"weight", to_string(errors.weight)},
                              {"equal_samples", errors_json(errors.equal_samples)},
                              {"equal_time", errors_json(errors.equal_time)}});
  }
  return json;
}

std::string profile_html(const Profile& profile, const ProfileSettings& settings) {
  const std::string data = embeddable(profile_json(profile, settings));
  const PagePart parts[] = {
      {"{{CSS}}", profile_assets::style},
      {"{{D3}}", report_assets::d3},
      {"{{DATA}}", data},
      {"{{JS}}", profile_assets::script},
  };
  return filled_page(profile_assets::page, parts);
}

}  // namespace lockstep
