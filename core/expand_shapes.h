// Shapes as Embree and the kernels take them.
#pragma once

#include "core/scene_description.h"

namespace lockstep {

// Afterwards the scene holds meshes and spheres alone: disks become meshes of the same area, and
// each instance gets its own copy of its object's shapes.
void expand_shapes(SceneDescription& scene);

}  // namespace lockstep
