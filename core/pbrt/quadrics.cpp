#include "core/pbrt/quadrics.h"

#include "core/pbrt/placement.h"
#include "core/pbrt/revolution.h"
#include "core/pbrt/transform.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lockstep::pbrt {

namespace {

constexpr int full_segments = 128;

float get_radius(const ParameterSet& set) {
  const float radius = set.get_float("radius", 1.0f);
  if (!(radius > 0.0f)) fail(set.where(), set.owner() + " needs a radius above 0");
  return radius;
}

float get_phi_max(const ParameterSet& set) {
  const float degrees = set.get_float("phimax", 360.0f);
  if (!(degrees > 0.0f)) fail(set.where(), set.owner() + " needs a phimax above 0");
  return glm::radians(std::min(degrees, 360.0f));
}

TriangleMesh turned(const std::vector<ProfilePoint>& profile, float phi_max) {
  const float share = phi_max / (2.0f * std::numbers::pi_v<float>);
  const int segments = std::max(1, static_cast<int>(std::ceil(share * full_segments)));
  return revolve(profile, phi_max, segments);
}

// Whether all columns have the length `scale` and right angles between them.
bool is_similarity(const glm::dmat3& m, int columns, double scale) {
  for (int i = 0; i < columns; ++i) {
    for (int j = i; j < columns; ++j) {
      const double expected = i == j ? 1.0 : 0.0;
      if (!(std::abs(glm::dot(m[i], m[j]) / (scale * scale) - expected) <= 1e-5)) return false;
    }
  }
  return true;
}

bool is_turned(const glm::dmat3& m, double scale) {
  return std::min({m[0].x, m[1].y, m[2].z}) < (1.0 - 1e-6) * scale;
}

float scaled_radius(const ParameterSet& set, float radius, double scale) {
  const auto scaled = static_cast<float>(scale * static_cast<double>(radius));
  if (std::isfinite(scaled) && scaled > 0.0f) return scaled;
  fail(set.where(), set.owner() + " has a radius that leaves the range of float");
}

// From the south pole up, where v is 0.
std::vector<ProfilePoint> sphere_profile(float radius) {
  constexpr int rows = full_segments / 2;
  std::vector<ProfilePoint> profile;
  for (int i = 0; i <= rows; ++i) {
    const double v = static_cast<double>(i) / rows, theta = std::numbers::pi * (1.0 - v);
    const bool pole = i == 0 || i == rows;
    const auto out = static_cast<float>(pole ? 0.0 : std::sin(theta));
    const auto up = static_cast<float>(std::cos(theta));
    profile.push_back({radius * out, radius * up, out, up, static_cast<float>(v)});
  }
  return profile;
}

}  // namespace

Geometry make_sphere(const ParameterSet& set, const ShapeContext& context, Warnings& warnings) {
  const float radius = get_radius(set);
  if (set.get_float("zmin", -radius) > -radius || set.get_float("zmax", radius) < radius ||
      set.get_float("phimax", 360.0f) < 360.0f) {
    warnings.add(set.where(), "partial spheres are not supported; the full sphere is used");
  }
  const glm::dmat4& m = context.object_to_world;
  const double scale = glm::length(glm::dvec3(m[0]));
  if (!is_similarity(glm::dmat3(m), 3, scale) ||
      (context.may_be_textured && is_turned(glm::dmat3(m), scale))) {
    return to_world(turned(sphere_profile(radius), 2.0f * std::numbers::pi_v<float>), set, context);
  }
  return Sphere{glm::vec3(m[3]), scaled_radius(set, radius, scale), context.reverse_orientation};
}

// v is 1 at the inner rim; the normal is +z.
Geometry make_disk(const ParameterSet& set, const ShapeContext& context) {
  const float radius = get_radius(set), height = set.get_float("height", 0.0f);
  const float inner = set.get_float("innerradius", 0.0f), phi_max = get_phi_max(set);
  if (!(inner >= 0.0f && inner < radius)) {
    fail(set.where(), set.owner() + " needs an innerradius from 0 to below the radius");
  }
  const glm::dmat4& m = context.object_to_world;
  const double scale = glm::length(glm::dvec3(m[0]));
  const bool whole = inner == 0.0f && phi_max == glm::radians(360.0f);
  if (!whole || context.may_be_textured || !is_similarity(glm::dmat3(m), 2, scale)) {
    return to_world(
        turned({{inner, height, 0.0f, 1.0f, 1.0f}, {radius, height, 0.0f, 1.0f, 0.0f}}, phi_max),
        set, context);
  }
  Disk disk;
  disk.center = glm::vec3(m * glm::dvec4(0.0, 0.0, height, 1.0));
  disk.radius = scaled_radius(set, radius, scale);
  glm::dvec3 normal = glm::normalize(glm::cross(glm::dvec3(m[0]), glm::dvec3(m[1])));
  if (swaps_handedness(m) != context.reverse_orientation) normal = -normal;
  disk.normal = glm::vec3(normal);
  return disk;
}

Geometry make_cylinder(const ParameterSet& set, const ShapeContext& context) {
  const float radius = get_radius(set);
  const float a = set.get_float("zmin", -1.0f), b = set.get_float("zmax", 1.0f);
  if (a == b) fail(set.where(), set.owner() + " needs zmin and zmax that differ");
  const TriangleMesh mesh = turned(
      {{radius, std::min(a, b), 1.0f, 0.0f, 0.0f}, {radius, std::max(a, b), 1.0f, 0.0f, 1.0f}},
      get_phi_max(set));
  return to_world(mesh, set, context);
}

}  // namespace lockstep::pbrt
