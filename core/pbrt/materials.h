// Materials of pbrt-v2, v3 and v4. The names of the versions differ (matte and diffuse, plastic and
// coateddiffuse, metal and conductor), or the parameters do, so that these alone decide how they
// are understood.
#pragma once

#include "core/pbrt/inputs.h"

#include <optional>
#include <string>

namespace lockstep::pbrt {

// The material as the scene has it, made when first asked for; nothing for an interface, whose
// shapes are not visible. A type that is not supported gives a warning and the nearest that is.
// Throws where the material refers to itself or to what is not defined.
const std::optional<Material>& made_material(Library& library, MaterialDeclaration& declaration);

// Scales how much of the surface is there.
void multiply_opacity(Library& library, Material& material, const FloatInput& opacity);

}  // namespace lockstep::pbrt
