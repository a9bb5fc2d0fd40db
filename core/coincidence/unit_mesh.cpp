#include "core/coincidence/unit_mesh.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <limits>

namespace lockstep::coincidence {
namespace {

bool has_finite_vertices(const UnitMesh& mesh, std::size_t triangle) {
  // A product with zero is zero, unless the value is infinite or no number.
  float sum = 0.0f;
  for (std::size_t corner = 0; corner < 3; ++corner) {
    const float* p = mesh.vertex(triangle, corner);
    sum += p[0] * 0.0f + p[1] * 0.0f + p[2] * 0.0f;
  }
  return sum == 0.0f;
}

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

Extent extent_of(const UnitMesh& mesh, std::size_t triangle) {
  Extent extent;
  for (std::size_t k = 0; k < 3; ++k) {
    const float a = mesh.vertex(triangle, 0)[k], b = mesh.vertex(triangle, 1)[k],
                c = mesh.vertex(triangle, 2)[k];
    extent.low[k] = std::min(std::min(a, b), c);
    extent.high[k] = std::max(std::max(a, b), c);
    extent.sum = std::max(extent.sum, double{extent.high[k]} - double{extent.low[k]});
  }
  extent.count = 1;
  return extent;
}

// The same however many threads take part.
Extent extent_of(const UnitMesh& mesh) {
  using Range = tbb::blocked_range<std::size_t>;
  return tbb::parallel_deterministic_reduce(
      Range(0, mesh.count, 1 << 14), Extent(),
      [&](const Range& range, Extent extent) {
        for (std::size_t i = range.begin(); i != range.end(); ++i) {
          if (has_finite_vertices(mesh, i)) grow(extent, extent_of(mesh, i));
        }
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
