// What may be relied on in every scene that a reader accepts.
#pragma once

#include "core/scene_description.h"

#include <stdexcept>

namespace lockstep::fuzz {

struct Unusable : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// Checks that indices are in range, arrays match, and positions, normals, texture coordinates,
// lights and the camera are finite; then flattens the scene unless it is large (its arrays must be
// as sound). Throws Unusable; Errors of flatten() pass.
void check_usable(SceneDescription scene);

}  // namespace lockstep::fuzz
