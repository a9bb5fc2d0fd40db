// Coincident triangles in three steps: a key per plane, a sort that brings triangles of equal keys
// together, and a search for overlaps in each such group, in the plane.
#include "core/coincidence.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

namespace lockstep {
namespace {

// Error of a float coordinate, relative to the largest coordinate of its triangle: the rounding of
// the value itself (2^-24) and of the few operations of the transform that made it.
constexpr double kRelativeNoise = 0x1p-22;
// Coordinates near the origin may stem from larger ones that cancelled: noise is at least that of
// this fraction of the scene's largest coordinate.
constexpr double kSmallestCoordinate = 1.0 / 64.0;
// Triangles with less area than this, relative to the square of their longest edge, have none.
constexpr double kLeastArea = 0x1p-40;
// Planes are told apart in steps of this: slopes, and offsets in half extents of the scene.
constexpr double kCell = 0x1p-8;
// Cells of a slope (at most 1 and half a cell) and of an offset (at most 3 and a little).
constexpr int kSlopeCells = 520;
constexpr int kOffsetCells = 1560;
// Threads take so many triangles or entries at a time.
constexpr std::size_t kShare = 1 << 15;
// Groups up to this size are searched pair by pair.
constexpr std::size_t kSmallGroup = 24;

// Something to sort: the key in the upper 32 bits, an index in the lower ones.
using Entry = std::uint64_t;

constexpr Entry make_entry(std::uint32_t key, std::size_t index) {
  return Entry{key} << 32 | static_cast<std::uint32_t>(index);
}
constexpr std::uint32_t key_of(Entry e) { return static_cast<std::uint32_t>(e >> 32); }
constexpr std::uint32_t index_of(Entry e) { return static_cast<std::uint32_t>(e); }

// Sorts by key and then index; expects entries of equal keys in the order of their indices. Long
// lists take a stable radix sort with 11 bits a pass: a few times faster.
void sort_entries(std::vector<Entry>& entries, std::vector<Entry>& scratch) {
  if (entries.size() < 4096) {
    std::sort(entries.begin(), entries.end());
    return;
  }
  scratch.resize(entries.size());
  for (int shift = 32; shift < 64; shift += 11) {
    std::array<std::size_t, 2048> next{};
    for (const Entry e : entries) ++next[e >> shift & 2047];
    std::size_t sum = 0;
    for (std::size_t& n : next) sum += std::exchange(n, sum);
    for (const Entry e : entries) scratch[next[e >> shift & 2047]++] = e;
    entries.swap(scratch);
  }
}

// The caller's mesh, and the map of its coordinates to [-1, 1].
struct Mesh {
  const float* positions;
  const std::int32_t* triangles;
  std::size_t count;
  std::array<double, 3> centre{};
  double scale = 0.0;       // 0: no triangle has finite vertices and any extent
  double coordinate = 0.0;  // the largest, of all finite triangles

  const float* vertex(std::size_t triangle, std::size_t corner) const {
    return positions + 3 * static_cast<std::ptrdiff_t>(triangles[3 * triangle + corner]);
  }
};

bool has_finite_vertices(const Mesh& mesh, std::size_t triangle) {
  // A product with zero is zero, unless the value is infinite or no number.
  float sum = 0.0f;
  for (std::size_t corner = 0; corner < 3; ++corner) {
    const float* p = mesh.vertex(triangle, corner);
    sum += p[0] * 0.0f + p[1] * 0.0f + p[2] * 0.0f;
  }
  return sum == 0.0f;
}

Mesh with_bounds(Mesh mesh) {
  std::array<float, 3> low, high;
  low.fill(std::numeric_limits<float>::infinity());
  high.fill(-std::numeric_limits<float>::infinity());
  for (std::size_t i = 0; i < mesh.count; ++i) {
    if (!has_finite_vertices(mesh, i)) continue;
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const float* p = mesh.vertex(i, corner);
      for (std::size_t k = 0; k < 3; ++k) {
        low[k] = std::min(low[k], p[k]);
        high[k] = std::max(high[k], p[k]);
      }
    }
  }
  double half = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    mesh.centre[k] = 0.5 * (double{low[k]} + double{high[k]});
    half = std::max(half, 0.5 * (double{high[k]} - double{low[k]}));
    mesh.coordinate = std::max({mesh.coordinate, std::abs(double{low[k]}), double{high[k]}});
  }
  mesh.scale = half > 0.0 ? 1.0 / half : 0.0;
  return mesh;
}

