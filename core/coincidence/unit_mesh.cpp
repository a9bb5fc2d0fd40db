#include "core/coincidence/unit_mesh.h"

#include "core/coincidence/triangle_block.h"
#include "core/simd.h"
#include "core/vector_clones.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <limits>

namespace lockstep::coincidence {
namespace {

// Of finite triangles, in the caller's coordinates.
struct Extent {
  std::array<float, 3> low, high;
  double sum = 0.0;  // of the longest sides of their boxes
  std::size_t count = 0;

  Extent() {
    low.fill(std::numeric_limits<float>::infinity());
    high.fill(-std::numeric_limits<float>::infinity());
  }
};

void grow(Extent& extent, const Extent& other) {
  for (std::size_t k = 0; k < 3; ++k) {
    extent.low[k] = std::min(extent.low[k], other.low[k]);
    extent.high[k] = std::max(extent.high[k], other.high[k]);
  }
  extent.sum += other.sum;
  extent.count += other.count;
}

// Bounds of the triangles at each place of several blocks, and the longest sides of the last one's
// boxes; triangles that are not finite are left out.
struct BlockExtents {
  float low[3][kBlock], high[3][kBlock];
  double side[kBlock];
  int finite[kBlock];

  BlockExtents() {
    std::fill_n(&low[0][0], 3 * kBlock, std::numeric_limits<float>::infinity());
    std::fill_n(&high[0][0], 3 * kBlock, -std::numeric_limits<float>::infinity());
  }
};

LOCKSTEP_VECTOR_CLONES
void add(const TriangleBlock& __restrict block, BlockExtents& __restrict extents) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  const auto &a = block.corners[0], &b = block.corners[1], &c = block.corners[2];
  for (std::size_t i = 0; i < kBlock; ++i) {
    const bool finite = is_finite(block, i);
    const auto add_along = [&](std::size_t k) LOCKSTEP_LAMBDA {
      const float low = least(a[k][i], b[k][i], c[k][i]);
      const float high = greatest(a[k][i], b[k][i], c[k][i]);
      const float low_so_far = extents.low[k][i], high_so_far = extents.high[k][i];
      extents.low[k][i] = std::min(low_so_far, finite ? low : infinity);
      extents.high[k][i] = std::max(high_so_far, finite ? high : -infinity);
      return double{high} - double{low};
    };
    const double x = add_along(0), y = add_along(1), z = add_along(2);
    extents.side[i] = finite ? greatest(x, y, z) : 0.0;
    extents.finite[i] = finite;
  }
}

void add(const UnitMesh& mesh, std::size_t first, std::size_t last, Extent& extent) {
  TriangleBlock block;
  BlockExtents extents;
  for (; first < last; first += kBlock) {
    const std::size_t count = std::min(last - first, kBlock);
    load(mesh, first, count, block);
    add(block, extents);
    for (std::size_t i = 0; i < count; ++i) {
      extent.sum += extents.side[i];
      extent.count += static_cast<std::size_t>(extents.finite[i]);
    }
  }
  for (std::size_t k = 0; k < 3; ++k) {
    extent.low[k] =
        std::min(extent.low[k], *std::min_element(extents.low[k], extents.low[k] + kBlock));
    extent.high[k] =
        std::max(extent.high[k], *std::max_element(extents.high[k], extents.high[k] + kBlock));
  }
}

// The same however many threads take part.
Extent extent_of(const UnitMesh& mesh) {
  using Range = tbb::blocked_range<std::size_t>;
  return tbb::parallel_deterministic_reduce(
      Range(0, mesh.count, 1 << 14), Extent(),
      [&](const Range& range, Extent extent) {
        add(mesh, range.begin(), range.end(), extent);
        return extent;
      },
      [](Extent a, const Extent& b) {
        grow(a, b);
        return a;
      });
}

}  // namespace

UnitMesh unit_mesh(const float* positions, const std::int32_t* triangles, std::size_t count) {
  UnitMesh mesh{positions, triangles, count};
  const auto [low, high, sum, finite] = extent_of(mesh);
  double half = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    mesh.centre[k] = 0.5 * (double{low[k]} + double{high[k]});
    half = std::max(half, 0.5 * (double{high[k]} - double{low[k]}));
    mesh.coordinate = std::max({mesh.coordinate, std::abs(double{low[k]}), double{high[k]}});
  }
  if (!(half > 0.0)) return mesh;
  mesh.scale = 1.0 / half;
  mesh.mean_extent = sum / static_cast<double>(finite) * mesh.scale;
  return mesh;
}

}  // namespace lockstep::coincidence
