// Wavefront OBJ files: polygons with texture coordinates, normals and material names.
#pragma once

#include "core/mesh.h"
#include "core/scene_description.h"

#include <string>
#include <vector>

namespace lockstep {

// All faces of one material, whatever groups and objects they are in.
struct ObjPart {
  std::string material;  // of usemtl; empty before the first
  TriangleMesh mesh;
};

struct ObjFile {
  std::vector<ObjPart> parts;          // those with faces, in the order of their first usemtl
  std::vector<std::string> libraries;  // material files, as mtllib names them
  std::vector<std::string> warnings;   // "file:line: what was left out"
};

// Reads v, vt, vn and f. Polygons, taken to be convex, are cut into fans; indices may count from
// the end (negative); corners that agree in all their indices share a vertex. Texture coordinates
// are turned to have v downwards, as textures have it here. A mesh has normals if any of its
// corners has one (unit length; a corner without gets that of its face), and smoothing groups are
// ignored. Lines, points and names of groups are skipped; curved surfaces give a warning.
// Throws Error ("file:line: ...") where the file is missing, malformed, refers to what it lacks, or
// has values that are not finite.
ObjFile read_obj_parts(const std::string& path);

// As above, all materials in one mesh.
TriangleMesh read_obj(const std::string& path);

// An OBJ file alone as a scene: a shape per material with the colours and textures of its MTL
// files (core/mtl.h), under the default camera and light (core/default_view.h).
SceneDescription read_obj_scene(const std::string& path);

}  // namespace lockstep
