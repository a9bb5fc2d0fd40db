// Spectra that pbrt knows by name, as RGB.
#pragma once

#include <glm/vec3.hpp>

#include <optional>
#include <string_view>

namespace lockstep::pbrt {

// The indices of metals ("metal-Cu-eta", in v3 the file "spds/Cu.eta.spd") and glasses
// ("glass-BK7"), and illuminants ("stdillum-A") with luminance 1.
std::optional<glm::vec3> named_spectrum(std::string_view name);

}  // namespace lockstep::pbrt
