#include "experiments/output/render_stats_json.h"

#include "experiments/output/machine.h"
#include "experiments/output/render_metadata.h"

namespace lockstep {
namespace {

constexpr const char* kind_names[ray_kinds] = {"camera", "bounce", "shadow"};
constexpr const char* stage_names[stages] = {"sampling", "traversal", "shading", "film"};

// Rays by kind and the mode that traced them.
nlohmann::ordered_json traversal_json(const RenderStats& stats) {
  nlohmann::ordered_json json;
  for (int kind = 0; kind < ray_kinds; ++kind) {
    auto& modes = json[kind_names[kind]] = nlohmann::ordered_json::object();
    for (int mode = 0; mode < traversal_modes; ++mode) {
      const std::uint64_t rays = stats.traced[kind][mode];
      if (rays > 0) modes[to_string(traversal_mode(mode))] = rays;
    }
  }
  return json;
}

nlohmann::ordered_json stages_json(const RenderStats& stats) {
  nlohmann::ordered_json json;
  for (int stage = 0; stage < stages; ++stage)
    json[stage_names[stage]] = stats.stage_seconds[stage];
  return json;
}

// Where the first samples were that were not finite.
nlohmann::ordered_json bad_samples_json(const RenderStats& stats, const RenderSettings& settings) {
  auto json = nlohmann::ordered_json::array();
  for (const BadSample& b : stats.bad_samples) {
    json.push_back({{"pixel", {b.x, b.y}}, {"sample", b.sample}, {"seed", settings.seed}});
  }
  return json;
}

// What is left of the peak is the program itself, its libraries and working memory.
nlohmann::ordered_json memory_json(const Scene& scene, const RenderStats& stats) {
  const SceneMemory memory = scene.memory();
  return {{"geometry", memory.geometry},
          {"embree", memory.embree},
          {"embree_peak", memory.embree_peak},
          {"film", stats.film_bytes}};
}

}  // namespace

nlohmann::ordered_json render_stats_json(const std::string& scene_name, const Scene& scene,
                                         const SamplerSpec& sampler, const RenderSettings& settings,
                                         const RenderResult& result) {
  const RenderStats& stats = result.stats;
  const double rate = stats.cpu_seconds > 0.0 ? double(stats.paths) / stats.cpu_seconds : 0.0;
  return {{"scene", scene_name},
          {"sampler", to_string(sampler)},
          {"width", stats.width},
          {"lanes", to_string(stats.lanes)},
          {"isa", name(settings.isa)},
          {"embree_version", embree_version()},
          {"threads", stats.threads},
          {"seed", settings.seed},
          {"spp", stats.spp},
          {"pilot_spp", stats.pilot_spp},
          {"depth", settings.depth},
          {"resolution", {result.image.width, result.image.height}},
          {"render_seconds", stats.wall_seconds},
          {"cpu_seconds", stats.cpu_seconds},
          {"paths", stats.paths},
          {"rays",
           {{"camera", stats.rays.camera},
            {"bounce", stats.rays.bounce},
            {"shadow", stats.rays.shadow}}},
          {"paths_per_cpu_second", rate},
          {"traversal", traversal_json(stats)},
          {"packets", stats.packets},
          {"lanes_active", stats.lanes_active},
          {"stage_cpu_seconds", stages_json(stats)},
          {"mean_weight", stats.mean_weight},
          {"zero_weights", stats.zero_weights},
          {"biased", !sampler.unbiased() || settings.clamp},
          {"bias", settings.clamp ? clamp_text(*settings.clamp) : ""},
          {"clamp", settings.clamp ? nlohmann::ordered_json(*settings.clamp) : nullptr},
          {"clamped", stats.clamped},
          {"nonfinite", stats.nonfinite},
          {"nonfinite_samples", bad_samples_json(stats, settings)},
          {"features", feature_names(scene.features())},
          {"left_out", feature_names(all_features & ~scene.features())},
          {"memory_bytes", memory_json(scene, stats)},
          {"peak_memory_bytes", peak_memory_bytes()},
          {"command", settings.command},
          {"version", version()}};
}

}  // namespace lockstep
