#include "experiments/output/render_metadata.h"

#include "experiments/output/machine.h"

#include <fmt/format.h>

namespace lockstep {

std::string clamp_text(float clamp) { return fmt::format("biased: clamped at {}", clamp); }

Metadata render_metadata(const std::string& scene, const SamplerSpec& sampler,
                         const RenderSettings& settings, const RenderResult& result) {
  const RenderStats& stats = result.stats;
  Metadata metadata{{"scene", scene},
                    {"sampler", to_string(sampler)},
                    {"spp", std::to_string(stats.spp)},
                    {"depth", std::to_string(settings.depth)},
                    {"seed", std::to_string(settings.seed)},
                    {"width", std::to_string(stats.width)},
                    {"isa", std::string(name(settings.isa))},
                    {"lanes", to_string(stats.lanes)},
                    {"threads", std::to_string(stats.threads)},
                    {"resolution", fmt::format("{}x{}", result.image.width, result.image.height)},
                    {"version", std::string(version())},
                    {"cpu_seconds", fmt::format("{:.6g}", stats.cpu_seconds)},
                    {"wall_seconds", fmt::format("{:.6g}", stats.wall_seconds)},
                    {"biased", sampler.unbiased() && !settings.clamp ? "no" : "yes"}};
  if (settings.clamp) {
    metadata["bias"] = clamp_text(*settings.clamp);
    metadata["clamp"] = fmt::format("{}", *settings.clamp);
    metadata["clamped_samples"] = std::to_string(stats.clamped);
  }
  return metadata;
}

}  // namespace lockstep
