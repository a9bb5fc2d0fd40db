// Scene files of glTF 2.0: .gltf with its buffers and images beside it or inside, and .glb.
#pragma once

#include "core/scene_description.h"

#include <string>

namespace lockstep {

// Reads the default scene of the file, in its rest pose. Meshes that one node uses are placed in
// world space; those that several use become objects and instances, except for what emits. glTF has
// no environment: unless there are punctual lights or surfaces that emit evenly, one of radiance 1
// is added, as is a camera where the file has none. Throws Error ("file: element: what is wrong").
SceneDescription read_gltf(const std::string& path);

}  // namespace lockstep