double least(double a, double b, double c) { return std::min(std::min(a, b), c); }
double greatest(double a, double b, double c) { return std::max(std::max(a, b), c); }

// A vertex seen along an axis w, in the mesh's unit coordinates.
struct Point {
  double u, v, w;
};
using Corners = std::array<Point, 3>;

// What was seen along z, seen along another axis.
Point turned(const Point& p, std::size_t axis) {
  return axis == 0 ? Point{p.v, p.w, p.u} : axis == 1 ? Point{p.w, p.u, p.v} : p;
}

Corners corners_along(const Mesh& mesh, std::size_t triangle, std::size_t axis) {
  Corners corners;
  for (std::size_t i = 0; i < 3; ++i) {
    const float* p = mesh.vertex(triangle, i);
    corners[i] = turned({(p[0] - mesh.centre[0]) * mesh.scale, (p[1] - mesh.centre[1]) * mesh.scale,
                         (p[2] - mesh.centre[2]) * mesh.scale},
                        axis);
  }
  return corners;
}

Point difference(const Point& a, const Point& b) { return {a.u - b.u, a.v - b.v, a.w - b.w}; }
double squared_length(const Point& p) { return p.u * p.u + p.v * p.v + p.w * p.w; }

// Twice the area, as a vector.
Point normal_of(const Corners& p) {
  const Point a = difference(p[1], p[0]), b = difference(p[2], p[0]);
  return {a.v * b.w - a.w * b.v, a.w * b.u - a.u * b.w, a.u * b.v - a.v * b.u};
}

double longest_edge(const Corners& p) {
  return std::sqrt(greatest(squared_length(difference(p[1], p[0])),
                            squared_length(difference(p[2], p[1])),
                            squared_length(difference(p[0], p[2]))));
}

// Bound of the error of a triangle's coordinates, in the mesh's unit coordinates.
double coordinate_noise(const Mesh& mesh, std::size_t triangle) {
  float largest = 0.0f;
  for (std::size_t corner = 0; corner < 3; ++corner) {
    const float* p = mesh.vertex(triangle, corner);
    for (int k = 0; k < 3; ++k) largest = std::max(largest, std::abs(p[k]));
  }
  return kRelativeNoise * mesh.scale *
         std::max(double{largest}, kSmallestCoordinate * mesh.coordinate);
}

// A triangle seen along an axis, as a part of the plane w = offset + slope_u * u + slope_v * v.
// Unlike a normal this has no sign: both orientations of a triangle give the same plane.
struct Facet {
  Corners p;
  double slope_u, slope_v, offset;
  double size;         // longest edge
  double height;       // error of a vertex's distance to the plane, along w
  double slope_error;  // bounds of what these errors do to the plane
  double offset_error;
};

// From corners with an error of `noise` a coordinate, their normal_of and their longest edge.
Facet facet_of(const Corners& p, const Point& n, double size, double noise) {
  Facet f;
  const double inverse = 1.0 / n.w;
  f.p = p;
  f.slope_u = -n.u * inverse;
  f.slope_v = -n.v * inverse;
  f.offset = p[0].w - f.slope_u * p[0].u - f.slope_v * p[0].v;
  f.size = size;
  f.height = noise * (1.0 + std::abs(f.slope_u) + std::abs(f.slope_v));
  // Vertices at the two ends of the least altitude, |n.w| / size, err in opposite directions.
  f.slope_error = 2.0 * f.height * size * std::abs(inverse);
  f.offset_error = f.height + f.slope_error * (std::abs(p[0].u) + std::abs(p[0].v));
  return f;
}

