// Light sources of pbrt.
#pragma once

#include "core/pbrt/state.h"

#include <glm/mat4x4.hpp>

#include <memory>
#include <optional>
#include <string>

namespace lockstep::pbrt {

// "L" or "I", whichever `name` is, times "scale", which is a number in v4 and a colour in v3.
// Throws where it is negative.
glm::vec3 get_light_color(const ParameterSet& parameters, const char* name, Library& library);

// What AreaLightSource `type` makes the shapes after it emit; null if that is black.
std::shared_ptr<AreaLight> make_area_light(const std::string& type, const ParameterSet& parameters,
                                           Library& library);

// What shapes emit under `light`, its power aside.
Emission emission_of(AreaLight& light, Library& library);

// Scales `emission` so that `geometry` emits `power` in all, if that is above 0.
void set_power(float power, const Geometry& geometry, Emission& emission);

// A light at a point or from one direction; nothing, with a warning, for other types.
std::optional<LightSource> make_light(const std::string& type, const ParameterSet& parameters,
                                      const glm::dmat4& light_to_world, Library& library);

// Adds LightSource "infinite" to what surrounds the scene: constants add up; of images the first
// stays, alone.
void add_environment(const ParameterSet& parameters, const glm::dmat4& light_to_world,
                     Library& library, std::optional<Environment>& environment);

}  // namespace lockstep::pbrt
