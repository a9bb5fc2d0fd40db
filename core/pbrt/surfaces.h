// What can only be settled when the whole file has been read: the materials of shapes and the
// objects of instances.
#pragma once

#include "core/pbrt/state.h"

namespace lockstep::pbrt {

// Fills the scene's textures, materials, objects and instances, and turns Shape::material into an
// index of the scene's materials. Shapes that cannot be seen are dropped. Throws where something
// that is used has not been defined.
void settle_surfaces(State& state);

}  // namespace lockstep::pbrt
