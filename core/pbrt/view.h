// Camera, film and pixel filter of pbrt-v3 and v4. Their defaults differ between the versions.
#pragma once

#include "core/pbrt/parameters.h"
#include "core/scene_description.h"

#include <glm/mat4x4.hpp>

#include <optional>
#include <string>

namespace lockstep::pbrt {

// pbrt does not state its version in the file. The film's type tells it: v3 has only "image", which
// v4 renamed. Without a film, a WorldEnd tells v3, since v4 dropped that directive.
enum class Version { v3, v4 };

// `world_to_camera` is the current transform at the directive.
CameraDescription make_camera(const std::string& type, const glm::dmat4& world_to_camera,
                              const ParameterSet& parameters, Warnings& warnings);

// The film's resolution; `parameters` may be absent.
FilmDescription make_film(Version version, const ParameterSet* parameters, Warnings& warnings);

// The pixel filter `type`; `parameters` may be absent, and the version's default is returned.
PixelFilter make_filter(Version version, const std::string& type, const ParameterSet* parameters,
                        Warnings& warnings);

}  // namespace lockstep::pbrt
