// Triangles as parts of planes, with bounds of what the rounding of their coordinates does to them.
#pragma once

#include "core/coincidence/unit_mesh.h"

namespace lockstep::coincidence {

inline Point difference(const Point& a, const Point& b) {
  return {a.u - b.u, a.v - b.v, a.w - b.w};
}
inline double squared_length(const Point& p) { return p.u * p.u + p.v * p.v + p.w * p.w; }

// Twice the area, as a vector.
inline Point normal_of(const Corners& p) {
  const Point a = difference(p[1], p[0]), b = difference(p[2], p[0]);
  return {a.v * b.w - a.w * b.v, a.w * b.u - a.u * b.w, a.u * b.v - a.v * b.u};
}

inline double longest_edge(const Corners& p) {
  return std::sqrt(greatest(squared_length(difference(p[1], p[0])),
                            squared_length(difference(p[2], p[1])),
                            squared_length(difference(p[0], p[2]))));
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
inline Facet facet_of(const Corners& p, const Point& n, double size, double noise) {
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

}  // namespace lockstep::coincidence
