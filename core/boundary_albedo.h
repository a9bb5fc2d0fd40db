// What a rough boundary between two media reflects and passes in a single bounce between its GGX
// facets, E(cos, alpha, eta): the rest of 1 is lost, up to two thirds of what arrives from the
// denser side, and is put back by scaling f by 1 / E(cos of wo), as Turquin 2019 does for metals.
//
// So no light is lost or gained, whatever wo. The scaled model is not reciprocal, as E of wi plays
// no part; a form symmetric in wo and wi would not bring each direction's sum to 1 exactly.
#pragma once

#include "core/ggx_albedo.h"

namespace lockstep {

// A table is for one index of refraction inside / outside. Its parts, each ggx_albedo_cells^2 rows
// as core/ggx_albedo.h has them: E seen from outside, E seen from inside, and of E from outside the
// share that is reflected. Then ggx_albedo_cells rows along the square root of alpha, whose first
// two floats are a cell's ends: by how much the compensated boundary reflects more diffuse light
// back inside than a smooth one does.
inline constexpr int boundary_albedo_rows = (3 * ggx_albedo_cells + 1) * ggx_albedo_cells;

// The number of the table for this index, appended to `etas` if it is new. Beyond [1/16, 16] that
// end's serves, and once there are most_boundary_tables the nearest one.
inline constexpr std::size_t most_boundary_tables = 64;
std::size_t boundary_table_for(float eta, std::vector<float>& etas);

// The tables of these indices, 4 * boundary_albedo_rows floats each; the same on every machine but
// for rounding.
std::vector<float> make_boundary_albedo(const std::vector<float>& etas);

inline namespace LOCKSTEP_ISA_NAMESPACE {

enum class BoundaryPart { Outside, Inside, Reflected, Diffuse };

template <class I>
LOCKSTEP_INLINE I boundary_part(I table, BoundaryPart part) {
  constexpr int rows = ggx_albedo_cells * ggx_albedo_cells;
  return table * I(boundary_albedo_rows) + I(int(part) * rows);
}

// (1 - E) / E for wo under cos_o in [0, 1]: light lost / light that leaves. `table`: number of the
// lanes' tables; `inside`: wo is on the side that eta calls inside.
template <class V>
LOCKSTEP_INLINE V boundary_loss(const float* tables, IntOf<V> table, MaskOf<V> inside, V cos_o,
                                V alpha) {
  using I = IntOf<V>;
  const I first = select(inside, boundary_part(table, BoundaryPart::Inside),
                         boundary_part(table, BoundaryPart::Outside));
  const V e = look_up_albedo(tables, first, cos_o, alpha);
  return (V(1.0f) - e) / e;
}

// Share of light that the compensated boundary reflects, seen from outside; it passes the rest.
template <class V>
LOCKSTEP_INLINE V boundary_reflectance(const float* tables, IntOf<V> table, V cos_o, V alpha) {
  return look_up_albedo(tables, boundary_part(table, BoundaryPart::Reflected), cos_o, alpha);
}

// To be added to inner_reflectance() of a smooth boundary.
template <class V>
LOCKSTEP_INLINE V boundary_inner_difference(const float* tables, IntOf<V> table, V alpha) {
  using I = IntOf<V>;
  const V y = sqrt(clamp(alpha, V(0.0f), V(1.0f))) * V(float(ggx_albedo_cells));
  const V cell = albedo_cell(y);
  const I row = boundary_part(table, BoundaryPart::Diffuse) + to_int(cell);
  const auto ends = gather_rows(tables, row * I(4));
  return fma(y - cell, ends.y - ends.x, ends.x);
}

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
