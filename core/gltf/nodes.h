// The node hierarchy, flattened.
#pragma once

#include "core/gltf/document.h"

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <string>
#include <vector>

namespace lockstep::gltf {

struct PlacedNode {
  int node = 0;  // index of Model::nodes
  glm::dmat4 to_world{1.0};
};

// The nodes of the default scene, or of the first, or without scenes of all trees; parents before
// children, children in the file's order. Nodes that a scale of 0 hides are left out with all
// below them (specification, section 3.5.3). Throws Error where a node is missing, in a circle, has
// two parents or is more than 1000 below the root, or where a matrix is not finite.
std::vector<PlacedNode> placed_nodes(Document& document);

// The node's own axis (0 to 2) in world space, of length 1.
glm::vec3 world_axis(const PlacedNode& node, int axis);

// "node 3 (name)", for messages.
std::string name_of_node(const Document& document, int node);

}  // namespace lockstep::gltf
