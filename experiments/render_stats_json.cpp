#include "experiments/render_stats_json.h"

#include "experiments/machine.h"
#include "experiments/render_metadata.h"

namespace lockstep {

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
          {"lanes_active", stats.lanes_active},
          {"mean_weight", stats.mean_weight},
          {"biased", !sampler.unbiased()},
          {"nonfinite", stats.nonfinite},
          {"features", scene.features().present()},
          {"left_out", scene.features().absent()},
          {"peak_memory_bytes", peak_memory_bytes()},
          {"version", version()}};
}

}  // namespace lockstep
