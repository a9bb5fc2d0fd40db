// Punctual lights (Khronos extension KHR_lights_punctual).
#pragma once

#include "core/gltf/nodes.h"
#include "core/scene_description.h"

#include <vector>

namespace lockstep::gltf {

// Appends the lights of the nodes. Candela and lux become W/sr and W/m^2 as they stand, without
// the 683 lm/W between them: exporters and path tracers do so, and a viewer's exposure would take
// the constant out again. Throws Error where a light is missing or its cone is not one.
void add_lights(Document& document, const std::vector<PlacedNode>& nodes, SceneDescription& scene);

}  // namespace lockstep::gltf
