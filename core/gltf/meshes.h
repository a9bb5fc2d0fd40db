// Triangle meshes from glTF's primitives (specification, section 3.7).
#pragma once

#include "core/gltf/document.h"
#include "core/mesh.h"

#include <optional>
#include <string>

namespace lockstep::gltf {

// The primitive's triangles in its mesh's space, with the set of texture coordinates that its
// material asks for; nothing, and a warning, where it has none. Lists, strips and fans; vertices
// that no triangle uses are left out where many primitives share an array. Throws Error where the
// data is out of range, naming the primitive by `name` ("mesh 0 primitive 1").
std::optional<TriangleMesh> read_primitive(Document& document, const tinygltf::Primitive& primitive,
                                           int uv_set, const std::string& name);

}  // namespace lockstep::gltf
