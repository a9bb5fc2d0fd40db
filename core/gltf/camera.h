// Cameras of glTF (specification, section 3.10).
#pragma once

#include "core/gltf/nodes.h"
#include "core/scene_description.h"

#include <vector>

namespace lockstep::gltf {

// Sets the scene's camera and film from the first node that has a camera, and warns where there are
// more; false where there is none. The film is 768 pixels along its longer side, square where the
// file leaves the shape to the viewport. Throws Error for values outside of their range.
bool set_camera(Document& document, const std::vector<PlacedNode>& nodes, SceneDescription& scene);

}  // namespace lockstep::gltf
