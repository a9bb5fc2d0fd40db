#include "core/coincidence/plane_keys.h"

#include "core/coincidence/facet.h"

#include <bit>

namespace lockstep::coincidence {
namespace {

// Triangles with less area than this, relative to the square of their longest edge, have none.
constexpr double kLeastArea = 0x1p-40;
// Planes are told apart in steps of this: slopes, and offsets in half extents of the scene.
constexpr double kCell = 0x1p-6;
// Places in a plane are told apart by this many squares along each side of the mesh at most.
constexpr int kMostSquares = 16;
// Squares are so many times as wide as the mean triangle at least: few reach into several.
constexpr double kSquareWidth = 8.0;

// std::floor() is a call where the instruction set lacks it.
int rounded_down(double x) {
  const int i = static_cast<int>(x);
  return i - (x < i);
}

struct CellRange {
  int first, last;
};

// The cells that a value may belong to: one, or two if its error reaches the boundary. Two
// values whose difference their errors explain have a cell in common.
CellRange cells_of(double value, double error) {
  const double centre = value / kCell + 0.5;
  const double reach = std::min(error / kCell, 0.5);
  return {rounded_down(centre - reach), rounded_down(centre + reach)};
}

// A power of two.
int squares_along(const UnitMesh& mesh) {
  int squares = 1;
  while (squares < kMostSquares && kSquareWidth * mesh.mean_extent * squares <= 1.0) squares *= 2;
  return squares;
}

// The squares that coordinates in [-1, 1] fall into.
CellRange squares_of(double a, double b, double c, int squares) {
  const auto square_of = [&](double x) {
    return std::min(static_cast<int>((x + 1.0) * (0.5 * squares)), squares - 1);
  };
  return {square_of(least(a, b, c)), square_of(greatest(a, b, c))};
}

// Cells of a plane, each at most 1 (slopes) or 3 (offsets) and a little.
struct PlaneCell {
  int u, v, offset;
};

// From the top: the square, so that entries of one place, and so their triangles, are close to one
// another in memory; the upper bits of a product that every bit of the cell reaches (Knuth's
// multiplicative hash); two bits for the axis.
std::uint32_t key_from(std::size_t axis, const PlaneCell& c, unsigned square, int square_bits) {
  constexpr int slopes = static_cast<int>(2.0 / kCell) + 8;
  constexpr int offsets = static_cast<int>(6.0 / kCell) + 24;
  const int cell =
      ((c.u + slopes / 2) * slopes + c.v + slopes / 2) * offsets + c.offset + offsets / 2;
  static_assert(std::int64_t{slopes} * slopes * offsets < std::int64_t{1} << 31);
  const std::uint32_t hash = static_cast<std::uint32_t>(cell) * 0x9e3779b1u;
  const std::uint32_t top = square_bits > 0 ? square << (32 - square_bits) : 0;
  return top | hash >> square_bits >> 2 << 2 | static_cast<std::uint32_t>(axis);
}

template <class F>
void for_each(CellRange cells, const F& f) {
  for (int i = cells.first; i <= cells.last; ++i) f(i);
}

void append_keys(const Facet& f, std::size_t axis, int squares, std::size_t index,
                 std::vector<Entry>& entries) {
  const CellRange offsets = cells_of(f.offset, f.offset_error);
  const CellRange us = cells_of(f.slope_u, f.slope_error);
  const CellRange vs = cells_of(f.slope_v, f.slope_error);
  const CellRange columns = squares_of(f.p[0].u, f.p[1].u, f.p[2].u, squares);
  const CellRange rows = squares_of(f.p[0].v, f.p[1].v, f.p[2].v, squares);
  const int square_bits = 2 * std::countr_zero(static_cast<unsigned>(squares));
  for_each(us, [&](int u) {
    for_each(vs, [&](int v) {
      for_each(offsets, [&](int offset) {
        for_each(rows, [&](int row) {
          for_each(columns, [&](int column) {
            const auto square = static_cast<unsigned>(row * squares + column);
            const std::uint32_t key = key_from(axis, {u, v, offset}, square, square_bits);
            entries.push_back(make_entry(key, index));
          });
        });
      });
    });
  });
}

}  // namespace

std::vector<Entry> plane_entries(const UnitMesh& mesh, std::size_t first, std::size_t last) {
  const int squares = squares_along(mesh);
  std::vector<Entry> entries;
  entries.reserve((last - first) * 2);
  for (std::size_t i = first; i < last; ++i) {
    const Corners p = corners_along(mesh, i, 2);
    const Point n = normal_of(p);
    const double size = longest_edge(p), least_area = kLeastArea * size * size;
    // False also for what is no number.
    if (!(squared_length(n) > least_area * least_area)) continue;
    const std::array<double, 3> along = {std::abs(n.u), std::abs(n.v), std::abs(n.w)};
    const double most = greatest(along[0], along[1], along[2]);
    if (!std::isfinite(most)) continue;
    const double noise = coordinate_noise(mesh, i);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      // No need to look at an axis whose slopes are out of the reach of any error.
      if (along[axis] < most * (1.0 - kCell)) continue;
      const Facet f = facet_of({turned(p[0], axis), turned(p[1], axis), turned(p[2], axis)},
                               turned(n, axis), size, noise);
      const double error = std::min(f.slope_error, 0.25 * kCell);
      if (along[axis] >= most * (1.0 - 2.0 * error)) append_keys(f, axis, squares, i, entries);
    }
  }
  return entries;
}

std::size_t axis_of_key(std::uint32_t key) { return key & 3; }

}  // namespace lockstep::coincidence
