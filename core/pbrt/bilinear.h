// Bilinear patches (pbrt-v4 "bilinearmesh") as triangles.
#pragma once

#include "core/mesh.h"

#include <vector>

namespace lockstep::pbrt {

// `patches` lists four vertices of `vertices` per patch, p00 p10 p01 p11. The normal's side is that
// of cross(dp/du, dp/dv). A planar patch becomes two triangles, a curved one a grid; where there is
// a curved patch and no normals are given, the surface's own become shading normals. Without uvs
// each patch has its own from 0 to 1.
TriangleMesh triangulate_patches(const TriangleMesh& vertices, const std::vector<int>& patches);

}  // namespace lockstep::pbrt