// The cells that a value may belong to: one, or two if its error reaches the boundary. Two
// values whose difference their errors explain have a cell in common.
struct CellRange {
  int first, last;
};

CellRange cells_of(double value, double error) {
  const double centre = value / kCell + 0.5;
  const double reach = std::min(error / kCell, 0.5);
  return {static_cast<int>(std::floor(centre - reach)),
          static_cast<int>(std::floor(centre + reach))};
}

void append_keys(const Facet& f, std::size_t axis, std::size_t index, std::vector<Entry>& entries) {
  const CellRange us = cells_of(f.slope_u, f.slope_error);
  const CellRange vs = cells_of(f.slope_v, f.slope_error);
  const CellRange offsets = cells_of(f.offset, f.offset_error);
  for (int u = us.first; u <= us.last; ++u) {
    for (int v = vs.first; v <= vs.last; ++v) {
      for (int o = offsets.first; o <= offsets.last; ++o) {
        const int slopes =
            (static_cast<int>(axis) * kSlopeCells + u + kSlopeCells / 2) * kSlopeCells + v +
            kSlopeCells / 2;
        entries.push_back(make_entry(
            static_cast<std::uint32_t>(slopes * kOffsetCells + o + kOffsetCells / 2), index));
      }
    }
  }
}
static_assert(3LL * kSlopeCells * kSlopeCells * kOffsetCells < 1LL << 31);

// Of the triangles [first, last).
std::vector<Entry> plane_entries(const Mesh& mesh, std::size_t first, std::size_t last) {
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
      if (along[axis] >= most * (1.0 - 2.0 * error)) append_keys(f, axis, i, entries);
    }
  }
  return entries;
}

// One entry per triangle with an area and per plane cell that it may lie in, in the order of the
// triangles. The plane is seen along its dominant axis; where errors leave open which one that is,
// along each of them.
std::vector<Entry> plane_entries(const Mesh& mesh) {
  std::vector<std::vector<Entry>> shares((mesh.count + kShare - 1) / kShare);
  tbb::parallel_for(std::size_t{0}, shares.size(), [&](std::size_t i) {
    shares[i] = plane_entries(mesh, i * kShare, std::min((i + 1) * kShare, mesh.count));
  });
  std::size_t size = 0;
  for (const std::vector<Entry>& share : shares) size += share.size();
  std::vector<Entry> entries;
  entries.reserve(size);
  for (std::vector<Entry>& share : shares) {
    entries.insert(entries.end(), share.begin(), share.end());
    share = {};
  }
  return entries;
}

// Whether the vertices of `b` lie in the plane of `a`, within the errors of both.
bool holds_vertices(const Facet& a, const Facet& b) {
  const double tolerance = a.height + b.height + 2.0 * a.slope_error * (a.size + b.size);
  return std::all_of(b.p.begin(), b.p.end(), [&](const Point& q) {
    return std::abs(a.offset + a.slope_u * q.u + a.slope_v * q.v - q.w) <= tolerance;
  });
}

bool in_one_plane(const Corners& a, double a_noise, const Corners& b, double b_noise) {
  const Facet f = facet_of(a, normal_of(a), longest_edge(a), a_noise);
  const Facet g = facet_of(b, normal_of(b), longest_edge(b), b_noise);
  return holds_vertices(f, g) && holds_vertices(g, f);
}

