// Light sources of pbrt-v3 and v4.
#pragma once

#include "core/pbrt/parameters.h"
#include "core/scene_description.h"

#include <optional>
#include <string>

namespace lockstep::pbrt {

// What AreaLightSource `type` makes the shapes after it emit; nothing if that is black.
std::optional<Emission> make_area_light(const std::string& type, const ParameterSet& parameters,
                                        Warnings& warnings);

// The constant radiance of LightSource "infinite"; other lights give a warning and nothing.
std::optional<glm::vec3> make_environment(const std::string& type, const ParameterSet& parameters,
                                          Warnings& warnings);

}  // namespace lockstep::pbrt
