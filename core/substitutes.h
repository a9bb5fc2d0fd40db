// Stand-ins for what readers understand and kernels do not render yet.
#pragma once

#include "core/scene_description.h"

namespace lockstep {

// Afterwards the scene holds diffuse, conductor and coated materials without textures, meshes and
// spheres without instances, and a constant environment. One warning for each kind of replacement.
void substitute_unsupported(SceneDescription& scene);

}  // namespace lockstep