// Whether the line through some edge of `a` has the triangles on its two sides, but for an overlap
// that noise explains or that is small for the thinner of them.
bool an_edge_separates(const Corners& a, const Corners& b, double noise) {
  for (std::size_t edge = 0; edge < 3; ++edge) {
    const Point& base = a[edge];
    const Point d = difference(a[(edge + 1) % 3], base);
    const auto side = [&](const Point& q) { return d.u * (q.v - base.v) - d.v * (q.u - base.u); };
    const double third = side(a[(edge + 2) % 3]);
    const double a_low = std::min(0.0, third), a_high = std::max(0.0, third);
    const double b0 = side(b[0]), b1 = side(b[1]), b2 = side(b[2]);
    const double b_low = least(b0, b1, b2), b_high = greatest(b0, b1, b2);
    const double common = std::min(a_high, b_high) - std::max(a_low, b_low);
    const double thinner = std::min(a_high - a_low, b_high - b_low);
    if (common <= std::min(noise * (std::abs(d.u) + std::abs(d.v)), thinner / 16.0)) return true;
  }
  return false;
}

// A triangle of a group: its extent in two dimensions, and the error of its coordinates.
struct Box {
  double u_low, u_high, v_low, v_high;
  double noise;
  std::uint32_t triangle;
};

bool overlap(const Box& a, const Box& b) {
  return a.u_low < b.u_high && b.u_low < a.u_high && a.v_low < b.v_high && b.v_low < a.v_high;
}

Box box_along(const Mesh& mesh, std::uint32_t triangle, std::size_t axis) {
  const Corners p = corners_along(mesh, triangle, axis);
  return {least(p[0].u, p[1].u, p[2].u),    greatest(p[0].u, p[1].u, p[2].u),
          least(p[0].v, p[1].v, p[2].v),    greatest(p[0].v, p[1].v, p[2].v),
          coordinate_noise(mesh, triangle), triangle};
}

// Horizontal strips over a group's boxes, about as high as the average box: few boxes of a strip
// overlap in u without being neighbours, and a box is in three strips on average at most.
struct Strips {
  double u_low, v_low;
  double u_cells, v_cells;  // per unit
  int last;

  std::uint32_t u_cell(double u) const {
    return static_cast<std::uint32_t>(std::clamp((u - u_low) * u_cells, 0.0, 65535.0));
  }
  int strip(double v) const { return std::clamp(static_cast<int>((v - v_low) * v_cells), 0, last); }
};

Strips strips_over(std::span<const Box> boxes) {
  Box bounds = boxes[0];
  double heights = 0.0;
  for (const Box& b : boxes) {
    bounds.u_low = std::min(bounds.u_low, b.u_low);
    bounds.u_high = std::max(bounds.u_high, b.u_high);
    bounds.v_low = std::min(bounds.v_low, b.v_low);
    bounds.v_high = std::max(bounds.v_high, b.v_high);
    heights += b.v_high - b.v_low;
  }
  // Triangles with an area, seen along their dominant axis: no extent and no height is zero.
  const double extent = bounds.v_high - bounds.v_low;
  const double count =
      std::clamp(std::floor(extent * static_cast<double>(boxes.size()) / heights), 1.0, 65535.0);
  return {bounds.u_low, bounds.v_low, 65535.0 / (bounds.u_high - bounds.u_low), count / extent,
          static_cast<int>(count) - 1};
}

// Finds the overlaps in groups of triangles whose planes may be the same. Several searches may
// share their flags: those that are set do not depend on the order.
class OverlapSearch {
 public:
  OverlapSearch(const Mesh& mesh, std::vector<std::uint8_t>& flags) : mesh_(mesh), flags_(flags) {}

  void search(std::span<const Entry> group, std::size_t axis) {
    axis_ = axis;
    boxes_.clear();
    for (const Entry e : group) boxes_.push_back(box_along(mesh_, index_of(e), axis));
    if (boxes_.size() <= kSmallGroup) {
      for (std::size_t i = 0; i < boxes_.size(); ++i) {
        for (std::size_t j = i + 1; j < boxes_.size(); ++j) {
          if (overlap(boxes_[i], boxes_[j])) test(boxes_[i], boxes_[j]);
        }
      }
    } else {
      sweep(strips_over(boxes_));
    }
  }

