// What may be relied on in every scene that a reader accepts.
#pragma once

#include "core/scene_description.h"
#include "tests/fuzz/own_errors.h"

namespace lockstep::fuzz {

// Checks that indices are in range, arrays match, and positions, normals, texture coordinates,
// lights and the camera are finite; then flattens the scene unless it is large (its arrays must be
// as sound). Throws Unusable; Errors of flatten() pass.
void check_usable(SceneDescription scene);

}  // namespace lockstep::fuzz
