// Mitsuba's shapes as geometry of the scene, with their materials and area lights.
#pragma once

#include "core/mitsuba/state.h"

namespace lockstep::mitsuba {

// Adds a <shape> of the scene: geometry, an instance of a "shapegroup", or the shapes that a
// "merge" holds. Groups are added when an instance first needs them. What is not supported or has
// no surface gives a warning.
//
// The side that emits, and that opaque models are seen from, is that of the shading normal where
// there is one, else of the winding; "flip_normals" turns it; a mirroring transform keeps it.
// Spheres and disks are exact where their transform and a plain material allow, else meshes.
void add_shape(State& state, const Element& element);

// Reads the mesh files of all shapes among `elements`, several at a time. Changes nothing but how
// long add_shape() takes for them.
void read_shapes_ahead(State& state, const std::vector<Element>& elements);

}  // namespace lockstep::mitsuba