 private:
  void test(const Box& a, const Box& b) {
    const std::atomic_ref a_flag(flags_[a.triangle]), b_flag(flags_[b.triangle]);
    if (a_flag.load(std::memory_order_relaxed) && b_flag.load(std::memory_order_relaxed)) return;
    const Corners p = corners_along(mesh_, a.triangle, axis_);
    const Corners q = corners_along(mesh_, b.triangle, axis_);
    const double noise = a.noise + b.noise;
    // Neighbours are by far the most frequent pairs, and mostly an edge of theirs separates them.
    if (an_edge_separates(p, q, noise) || an_edge_separates(q, p, noise) ||
        !in_one_plane(p, a.noise, q, b.noise)) {
      return;
    }
    a_flag.store(1, std::memory_order_relaxed);
    b_flag.store(1, std::memory_order_relaxed);
  }

  // Sorts the boxes by strip and then by their low end, and compares each with those that begin
  // before it ends.
  void sweep(const Strips& strips) {
    order_.clear();
    for (std::size_t i = 0; i < boxes_.size(); ++i) {
      const int last = strips.strip(boxes_[i].v_high);
      for (int s = strips.strip(boxes_[i].v_low); s <= last; ++s) {
        order_.push_back(make_entry(sweep_key(s, strips.u_cell(boxes_[i].u_low)), i));
      }
    }
    sort_entries(order_, scratch_);
    for (std::size_t i = 0; i < order_.size(); ++i) {
      const Box& a = boxes_[index_of(order_[i])];
      const int strip = static_cast<int>(key_of(order_[i]) >> 16);
      const std::uint32_t end = sweep_key(strip, strips.u_cell(a.u_high));
      for (std::size_t j = i + 1; j < order_.size() && key_of(order_[j]) <= end; ++j) {
        const Box& b = boxes_[index_of(order_[j])];
        // Of all strips that two boxes share, only the first one counts.
        if (overlap(a, b) && strips.strip(std::max(a.v_low, b.v_low)) == strip) test(a, b);
      }
    }
  }

  static std::uint32_t sweep_key(int strip, std::uint32_t u_cell) {
    return static_cast<std::uint32_t>(strip) << 16 | u_cell;
  }

  const Mesh& mesh_;
  std::vector<std::uint8_t>& flags_;
  std::size_t axis_ = 0;
  std::vector<Box> boxes_;
  std::vector<Entry> order_, scratch_;
};

// Searches the groups of sorted `entries` that begin in [first, last).
void search_groups(std::span<const Entry> entries, std::size_t first, std::size_t last,
                   OverlapSearch& search) {
  while (first > 0 && first < last && key_of(entries[first]) == key_of(entries[first - 1])) ++first;
  while (first < last) {
    const std::uint32_t key = key_of(entries[first]);
    std::size_t end = first + 1;
    while (end < entries.size() && key_of(entries[end]) == key) ++end;
    const std::size_t axis = key / (kSlopeCells * kSlopeCells * kOffsetCells);
    if (end - first > 1) search.search(entries.subspan(first, end - first), axis);
    first = end;
  }
}

}  // namespace

std::vector<std::uint8_t> find_coincident_triangles(const float* positions,
                                                    const std::int32_t* triangles,
                                                    std::size_t count) {
  const Mesh mesh = with_bounds({positions, triangles, count});
  if (mesh.scale == 0.0) return {};
  std::vector<Entry> entries = plane_entries(mesh);
  std::vector<Entry> scratch;
  sort_entries(entries, scratch);

  std::vector<std::uint8_t> flags(count);
  tbb::parallel_for(std::size_t{0}, (entries.size() + kShare - 1) / kShare, [&](std::size_t i) {
    OverlapSearch search(mesh, flags);
    search_groups(entries, i * kShare, std::min((i + 1) * kShare, entries.size()), search);
  });
  if (std::find(flags.begin(), flags.end(), 1) == flags.end()) flags.clear();
  return flags;
}

}  // namespace lockstep
