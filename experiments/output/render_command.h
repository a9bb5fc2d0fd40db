// The command that makes one image of an experiment again.
#pragma once

#include "core/image.h"
#include "packets/render.h"
#include "samplers/sampler_spec.h"

#include <string>

namespace lockstep {

// "lockstep render cornell --depth 5 --resolution 512x512 ...": what an image shows, without
// sampler, samples, seed and output. `overrides` are those of override_metadata().
std::string scene_command(const std::string& scene, const RenderSettings& settings, int depth,
                          int width, int height, const Metadata& overrides);

// The same with all else that the image depends on, and how its rays are traced.
std::string render_command(const std::string& scene, const SamplerSpec& sampler,
                           const RenderSettings& settings, int width, int height,
                           const Metadata& overrides);

// A warning line: where a sample was that was not finite, and the command that shows it again.
std::string nonfinite_text(const BadSample& bad, std::uint32_t seed, const std::string& command);

}  // namespace lockstep
