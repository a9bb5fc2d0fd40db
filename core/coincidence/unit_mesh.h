// A mesh whose coordinates are mapped to [-1, 1], and its triangles seen along an axis.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace lockstep::coincidence {

// Error of a float coordinate, relative to the largest coordinate of its triangle: the rounding of
// the value itself (2^-24) and of the few operations of the transform that made it.
inline constexpr double kRelativeNoise = 0x1p-22;
// Coordinates near the origin may stem from larger ones that cancelled: noise is at least that of
// this fraction of the scene's largest coordinate.
inline constexpr double kSmallestCoordinate = 1.0 / 64.0;

// By value: vector code has no use for a reference to one of them.
template <class T>
T least(T a, T b, T c) {
  return std::min(std::min(a, b), c);
}
template <class T>
T greatest(T a, T b, T c) {
  return std::max(std::max(a, b), c);
}

// The caller's mesh, and the map of its coordinates to [-1, 1].
struct UnitMesh {
  const float* positions;
  const std::int32_t* triangles;
  std::size_t count;
  std::array<double, 3> centre{};
  double scale = 0.0;        // 0: no triangle has finite vertices and any extent
  double coordinate = 0.0;   // the largest, of all finite triangles
  double mean_extent = 0.0;  // of a finite triangle along its longest side, in unit coordinates

  const float* vertex(std::size_t triangle, std::size_t corner) const {
    return positions + 3 * static_cast<std::ptrdiff_t>(triangles[3 * triangle + corner]);
  }
};

// Of `count` triangles, three vertex indices into xyz `positions` each.
UnitMesh unit_mesh(const float* positions, const std::int32_t* triangles, std::size_t count);

// A vertex seen along an axis w, in the mesh's unit coordinates.
struct Point {
  double u, v, w;
};
using Corners = std::array<Point, 3>;

// What was seen along z, seen along another axis.
inline Point turned(const Point& p, std::size_t axis) {
  return axis == 0 ? Point{p.v, p.w, p.u} : axis == 1 ? Point{p.w, p.u, p.v} : p;
}

// The caller's coordinates, seen along z.
inline Point unit_point(const UnitMesh& mesh, float x, float y, float z) {
  return {(x - mesh.centre[0]) * mesh.scale, (y - mesh.centre[1]) * mesh.scale,
          (z - mesh.centre[2]) * mesh.scale};
}

inline Corners corners_along(const UnitMesh& mesh, std::size_t triangle, std::size_t axis) {
  Corners corners;
  for (std::size_t i = 0; i < 3; ++i) {
    const float* p = mesh.vertex(triangle, i);
    corners[i] = turned(unit_point(mesh, p[0], p[1], p[2]), axis);
  }
  return corners;
}

// Bound of the error of a triangle's coordinates, in the mesh's unit coordinates; `largest`: of the
// caller's.
inline double noise_at(const UnitMesh& mesh, float largest) {
  return kRelativeNoise * mesh.scale *
         std::max(double{largest}, kSmallestCoordinate * mesh.coordinate);
}
inline double coordinate_noise(const UnitMesh& mesh, std::size_t triangle) {
  float largest = 0.0f;
  for (std::size_t corner = 0; corner < 3; ++corner) {
    const float* p = mesh.vertex(triangle, corner);
    for (int k = 0; k < 3; ++k) largest = std::max(largest, std::abs(p[k]));
  }
  return noise_at(mesh, largest);
}

}  // namespace lockstep::coincidence
