// Colours of pbrt files, spectra included, as linear Rec. 709 RGB.
#pragma once

#include "core/pbrt/library.h"
#include "core/spectrum.h"

#include <glm/vec3.hpp>

#include <optional>
#include <string_view>

namespace lockstep::pbrt {

// The parameter `name` as a colour; nothing where it is absent or not known (with a warning). A
// spectrum may be a list of samples, a name or a file of samples, and gives a light its
// chromaticity with luminance 1, as in pbrt-v4; for textures see Inputs.
std::optional<glm::vec3> find_color(const ParameterSet& parameters, std::string_view name,
                                    ColorUse use, Library& library);

glm::vec3 get_color(const ParameterSet& parameters, std::string_view name, ColorUse use,
                    glm::vec3 fallback, Library& library);

}  // namespace lockstep::pbrt
