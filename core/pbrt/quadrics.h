// Spheres, disks and cylinders.
#pragma once

#include "core/pbrt/shapes.h"

namespace lockstep::pbrt {

// Whole spheres only (others warn), as such where the transform keeps them round. A mesh where it
// does not, and where it turns a sphere that may be textured.
Geometry make_sphere(const ParameterSet& parameters, const ShapeContext& context,
                     Warnings& warnings);

// A Disk where it is whole, round and not textured, else a mesh.
Geometry make_disk(const ParameterSet& parameters, const ShapeContext& context);

Geometry make_cylinder(const ParameterSet& parameters, const ShapeContext& context);

}  // namespace lockstep::pbrt
