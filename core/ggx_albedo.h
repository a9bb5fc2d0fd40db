// What GGX microfacets reflect in a single bounce if each reflects everything, E(cos, alpha): the
// rest of 1 is lost, 59 % of diffuse light at alpha 1, and can be put back (Turquin 2019,
// "Practical multiple scattering compensation for microfacet models").
#pragma once

#include "core/simd_rows.h"
#include "core/vec.h"

#include <vector>

namespace lockstep {

// Cells of the table along the square roots of the cosine and of alpha, both in [0, 1]. Each row of
// four floats holds a cell's corners, so that one access serves a lookup.
inline constexpr int ggx_albedo_cells = 32;

// The table, ggx_albedo_cells^2 rows; the same on every machine but for rounding.
std::vector<float> make_ggx_albedo();

inline namespace LOCKSTEP_ISA_NAMESPACE {

// The cell that holds a coordinate in [0, ggx_albedo_cells].
template <class V>
LOCKSTEP_INLINE V albedo_cell(V x) {
  return clamp(floor(x), V(0.0f), V(ggx_albedo_cells - 1.0f));
}

// Interpolated in the table that begins at row `first`.
template <class V>
LOCKSTEP_INLINE V look_up_albedo(const float* table, IntOf<V> first, V cos_o, V alpha) {
  using I = IntOf<V>;
  constexpr float cells = ggx_albedo_cells;
  const V x = sqrt(clamp(cos_o, V(0.0f), V(1.0f))) * V(cells);
  const V y = sqrt(clamp(alpha, V(0.0f), V(1.0f))) * V(cells);
  const V column = albedo_cell(x), row = albedo_cell(y);
  const I at = first + to_int(row) * I(ggx_albedo_cells) + to_int(column);
  const auto corners = gather_rows(table, at * I(4));
  const V s = x - column, t = y - row;
  const V low = fma(s, corners.y - corners.x, corners.x);
  const V high = fma(s, corners.w - corners.z, corners.z);
  return fma(t, high - low, low);
}

// E for wo under cos_o in [0, 1], interpolated; error below 0.01 for cos_o above 0.01, else 0.03.
template <class V>
LOCKSTEP_INLINE V ggx_albedo(const float* table, V cos_o, V alpha) {
  return look_up_albedo(table, IntOf<V>(0), cos_o, alpha);
}

// Light lost / light reflected, (1 - E) / E, of a white metal seen under cos_o: the factor of
// Turquin's compensation. Roughness that differs along x and y counts by its geometric mean.
template <class V>
LOCKSTEP_INLINE V ggx_loss(const float* table, V cos_o, Vec2<V> alpha) {
  const V e = ggx_albedo(table, cos_o, sqrt(alpha.x * alpha.y));
  return (V(1.0f) - e) / e;
}

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
