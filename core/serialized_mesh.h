// Mitsuba's compressed meshes (.serialized, file versions 3 and 4; Mitsuba 0.5 documentation,
// section 8.2.6): little-endian; per mesh a header of two 16-bit words, 0x041C and the version,
// then a zlib stream of flags, name (version 4), counts and arrays; at the end of the file the
// meshes' offsets (32 bits in version 3, 64 in version 4) and a 32-bit count.
#pragma once

#include "core/mesh.h"

#include <string>

namespace lockstep {

struct SerializedMesh {
  TriangleMesh mesh;          // texture coordinates as the file has them, normals of unit length
  bool face_normals = false;  // the file asks for flat shading, whatever normals it has
};

// Mesh `index`, from 0, of the file. Vertex colours are skipped. Throws Error with the file's name
// where the file is missing, of another version, cut short, or has indices out of range or values
// that are not finite.
SerializedMesh read_serialized_mesh(const std::string& path, int index);

}  // namespace lockstep
