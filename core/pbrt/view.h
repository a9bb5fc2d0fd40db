// Camera, film and pixel filter of pbrt. Their defaults differ between the versions.
#pragma once

#include "core/pbrt/parameters.h"
#include "core/pbrt/version.h"
#include "core/scene_description.h"

#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>

#include <optional>
#include <string>

namespace lockstep::pbrt {

// The part of the plane z = 1 (in units where half the field of view is 1) or of the orthographic
// camera's space that the image shows. Whole only with the film's shape.
struct ScreenWindow {
  std::optional<glm::vec4> bounds;  // x from, x to, y from, y to; nothing: by the aspect ratio
  float aspect = 0.0f;              // 0: the film's
  Location where;
};

// All but what the window decides; `world_to_camera` is the current transform at the directive.
CameraDescription make_camera(const std::string& type, const glm::dmat4& world_to_camera,
                              const ParameterSet& parameters, Warnings& warnings);

ScreenWindow make_window(const ParameterSet& parameters);

// Sets the field of view or extent and the shift; pixels that are not square warn.
void apply_window(const ScreenWindow& window, const FilmDescription& film, Warnings& warnings,
                  CameraDescription& camera);

// The film's resolution; `parameters` may be absent.
FilmDescription make_film(Version version, const ParameterSet* parameters, Warnings& warnings);

// The pixel filter `type`; `parameters` may be absent, and the version's default is returned.
PixelFilter make_filter(Version version, const std::string& type, const ParameterSet* parameters,
                        Warnings& warnings);

}  // namespace lockstep::pbrt
