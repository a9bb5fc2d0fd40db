// PLY meshes (Turk 1994): ASCII, binary little- and big-endian, any scalar types.
#pragma once

#include "core/mesh.h"

#include <string>

namespace lockstep {

// Reads positions (x y z), normals (nx ny nz), uvs (u v, s t, texture_u texture_v) and faces, which
// are cut into fans of triangles. Elements and properties of other names are skipped. Normals are
// as the file has them, not normalised. Throws Error with the file's name, and the line of a text
// file, where the file is missing, cut short, or refers to a vertex it does not have.
TriangleMesh read_ply(const std::string& path);

// Whether the header says that the file has no faces; false also where it cannot be read.
bool announces_no_face(const std::string& path);

}  // namespace lockstep
