#include "core/pbrt/curves.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace lockstep::pbrt {

namespace {

constexpr double pi = 3.14159265358979323846;

// A cubic Bezier curve; widths, and normals of ribbons, at both ends.
struct Segment {
  std::array<glm::dvec3, 4> p;
  double width[2];
  glm::dvec3 normal[2];
};

enum class CurveType { Tube, Ribbon };

CurveType get_type(const ParameterSet& set) {
  const std::string type = set.get_string("type", "flat");
  if (type == "flat" || type == "cylinder") return CurveType::Tube;
  if (type == "ribbon") return CurveType::Ribbon;
  fail(set.where(),
       set.owner() + " is of the type \"" + type + "\"; expected flat, cylinder or ribbon");
}

// Cubic control points of a quadratic curve.
std::array<glm::dvec3, 4> raised(glm::dvec3 a, glm::dvec3 b, glm::dvec3 c) {
  return {a, (a + 2.0 * b) / 3.0, (2.0 * b + c) / 3.0, c};
}

// The Bezier points of one segment, `p` its first control point.
std::array<glm::dvec3, 4> bezier_points(const glm::vec3* p, int degree, bool spline) {
  const glm::dvec3 a(p[0]), b(p[1]), c(p[2]);
  if (degree == 2) return spline ? raised(0.5 * (a + b), b, 0.5 * (b + c)) : raised(a, b, c);
  const glm::dvec3 d(p[3]);
  if (!spline) return {a, b, c, d};
  return {(a + 4.0 * b + c) / 6.0, (2.0 * b + c) / 3.0, (b + 2.0 * c) / 3.0,
          (b + 4.0 * c + d) / 6.0};
}

int get_degree(const ParameterSet& set) {
  const int degree = set.get_int("degree", 3);
  if (degree == 2 || degree == 3) return degree;
  fail(set.where(),
       set.owner() + " has the degree " + std::to_string(degree) + "; expected 2 or 3");
}

bool is_spline(const ParameterSet& set) {
  const std::string basis = set.get_string("basis", "bezier");
  if (basis == "bezier" || basis == "bspline") return basis == "bspline";
  fail(set.where(), set.owner() + " has the basis \"" + basis + "\"; expected bezier or bspline");
}

size_t segment_count(const ParameterSet& set, size_t points, int degree, bool spline) {
  const auto d = static_cast<size_t>(degree);
  if (points > d && spline) return points - d;
  if (points > d && (points - 1) % d == 0) return (points - 1) / d;
  const std::string expected = spline ? std::to_string(d + 1) + " or more"
                                      : "a multiple of " + std::to_string(d) + " and one more";
  fail(set.where(), set.owner() + " has " + std::to_string(points) + " points; its basis and " +
                        "degree need " + expected);
}

std::vector<glm::vec3> ribbon_normals(const ParameterSet& set, CurveType type, size_t segments) {
  if (type != CurveType::Ribbon) return {};
  std::vector<glm::vec3> normals = set.get_normals("N");
  if (normals.size() == segments + 1) return normals;
  fail(set.where(), set.owner() + " has " + std::to_string(normals.size()) +
                        " values of \"N\"; a ribbon needs one for each end of its " +
                        std::to_string(segments) + " segments");
}

std::vector<Segment> get_segments(const ParameterSet& set, CurveType type) {
  const int degree = get_degree(set);
  const bool spline = is_spline(set);
  const std::vector<glm::vec3> points = set.get_points("P");
  const size_t count = segment_count(set, points.size(), degree, spline);
  const std::vector<glm::vec3> normals = ribbon_normals(set, type, count);
  const float width = set.get_float("width", 1.0f);
  const float ends[2] = {set.get_float("width0", width), set.get_float("width1", width)};
  if (!(ends[0] >= 0.0f && ends[1] >= 0.0f)) {
    fail(set.where(), set.owner() + " has a negative width");
  }
  const auto width_at = [&](size_t i) {
    return glm::mix(double(ends[0]), double(ends[1]), double(i) / double(count));
  };
  std::vector<Segment> segments;
  for (size_t i = 0; i < count; ++i) {
    const size_t first = spline ? i : i * static_cast<size_t>(degree);
    Segment s{bezier_points(&points[first], degree, spline), {width_at(i), width_at(i + 1)}, {}};
    for (size_t end = 0; end < normals.size() && end < 2; ++end) {
      s.normal[end] = glm::dvec3(normals[i + end]);
    }
    segments.push_back(s);
  }
  return segments;
}

double polygon_length(const Segment& s) {
  return glm::distance(s.p[0], s.p[1]) + glm::distance(s.p[1], s.p[2]) +
         glm::distance(s.p[2], s.p[3]);
}

// Between two directions, in radians; 0 where one has no length.
double angle_between(glm::dvec3 a, glm::dvec3 b) {
  const double sine = glm::length(glm::cross(a, b)), cosine = glm::dot(a, b);
  return sine == 0.0 && cosine == 0.0 ? 0.0 : std::atan2(sine, cosine);
}

// n steps leave a cubic by at most |p''| / (8 n^2), and |p''| is 6 times the largest second
// difference of its points.
int step_count(const Segment& s) {
  const double bend = std::max(glm::length(s.p[0] - 2.0 * s.p[1] + s.p[2]),
                               glm::length(s.p[1] - 2.0 * s.p[2] + s.p[3]));
  const double tolerance = 0.1 * std::max(s.width[0], s.width[1]);
  const double turn = angle_between(s.p[1] - s.p[0], s.p[2] - s.p[1]) +
                      angle_between(s.p[2] - s.p[1], s.p[3] - s.p[2]) +
                      angle_between(s.normal[0], s.normal[1]);
  const double by_bend = tolerance > 0.0 ? std::sqrt(6.0 * bend / (8.0 * tolerance)) : 0.0;
  const double steps = std::max(by_bend, turn / (pi / 12.0));
  return static_cast<int>(std::clamp(std::ceil(steps), 1.0, 64.0));
}

int side_count(const std::vector<Segment>& segments) {
  double length = 0.0, width = 0.0;
  for (const Segment& s : segments) {
    length += polygon_length(s);
    width = std::max({width, s.width[0], s.width[1]});
  }
  return length > 0.0 ? static_cast<int>(std::clamp(96.0 * width / length, 6.0, 32.0)) : 6;
}

// A point of the curve, and the direction in which it goes on.
struct CurvePoint {
  glm::dvec3 position, tangent;
  double radius, widening;  // of the radius, per unit of length
  glm::dvec3 normal;        // of ribbons
  double u;
};

glm::dvec3 position_at(const Segment& s, double u) {
  const double v = 1.0 - u;
  return v * v * v * s.p[0] + 3.0 * v * v * u * s.p[1] + 3.0 * v * u * u * s.p[2] +
         u * u * u * s.p[3];
}

// Control points that coincide have no derivative there; points nearby tell the direction.
glm::dvec3 tangent_at(const Segment& s, double u) {
  for (const double step : {1e-6, 1e-3, 0.1, 1.0}) {
    const glm::dvec3 d =
        position_at(s, std::min(u + step, 1.0)) - position_at(s, std::max(u - step, 0.0));
    const double length = glm::length(d);
    if (length > 1e-9 * polygon_length(s)) return d / length;
  }
  return {0.0, 0.0, 1.0};
}

CurvePoint point_at(const Segment& s, double u) {
  const double length = polygon_length(s);
  const double widening = length > 0.0 ? 0.5 * (s.width[1] - s.width[0]) / length : 0.0;
  return {position_at(s, u),
          tangent_at(s, u),
          0.5 * glm::mix(s.width[0], s.width[1], u),
          widening,
          glm::mix(s.normal[0], s.normal[1], u),
          u};
}

glm::dvec3 any_across(glm::dvec3 t) {
  const glm::dvec3 axis = std::abs(t.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  return glm::normalize(glm::cross(t, axis));
}

// `across`, at right angles to the tangent of `from`, carried on to `to` without a twist (Wang et
// al. 2008, "Computation of Rotation Minimizing Frames", double reflection).
glm::dvec3 carried(glm::dvec3 across, const CurvePoint& from, const CurvePoint& to) {
  const auto mirrored = [](glm::dvec3 v, glm::dvec3 normal) {
    const double square = glm::dot(normal, normal);
    return square > 0.0 ? v - 2.0 * glm::dot(v, normal) / square * normal : v;
  };
  const glm::dvec3 chord = to.position - from.position;
  const glm::dvec3 tangent = mirrored(from.tangent, chord);
  glm::dvec3 moved = mirrored(mirrored(across, chord), to.tangent - tangent);
  moved -= glm::dot(moved, to.tangent) * to.tangent;
  const double length = glm::length(moved);
  return length > 1e-3 ? moved / length : any_across(to.tangent);
}

void add_vertex(TriangleMesh& mesh, glm::dvec3 position, glm::dvec3 normal, double u, double v) {
  mesh.positions.emplace_back(position);
  mesh.normals.emplace_back(glm::normalize(normal));
  mesh.uvs.emplace_back(float(u), float(v));
}

void add_ring(TriangleMesh& mesh, const CurvePoint& p, glm::dvec3 across, int sides) {
  // A polygon of this radius has the circle's circumference, and so its mean width (Cauchy).
  const double radius = p.radius * (pi / sides) / std::sin(pi / sides);
  const glm::dvec3 other = glm::cross(p.tangent, across);
  for (int i = 0; i <= sides; ++i) {
    const double v = double(i) / sides;
    const glm::dvec3 out = std::cos(2.0 * pi * v) * across + std::sin(2.0 * pi * v) * other;
    add_vertex(mesh, p.position + radius * out, out - p.widening * p.tangent, p.u, v);
  }
}

void add_pair(TriangleMesh& mesh, const CurvePoint& p) {
  glm::dvec3 side = glm::cross(p.normal, p.tangent);
  const double length = glm::length(side);
  side = length > 0.0 ? side / length : any_across(p.tangent);
  const glm::dvec3 normal = glm::cross(p.tangent, side);
  add_vertex(mesh, p.position + p.radius * side, normal, p.u, 0.0);
  add_vertex(mesh, p.position - p.radius * side, normal, p.u, 1.0);
}

// Between the last two rows of `count` vertices each; their normals' side is the front.
void join_rows(TriangleMesh& mesh, unsigned count) {
  const auto first = static_cast<unsigned>(mesh.positions.size()) - 2 * count;
  const auto add = [&](unsigned a, unsigned b, unsigned c) {
    const std::vector<glm::vec3>& p = mesh.positions;
    if (p[a] != p[b] && p[b] != p[c] && p[c] != p[a]) mesh.triangles.emplace_back(a, b, c);
  };
  for (unsigned i = first; i + 1 < first + count; ++i) {
    add(i, i + 1, i + count);
    add(i + 1, i + count + 1, i + count);
  }
}

void check_total(const ParameterSet& set, const std::vector<Segment>& segments, int sides,
                 double left) {
  double triangles = 0.0;
  for (const Segment& s : segments) triangles += 2.0 * sides * step_count(s);
  if (triangles <= left) return;
  fail(set.where(), set.owner() + " cannot have " + std::to_string(static_cast<long>(triangles)) +
                        " triangles; no more than 67 million in all are made of curves and "
                        "subdivision surfaces");
}

}  // namespace

TriangleMesh curve(const ParameterSet& set, const ShapeContext& context) {
  set.ignore({"splitdepth"});
  const CurveType type = get_type(set);
  const std::vector<Segment> segments = get_segments(set, type);
  const int sides = type == CurveType::Ribbon ? 1 : side_count(segments);
  check_total(set, segments, sides, context.triangles_left);

  TriangleMesh mesh;
  CurvePoint last = point_at(segments[0], 0.0);
  glm::dvec3 across = any_across(last.tangent);
  for (const Segment& s : segments) {
    if (!(polygon_length(s) > 0.0) || !(s.width[0] + s.width[1] > 0.0)) continue;
    const int steps = step_count(s);
    for (int i = 0; i <= steps; ++i) {
      const CurvePoint p = point_at(s, double(i) / steps);
      across = carried(across, last, p);
      type == CurveType::Ribbon ? add_pair(mesh, p) : add_ring(mesh, p, across, sides);
      if (i > 0) join_rows(mesh, static_cast<unsigned>(sides) + 1);
      last = p;
    }
  }
  return mesh;
}

}  // namespace lockstep::pbrt
