#include "core/coincidence/overlap_search.h"

#include "core/coincidence/facet.h"
#include "core/vector_clones.h"

#include <atomic>
#include <bit>

namespace lockstep::coincidence {

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

namespace {

// So many boxes at a time are compared with so many others at most.
constexpr std::size_t kRow = 16, kColumn = 32;

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

bool overlap(const Box& a, const Box& b) {
  return a.u_low < b.u_high && b.u_low < a.u_high && a.v_low < b.v_high && b.v_low < a.v_high;
}

Box box_along(const UnitMesh& mesh, std::uint32_t triangle, std::size_t axis) {
  const Corners p = corners_along(mesh, triangle, axis);
  return {least(p[0].u, p[1].u, p[2].u), greatest(p[0].u, p[1].u, p[2].u),
          least(p[0].v, p[1].v, p[2].v), greatest(p[0].v, p[1].v, p[2].v), triangle};
}

// Adds a triangle's extent along two axes.
void set_box(const UnitMesh& mesh, std::uint32_t triangle, std::size_t axis, std::size_t place,
             SmallBoxes& boxes) {
  const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
  const float *a = mesh.vertex(triangle, 0), *b = mesh.vertex(triangle, 1),
              *c = mesh.vertex(triangle, 2);
  boxes.u_low[place] = least(a[u], b[u], c[u]);
  boxes.u_high[place] = greatest(a[u], b[u], c[u]);
  boxes.v_low[place] = least(a[v], b[v], c[v]);
  boxes.v_high[place] = greatest(a[v], b[v], c[v]);
}

// Which of [begin, end), at most kColumn, each of the boxes [first, first + kRow) overlaps: bits
// from the lowest.
LOCKSTEP_VECTOR_CLONES
void find_overlaps(const SmallBoxes& boxes, std::size_t first, std::size_t begin, std::size_t end,
                   std::uint32_t* __restrict found) {
  const float *u_low = boxes.u_low + first, *u_high = boxes.u_high + first,
              *v_low = boxes.v_low + first, *v_high = boxes.v_high + first;
  for (std::size_t i = 0; i < kRow; ++i) found[i] = 0;
  for (std::size_t j = begin; j < end; ++j) {
    const float low_u = boxes.u_low[j], high_u = boxes.u_high[j], low_v = boxes.v_low[j],
                high_v = boxes.v_high[j];
    const std::uint32_t bit = 1u << (j - begin);
    for (std::size_t i = 0; i < kRow; ++i) {
      const bool overlaps =
          (u_low[i] < high_u) & (low_u < u_high[i]) & (v_low[i] < high_v) & (low_v < v_high[i]);
      found[i] |= overlaps ? bit : 0u;
    }
  }
}

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

std::uint32_t sweep_key(int strip, std::uint32_t u_cell) {
  return static_cast<std::uint32_t>(strip) << 16 | u_cell;
}

}  // namespace

void OverlapSearch::search(std::span<const Entry> group, std::size_t axis) {
  axis_ = axis;
  if (group.size() <= SmallBoxes::most) {
    search_pairs(group);
    return;
  }
  boxes_.clear();
  for (const Entry e : group) boxes_.push_back(box_along(mesh_, index_of(e), axis));
  sweep(strips_over(boxes_));
}

void OverlapSearch::search_pairs(std::span<const Entry> group) {
  for (std::size_t i = 0; i < group.size(); ++i) {
    set_box(mesh_, index_of(group[i]), axis_, i, small_);
  }
  std::uint32_t found[kRow];
  for (std::size_t first = 0; first < group.size(); first += kRow) {
    const std::size_t end = std::min(first + kRow, group.size());
    for (std::size_t begin = 0; begin < end; begin += kColumn) {
      find_overlaps(small_, first, begin, std::min(begin + kColumn, end), found);
      for (std::size_t i = std::max(first, begin); i < end; ++i) {
        // Each pair once.
        const auto earlier = (std::uint64_t{1} << std::min(i - begin, kColumn)) - 1;
        for (std::uint64_t bits = found[i - first] & earlier; bits != 0; bits &= bits - 1) {
          const auto place = begin + static_cast<std::size_t>(std::countr_zero(bits));
          test(index_of(group[i]), index_of(group[place]));
        }
      }
    }
  }
}

// Sorts the boxes by strip and then by their low end, and compares each with those that begin
// before it ends.
void OverlapSearch::sweep(const Strips& strips) {
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
      if (overlap(a, b) && strips.strip(std::max(a.v_low, b.v_low)) == strip) {
        test(a.triangle, b.triangle);
      }
    }
  }
}

void OverlapSearch::test(std::uint32_t a, std::uint32_t b) {
  const std::atomic_ref a_flag(flags_[a]), b_flag(flags_[b]);
  if (a_flag.load(std::memory_order_relaxed) && b_flag.load(std::memory_order_relaxed)) return;
  const Corners p = corners_along(mesh_, a, axis_), q = corners_along(mesh_, b, axis_);
  const double p_noise = coordinate_noise(mesh_, a), q_noise = coordinate_noise(mesh_, b);
  const double noise = p_noise + q_noise;
  // Neighbours are by far the most frequent pairs, and mostly an edge of theirs separates them.
  if (an_edge_separates(p, q, noise) || an_edge_separates(q, p, noise) ||
      !in_one_plane(p, p_noise, q, q_noise)) {
    return;
  }
  a_flag.store(1, std::memory_order_relaxed);
  b_flag.store(1, std::memory_order_relaxed);
}

}  // namespace lockstep::coincidence
