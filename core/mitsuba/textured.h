// Whether a material varies over the surface.
#pragma once

#include "core/scene_description.h"

namespace lockstep::mitsuba {

// Whether material `index`, or one that it mixes, refers to a texture.
bool is_textured(const SceneDescription& scene, int index);

}  // namespace lockstep::mitsuba
