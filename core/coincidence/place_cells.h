// Cells that planes and places in them are told apart by, and the keys of these cells. Everything
// here goes into a loop that becomes vector code: no branches, no calls.
#pragma once

#include "core/coincidence/facet.h"
#include "core/simd.h"

#include <bit>

namespace lockstep::coincidence {

// Planes are told apart in steps of this: slopes, and offsets in half extents of the scene.
inline constexpr double kCell = 0x1p-6;

// std::floor() is a call where the instruction set lacks it.
LOCKSTEP_INLINE int rounded_down(double x) {
  const int i = static_cast<int>(x);
  return i - (x < i);
}

struct CellRange {
  int first, last;

  int count() const { return last - first + 1; }
};

// The cells that a value may belong to: one, or two if its error reaches the boundary. Two
// values whose difference their errors explain have a cell in common.
LOCKSTEP_INLINE CellRange cells_of(double value, double error) {
  const double centre = value / kCell + 0.5;
  const double reach = std::min(error / kCell, 0.5);
  return {rounded_down(centre - reach), rounded_down(centre + reach)};
}

// Places in a plane are told apart by squares, so many along each side of the mesh; a power of two.
struct Squares {
  int along = 1;

  int key_bits() const { return 2 * std::countr_zero(static_cast<unsigned>(along)); }
};

// The squares that coordinates in [-1, 1] fall into.
LOCKSTEP_INLINE CellRange squares_of(double a, double b, double c, Squares squares) {
  const double scale = 0.5 * squares.along;
  return {std::min(static_cast<int>((least(a, b, c) + 1.0) * scale), squares.along - 1),
          std::min(static_cast<int>((greatest(a, b, c) + 1.0) * scale), squares.along - 1)};
}

// Where a triangle may lie, seen along an axis.
struct PlaceCells {
  CellRange u, v, offset;  // cells of its plane
  CellRange row, column;   // squares that it reaches into

  int count() const {
    return u.count() * v.count() * offset.count() * row.count() * column.count();
  }
};

LOCKSTEP_INLINE PlaceCells place_cells(const Facet& f, Squares squares) {
  return {cells_of(f.slope_u, f.slope_error), cells_of(f.slope_v, f.slope_error),
          cells_of(f.offset, f.offset_error), squares_of(f.p[0].v, f.p[1].v, f.p[2].v, squares),
          squares_of(f.p[0].u, f.p[1].u, f.p[2].u, squares)};
}

// One of them; slopes are at most 1, offsets 3 and a little.
struct PlaceCell {
  int u, v, offset, row, column;
};

LOCKSTEP_INLINE PlaceCell first_of(const PlaceCells& c) {
  return {c.u.first, c.v.first, c.offset.first, c.row.first, c.column.first};
}
LOCKSTEP_INLINE PlaceCell last_of(const PlaceCells& c) {
  return {c.u.last, c.v.last, c.offset.last, c.row.last, c.column.last};
}

// From the top: the square, so that entries of one place, and so their triangles, are close to one
// another in memory; the upper bits of a product that every bit of the cell reaches (Knuth's
// multiplicative hash); two bits for the axis.
LOCKSTEP_INLINE std::uint32_t key_of(const PlaceCell& c, int axis, Squares squares, int key_bits) {
  constexpr int slopes = static_cast<int>(2.0 / kCell) + 8;
  constexpr int offsets = static_cast<int>(6.0 / kCell) + 24;
  const int cell =
      ((c.u + slopes / 2) * slopes + c.v + slopes / 2) * offsets + c.offset + offsets / 2;
  static_assert(std::int64_t{slopes} * slopes * offsets < std::int64_t{1} << 31);
  const std::uint32_t hash = static_cast<std::uint32_t>(cell) * 0x9e3779b1u;
  const auto square = static_cast<std::uint32_t>(c.row * squares.along + c.column);
  // Without squares, `square` is zero and nothing is shifted by all its bits.
  const std::uint32_t top = square << ((32 - key_bits) & 31);
  return top | hash >> key_bits >> 2 << 2 | static_cast<std::uint32_t>(axis);
}

}  // namespace lockstep::coincidence
