// Shapes as Embree and the kernels take them.
#pragma once

#include "core/scene_description.h"

namespace lockstep {

// Afterwards the scene holds meshes and spheres alone, its objects meshes, and instances can be
// inverted: disks become meshes of the same area, and what is placed only once becomes a shape.
void expand_shapes(SceneDescription& scene);

}  // namespace lockstep
