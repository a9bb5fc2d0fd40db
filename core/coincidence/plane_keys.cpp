#include "core/coincidence/plane_keys.h"

#include "core/coincidence/place_cells.h"
#include "core/coincidence/triangle_block.h"
#include "core/vector_clones.h"

namespace lockstep::coincidence {
namespace {

// Triangles with less area than this, relative to the square of their longest edge, have none.
constexpr double kLeastArea = 0x1p-40;
// Squares along each side of the mesh at most.
constexpr int kMostSquares = 16;
// Squares are so many times as wide as the mean triangle at least: few reach into several.
constexpr double kSquareWidth = 8.0;

Squares squares_over(const UnitMesh& mesh) {
  int squares = 1;
  while (squares < kMostSquares && kSquareWidth * mesh.mean_extent * squares <= 1.0) squares *= 2;
  return {squares};
}

LOCKSTEP_INLINE bool has_area(const Point& normal, double size) {
  const double least_area = kLeastArea * size * size;
  return squared_length(normal) > least_area * least_area;
}

// No need to look at an axis whose slopes are out of the reach of any error.
LOCKSTEP_INLINE bool may_dominate(double along, double most) {
  return along >= most * (1.0 - kCell);
}

template <class F>
void for_each(CellRange cells, const F& f) {
  for (int i = cells.first; i <= cells.last; ++i) f(i);
}

void append_keys(const PlaceCells& cells, int axis, Squares squares, std::size_t index,
                 std::vector<Entry>& entries) {
  for_each(cells.u, [&](int u) {
    for_each(cells.v, [&](int v) {
      for_each(cells.offset, [&](int offset) {
        for_each(cells.row, [&](int row) {
          for_each(cells.column, [&](int column) {
            const PlaceCell cell{u, v, offset, row, column};
            entries.push_back(make_entry(key_of(cell, axis, squares, squares.key_bits()), index));
          });
        });
      });
    });
  });
}

// A range for each triangle of a block.
struct BlockRanges {
  int first[kBlock], last[kBlock];

  void set(std::size_t i, CellRange cells) {
    first[i] = cells.first;
    last[i] = cells.last;
  }
  CellRange operator[](std::size_t i) const { return {first[i], last[i]}; }
};

// What a triangle adds to the entries.
enum Kind : int { kNothing, kOneKey, kTwoKeys, kMoreKeys, kSeveralAxes };

// Of each triangle of a block; cells and keys are those along the dominant axis.
struct BlockPlaces {
  int kind[kBlock];
  int axis[kBlock];
  std::uint32_t first_key[kBlock], last_key[kBlock];
  BlockRanges u, v, offset, row, column;

  void set(std::size_t i, const PlaceCells& cells) {
    u.set(i, cells.u);
    v.set(i, cells.v);
    offset.set(i, cells.offset);
    row.set(i, cells.row);
    column.set(i, cells.column);
  }
  PlaceCells cells(std::size_t i) const { return {u[i], v[i], offset[i], row[i], column[i]}; }
};

LOCKSTEP_INLINE Point select(bool first, const Point& a, const Point& b) {
  return {first ? a.u : b.u, first ? a.v : b.v, first ? a.w : b.w};
}

LOCKSTEP_VECTOR_CLONES
void find_places(const UnitMesh& shared, const TriangleBlock& block, Squares squares,
                 BlockPlaces& found) {
  const UnitMesh mesh = shared;  // which stores to `found` cannot change
  const int key_bits = squares.key_bits();
  for (std::size_t i = 0; i < kBlock; ++i) {
    // Something harmless stands for what is not finite or has no area.
    const bool finite = is_finite(block, i);
    const double noise = noise_at(mesh, finite ? largest_coordinate(block, i) : 0.0f);
    const auto corner = [&](std::size_t c) LOCKSTEP_LAMBDA {
      const auto& q = block.corners[c];
      return select(finite, unit_point(mesh, q[0][i], q[1][i], q[2][i]), Point{});
    };
    const Corners p = {corner(0), corner(1), corner(2)};
    const Point n = normal_of(p);
    const double size = longest_edge(p);
    const bool is_plane = has_area(n, size);

    const Point along = {std::abs(n.u), std::abs(n.v), std::abs(n.w)};
    const double most = greatest(along.u, along.v, along.w);
    const int axes =
        may_dominate(along.u, most) + may_dominate(along.v, most) + may_dominate(along.w, most);
    const bool is_u = along.u == most, is_v = along.v == most;
    const int axis = is_u ? 0 : is_v ? 1 : 2;
    const auto seen = [&](const Point& q) LOCKSTEP_LAMBDA {
      return select(is_u, turned(q, 0), select(is_v, turned(q, 1), q));
    };
    const Point seen_n = select(is_plane, seen(n), Point{0.0, 0.0, 1.0});
    const Facet f = facet_of({seen(p[0]), seen(p[1]), seen(p[2])}, seen_n, size, noise);

    const PlaceCells cells = place_cells(f, squares);
    const int kind = axes > 1 ? kSeveralAxes : std::min<int>(cells.count(), kMoreKeys);
    found.kind[i] = is_plane ? kind : kNothing;
    found.axis[i] = axis;
    found.first_key[i] = key_of(first_of(cells), axis, squares, key_bits);
    found.last_key[i] = key_of(last_of(cells), axis, squares, key_bits);
    found.set(i, cells);
  }
}

// Where errors may leave open which axis is the dominant one.
void append_several_axes(const UnitMesh& mesh, std::size_t index, Squares squares,
                         std::vector<Entry>& entries) {
  const Corners p = corners_along(mesh, index, 2);
  const Point n = normal_of(p);
  const double size = longest_edge(p), noise = coordinate_noise(mesh, index);
  const std::array<double, 3> along = {std::abs(n.u), std::abs(n.v), std::abs(n.w)};
  const double most = greatest(along[0], along[1], along[2]);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!may_dominate(along[axis], most)) continue;
    const Facet f = facet_of({turned(p[0], axis), turned(p[1], axis), turned(p[2], axis)},
                             turned(n, axis), size, noise);
    const double error = std::min(f.slope_error, 0.25 * kCell);
    if (along[axis] < most * (1.0 - 2.0 * error)) continue;
    append_keys(place_cells(f, squares), static_cast<int>(axis), squares, index, entries);
  }
}

}  // namespace

std::vector<Entry> plane_entries(const UnitMesh& mesh, std::size_t first, std::size_t last) {
  const Squares squares = squares_over(mesh);
  std::vector<Entry> entries;
  entries.reserve((last - first) * 2);
  TriangleBlock block;
  BlockPlaces found;
  for (std::size_t begin = first; begin < last; begin += kBlock) {
    const std::size_t count = std::min(last - begin, kBlock);
    load(mesh, begin, count, block);
    find_places(mesh, block, squares, found);
    for (std::size_t i = 0; i < count; ++i) {
      if (found.kind[i] == kOneKey) {
        entries.push_back(make_entry(found.first_key[i], begin + i));
      } else if (found.kind[i] == kTwoKeys) {
        entries.push_back(make_entry(found.first_key[i], begin + i));
        entries.push_back(make_entry(found.last_key[i], begin + i));
      } else if (found.kind[i] == kMoreKeys) {
        append_keys(found.cells(i), found.axis[i], squares, begin + i, entries);
      } else if (found.kind[i] == kSeveralAxes) {
        append_several_axes(mesh, begin + i, squares, entries);
      }
    }
  }
  return entries;
}

std::size_t axis_of_key(std::uint32_t key) { return key & 3; }

}  // namespace lockstep::coincidence
