// An environment map as the kernels see it: plain arrays, owned by EnvironmentMap.
#pragma once

#include "core/texture_data.h"

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

namespace lockstep {

// The unit square (u to the right, v down) as the sphere of directions:
//   LatLong         y up; u = 1/2 is the direction -z and u = 3/4 is +x; v = 0 is +y
//   EqualAreaOctahedral  z up, which is the centre; +x lies right of it, +y below (Clarberg 2008,
//                   "Fast Equal-Area Mapping of the (Hemi)Sphere using SIMD", as pbrt-v4 has it)
enum class SphereMapping : std::int32_t { LatLong, EqualAreaOctahedral };

// Cumulative distributions of count + 1 values each, from 0 to 1 in whole steps of 2^-24, the
// resolution of samples: densities are exactly those of what is drawn. Guides say where to look:
// entry k is the last cell whose value is at most k / guide_count (Chen and Asau 1974).
struct CdfTable {
  std::int32_t count = 1, guide_count = 1;  // guide_count: a power of two
  const float* values = nullptr;
  const std::int32_t* guides = nullptr;  // guide_count + 1 entries each
};

// Directions are drawn in proportion to what a grid of columns x rows cells over the square sends,
// uniformly within each cell: uniform in solid angle.
struct EnvironmentMapData {
  SphereMapping mapping = SphereMapping::LatLong;
  TexelData texels;
  glm::vec3 scale{1.0f};     // of the texels, for radiance
  glm::mat3 to_world{1.0f};  // from the mapping's frame; orthonormal, may mirror
  std::int32_t columns = 1, rows = 1;
  CdfTable row_cdf;                    // over the rows
  CdfTable column_cdf;                 // over the columns of each row, one after the other
  const float* row_density = nullptr;  // probability of the row over the solid angle of its cells
  const float* latitudes = nullptr;    // LatLong: sin^2 and cos^2 of half the angle from +y, at the
                                       // upper edge of each row and below the last
};

}  // namespace lockstep
