// From a shape's own space to the world.
#pragma once

#include "core/pbrt/shapes.h"

namespace lockstep::pbrt {

// `mesh` in world space, its winding on the side that pbrt says (see make_shape), its normals of
// length 1. Throws where points leave the range of float.
TriangleMesh to_world(TriangleMesh mesh, const Placement& placement);
TriangleMesh to_world(TriangleMesh mesh, const ParameterSet& parameters,
                      const ShapeContext& context);

// Swaps the mesh's sides.
void turn_over(TriangleMesh& mesh);

}  // namespace lockstep::pbrt
