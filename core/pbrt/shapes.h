// Shapes of pbrt as world-space geometry.
#pragma once

#include "core/pbrt/parameters.h"
#include "core/scene_description.h"

#include <glm/mat4x4.hpp>

#include <functional>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace lockstep::pbrt {

struct ShapeContext {
  glm::dmat4 object_to_world{1.0};
  bool reverse_orientation = false;
  bool may_be_textured = false;  // (u, v) matter
  double triangles_left = 0.0;   // that subdivision and curves may make
  // Turns a file name in the scene into a path that can be opened.
  std::function<std::string(const std::string&)> resolve;
};

// Where the shape that `owner` names stands, in the file and in the world.
struct Placement {
  Location where;
  std::string owner;
  glm::mat4 to_world{1.0f};
  bool reverse_orientation = false;
};

Placement placement_of(const ParameterSet& parameters, const ShapeContext& context);

// A mesh in a file of its own, which is read when the whole scene has been.
struct MeshFile {
  std::string path;
  Placement placement;
};

// The meshes of `files`, in their order and in world space. Reads several at a time. Throws what is
// wrong with the first bad one.
std::vector<TriangleMesh> read_mesh_files(const std::vector<MeshFile>& files);

// The shape `type`; nothing, with a warning, where it is not supported or has no surface.
//
// The side that emits follows pbrt: cross(p1 - p0, p2 - p0) in object space, turned by
// ReverseOrientation; a mirroring transform keeps the side. Shading normals, themselves turned by
// ReverseOrientation, overrule it. We turn the winding, which is what tells the side here. A sphere
// emits outwards unless reversed. (Under a mirroring transform pbrt's own sphere light samples
// one side and its emission test the other; we keep to the side that it samples.)
std::optional<std::variant<Geometry, MeshFile>> make_shape(const std::string& type,
                                                           const ParameterSet& parameters,
                                                           const ShapeContext& context,
                                                           Warnings& warnings);

}  // namespace lockstep::pbrt
