// What the text of an OBJ file holds, before its corners become vertices.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <string>
#include <vector>

namespace lockstep {

// Indices, from 0, of position, texture coordinates and normal; -1 for none.
using ObjCorner = std::array<int, 3>;

// The faces of one material, cut into fans.
struct ObjGroup {
  std::string material;
  std::vector<ObjCorner> corners;  // three per triangle
};

// Normals have unit length, or 0 where the file's have no direction.
struct ObjText {
  std::vector<glm::vec3> positions;
  std::vector<glm::vec2> uvs;
  std::vector<glm::vec3> normals;
  std::vector<ObjGroup> groups;                  // the first has no material; some may be empty
  std::vector<std::string> libraries, warnings;  // as in ObjFile (core/obj.h)
};

// Throws Error ("file:line: ...") where the file is missing, malformed, refers to what it lacks, or
// has values that are not finite.
ObjText read_obj_text(const std::string& path);

}  // namespace lockstep
