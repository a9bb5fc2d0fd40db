// The settings of a render, as they are stored in an image file's header.
#pragma once

#include "core/image.h"
#include "packets/render.h"
#include "samplers/sampler_spec.h"

#include <string>

namespace lockstep {

Metadata render_metadata(const std::string& scene, const SamplerSpec& sampler,
                         const RenderSettings& settings, const RenderResult& result);

}  // namespace lockstep
