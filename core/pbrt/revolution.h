// Surfaces that arise when a line turns about the z axis, as triangles.
#pragma once

#include "core/mesh.h"

#include <vector>

namespace lockstep::pbrt {

// A point of the line: its distance from the axis, its height and the surface's normal there
// (outwards, up), not normalised; `v` is its texture coordinate.
struct ProfilePoint {
  float radius = 0.0f, z = 0.0f;
  float normal_out = 0.0f, normal_up = 0.0f;
  float v = 0.0f;
};

// Turns the line from the x axis towards y by `phi_max` (radians), in `segments` steps; u goes from
// 0 to 1 on the way. Triangles wind as the normals say.
TriangleMesh revolve(const std::vector<ProfilePoint>& profile, float phi_max, int segments);

}  // namespace lockstep::pbrt
