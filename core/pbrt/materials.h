// Materials of pbrt-v3 and v4. The names of the two versions differ (matte and diffuse, plastic and
// coateddiffuse, metal and conductor), so the name alone decides how parameters are understood.
#pragma once

#include "core/material.h"
#include "core/pbrt/parameters.h"

#include <optional>
#include <string>

namespace lockstep::pbrt {

// The material `type`; nothing for an interface, whose shapes are not visible. A type that is not
// supported gives a warning and a diffuse grey.
std::optional<Material> make_material(const std::string& type, const ParameterSet& parameters,
                                      Warnings& warnings);

}  // namespace lockstep::pbrt
