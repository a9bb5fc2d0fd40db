// Scene files of Mitsuba 0.4 to 0.6, 2 and 3 (mitsuba-renderer.org, documentation of 0.5;
// mitsuba.readthedocs.io).
#pragma once

#include "core/scene_description.h"

#include <string>

namespace lockstep {

// Reads the scene file `path` and what it refers to, but for images, which are only named. What is
// not understood gives warnings; a scene without a sensor or a light gets the default ones
// (core/default_view.h). Throws Error ("file:line: ...") on what is missing or malformed.
SceneDescription read_mitsuba(const std::string& path);

}  // namespace lockstep
