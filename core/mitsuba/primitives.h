// Mitsuba's built-in shapes as meshes in object space, with its texture coordinates.
#pragma once

#include "core/mesh.h"

#include <glm/vec3.hpp>

namespace lockstep::mitsuba {

// [-1, 1]^2 at z = 0, facing +z; flat.
TriangleMesh rectangle_mesh();

// [-1, 1]^3, facing outwards, every side with all of [0, 1]^2 as texture coordinates; flat.
TriangleMesh cube_mesh();

// Unit sphere with smooth normals outwards; u is the angle around z, v that from +z.
TriangleMesh sphere_mesh();

// Unit disk at z = 0, facing +z; u is the distance from the centre, v the angle around it; flat.
TriangleMesh disk_mesh();

// Tube without caps between p0 and p1, which must differ, with smooth normals outwards; u is the
// angle around it, v goes from p0 to p1.
TriangleMesh cylinder_mesh(glm::vec3 p0, glm::vec3 p1, float radius);

}  // namespace lockstep::mitsuba
