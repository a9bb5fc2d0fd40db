// Participating media, of which only the absorption inside of dielectrics is kept.
#pragma once

#include "core/pbrt/library.h"

#include <glm/vec3.hpp>

#include <string>

namespace lockstep::pbrt {

// Absorption per unit of length of the homogeneous medium `name` as it is understood at `order`;
// zero, with a warning, for other kinds. Throws where it is not defined.
glm::vec3 medium_absorption(Library& library, const std::string& name, int order,
                            const Location& where);

}  // namespace lockstep::pbrt
