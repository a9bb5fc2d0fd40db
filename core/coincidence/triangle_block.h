// Some successive triangles of a mesh as arrays, so that loops over them become vector code.
#pragma once

#include "core/coincidence/unit_mesh.h"

namespace lockstep::coincidence {

inline constexpr std::size_t kBlock = 16;  // triangles

// Value k of corner c of triangle i is corners[c][k][i], in the caller's coordinates.
struct TriangleBlock {
  float corners[3][3][kBlock];
};

// Triangles [first, first + count), at least one and at most a block of them; the rest repeats the
// last one.
inline void load(const UnitMesh& mesh, std::size_t first, std::size_t count, TriangleBlock& block) {
  for (std::size_t i = 0; i < kBlock; ++i) {
    const std::size_t triangle = first + std::min(i, count - 1);
    for (std::size_t c = 0; c < 3; ++c) {
      const float* p = mesh.vertex(triangle, c);
      for (std::size_t k = 0; k < 3; ++k) block.corners[c][k][i] = p[k];
    }
  }
}

// Whether all coordinates of triangle i are.
inline bool is_finite(const TriangleBlock& block, std::size_t i) {
  // A product with zero is zero, unless the value is infinite or no number.
  const auto& [a, b, c] = block.corners;
  const float sum = a[0][i] * 0.0f + a[1][i] * 0.0f + a[2][i] * 0.0f + b[0][i] * 0.0f +
                    b[1][i] * 0.0f + b[2][i] * 0.0f + c[0][i] * 0.0f + c[1][i] * 0.0f +
                    c[2][i] * 0.0f;
  return sum == 0.0f;
}

// Without their signs.
inline float largest_coordinate(const TriangleBlock& block, std::size_t i) {
  const auto of_corner = [i](const float(&q)[3][kBlock]) {
    return greatest(std::abs(q[0][i]), std::abs(q[1][i]), std::abs(q[2][i]));
  };
  const auto& [a, b, c] = block.corners;
  return greatest(of_corner(a), of_corner(b), of_corner(c));
}

}  // namespace lockstep::coincidence
