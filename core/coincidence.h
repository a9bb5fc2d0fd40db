// Triangles that lie on one another in one plane. A ray meets both at the same distance, bit for
// bit, and which of them is reported depends on the order in which a traversal visits them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace lockstep {

// For each of `count` triangles (three vertex indices into xyz `positions`) 1 if it overlaps
// another one in its plane by more than an edge or a corner, else 0; empty where no triangle does.
// "In its plane" allows for a few roundings of the float coordinates, so that tilted planes count
// too. Triangles without area or with non-finite vertices overlap nothing.
//
// Limit: in tilted planes, triangles thinner than about 2^-14 of the scene (its extent, or its
// distance from the origin if that is more) may be missed: their vertices do not fix their plane
// well enough. The time grows with the pairs whose bounding rectangles in a plane overlap.
std::vector<std::uint8_t> find_coincident_triangles(const float* positions,
                                                    const std::int32_t* triangles,
                                                    std::size_t count);

}  // namespace lockstep
