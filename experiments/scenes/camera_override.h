// A camera as the command line states it, in place of parts of the scene's.
#pragma once

#include "core/camera_description.h"

#include <glm/vec3.hpp>

#include <optional>
#include <string>

namespace lockstep {

// Parts of a camera; those left empty stay the scene's. World space, in the scene's unit.
struct CameraOverride {
  std::optional<glm::vec3> origin, target, up;
  std::optional<float> fov_degrees, lens_radius, focal_distance;  // as CameraDescription has them
};

// Reads "origin=x,y,z:target=x,y,z:up=x,y,z:fov=degrees:lens=radius:focus=distance", any of these
// in any order (';' does for ':'), or a JSON file: an object with the same keys, whose values are
// arrays of three numbers, or numbers. A text names a file where it ends in ".json" or has no '='.
// Throws UsageError for a text that is wrong, Error for a file.
CameraOverride parse_camera(const std::string& text);

// In the form that parse_camera reads. Empty where nothing is set.
std::string to_string(const CameraOverride& camera);

// What turns any perspective camera with the same shift and handedness into this one, to six
// digits.
CameraOverride override_of(const CameraDescription& camera);

// Without a target the camera keeps its direction. What is on the image's right stays there: left-
// handed scenes stay left-handed. Where `up` is not given, a camera that turns to a target stands
// as the scene's does: upright along the axis of the world that is nearest to its upward one, or
// along its own where it was rolled against that. A fov makes an orthographic camera perspective.
// A lens given with a target and without focus is sharp at the target's distance.
// Throws UsageError where the target is where the camera is, or `up` along the direction of view.
void apply_override(const CameraOverride& change, CameraDescription& camera);

}  // namespace lockstep
