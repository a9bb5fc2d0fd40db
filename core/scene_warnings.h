// What is legal in a scene but cannot be rendered well.
#pragma once

#include "core/scene_description.h"

#include <string>

namespace lockstep {

// Scenes farther from the origin than this many times their own size (the diagonal of their bounds)
// lose detail: rays leave surfaces 2^-21 of the largest coordinate away, there a thousandth of it.
inline constexpr double farthest_in_sizes = 2097.0;

// One line where float coordinates are too coarse for the scene's place; else empty.
std::string precision_warning(const SceneDescription& scene);

}  // namespace lockstep
