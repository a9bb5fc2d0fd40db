// pbrt's curves as triangles.
#pragma once

#include "core/mesh.h"
#include "core/pbrt/shapes.h"

namespace lockstep::pbrt {

// Shape "curve" of v3 and v4 in object space: tubes for "cylinder" and "flat", which pbrt turns
// towards every ray, and strips for "ribbon". Tubes are open at their ends; their sides stand far
// enough out that the mean width over all views is the curve's. u runs along each segment, v around
// a tube or across a strip.
//
// Steps along a segment keep within a tenth of the width and 15 degrees of the curve, 64 at most;
// a tube has 6 to 32 sides, the more the thicker it is for its length. Throws where more than
// ShapeContext::triangles_left triangles would be needed.
TriangleMesh curve(const ParameterSet& parameters, const ShapeContext& context);

}  // namespace lockstep::pbrt
