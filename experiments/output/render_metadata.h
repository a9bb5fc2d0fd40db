// The settings of a render, as they are stored in an image file's header.
#pragma once

#include "core/image.h"
#include "packets/render.h"
#include "samplers/sampler_spec.h"

#include <string>

namespace lockstep {

// "biased: clamped at 10": how an image is labelled whose samples are.
std::string clamp_text(float clamp);

Metadata render_metadata(const std::string& scene, const SamplerSpec& sampler,
                         const RenderSettings& settings, const RenderResult& result);

}  // namespace lockstep
