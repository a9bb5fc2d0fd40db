// What `render --stats` writes.
#pragma once

#include "core/scene.h"
#include "packets/render.h"
#include "samplers/sampler_spec.h"

#include <nlohmann/json.hpp>

#include <string>

namespace lockstep {

// Times in seconds, memory in bytes; `paths` counts camera paths, `lanes_active` is a share.
nlohmann::ordered_json render_stats_json(const std::string& scene_name, const Scene& scene,
                                         const SamplerSpec& sampler, const RenderSettings& settings,
                                         const RenderResult& result);

}  // namespace lockstep
