// Reflectance functions as tables of measured reflectance.
#pragma once

#include "core/measured_table.h"

#include <functional>

namespace lockstep {

// In 1/sr, of directions above the surface.
using Reflectance = std::function<glm::vec3(glm::vec3 wo, glm::vec3 wi)>;

// Values at the cells' middles; unknown below the horizon.
inline MeasuredCells cells_of(const Reflectance& f) {
  MeasuredCells cells;
  for (int h = 0; h < measured_halves; ++h) {
    for (int d = 0; d < measured_differences; ++d) {
      for (int p = 0; p < measured_azimuths; ++p) {
        const DirectionPair pair = directions_of_cell(h, d, p);
        if (!(pair.wo.z > 0.0f && pair.wi.z > 0.0f)) continue;
        cells.rgb[MeasuredCells::index(h, d, p)] = f(pair.wo, pair.wi);
      }
    }
  }
  return cells;
}

}  // namespace lockstep
