// Keys of what triangles may have in common: a plane and a place in it.
#pragma once

#include "core/coincidence/entries.h"
#include "core/coincidence/unit_mesh.h"

namespace lockstep::coincidence {

// For the triangles [first, last), in their order: one entry per triangle with an area, per cell of
// planes that it may lie in and per square of the plane that it reaches into. The plane is seen
// along its dominant axis; where errors leave open which one that is, along each of them.
// Triangles that overlap in one plane have a key in common. Keys are hashes: what differs may share
// a key by chance, but only where seen along one axis.
std::vector<Entry> plane_entries(const UnitMesh& mesh, std::size_t first, std::size_t last);

// The axis that the planes of a key are seen along.
std::size_t axis_of_key(std::uint32_t key);

}  // namespace lockstep::coincidence
