// Surfaces with holes: while Embree looks for a ray's hits it asks, for geometry whose opacity is
// below 1 somewhere, whether there is anything where the ray hits. Shading never learns of holes.
// Images are looked up whole, without a footprint: a filtered edge of a leaf is no edge any more.
#pragma once

#include "core/embree.h"
#include "core/flatten.h"

namespace lockstep {

// What the filter knows of one geometry.
struct Holes {
  const FlatScene* flat = nullptr;
  const TextureTable* textures = nullptr;
  std::uint32_t geometry = 0;  // index of its row
};

// Makes hits on `geometry` subject to its opacity. `holes` must outlive it.
void set_holes(RTCGeometry geometry, Holes& holes);

}  // namespace lockstep
