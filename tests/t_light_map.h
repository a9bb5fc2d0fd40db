// Where a light lies as seen from a point, in double and by other formulas than the renderer's.
#pragma once

#include "tests/chi_square.h"
#include "tests/t_light.h"

namespace lockstep::test_light {

// Distance along w (unit) to the near side of the sphere, or from inside to its wall.
inline double sphere_distance(const LightCase& c, glm::dvec3 w) {
  const glm::dvec3 to_centre = glm::dvec3(c.corner) - glm::dvec3(c.point);
  const double along = glm::dot(to_centre, w), r = double(c.radius);
  const glm::dvec3 miss = to_centre - along * w;
  const double half_chord = std::sqrt(std::max(0.0, r * r - glm::dot(miss, miss)));
  return glm::length(to_centre) > r ? along - half_chord : along + half_chord;
}

// The directions to a light as the unit square, with the light's outline on the square's, in double
// and by other formulas than the renderer's.
class LightMap {
 public:
  explicit LightMap(const LightCase& light)
      : light_(light),
        to_corner_(glm::dvec3(light.corner) - glm::dvec3(light.point)),
        sphere_(glm::length(to_corner_) > 0.0 ? to_corner_ : glm::dvec3(0.0, 0.0, 1.0)) {
    const double d = glm::length(to_corner_), r = double(light.radius);
    cone_ = light.is_sphere() && d > r ? 1.0 - std::sqrt((d - r) * (d + r)) / d : 2.0;
    if (light.is_sphere() && d > 100.0 * r) cone_ = 0.5 * (r / d) * (r / d);
  }

  struct Target {
    glm::dvec3 wi;
    double distance;
    double solid_angle_per_area;
  };

  Target at(glm::dvec2 p) const {
    if (light_.is_sphere()) {
      const glm::dvec2 q(p.x * cone_ * 0.5, p.y);
      const glm::dvec3 wi = sphere_.to_direction(q);
      return {wi, sphere_distance(light_, wi), sphere_.solid_angle_per_area(q) * cone_ * 0.5};
    }
    glm::dvec2 b = p;
    if (light_.kind == LightKind::Triangle) {
      b = std::sqrt(p.x) * glm::dvec2(p.y, 1.0 - p.y);
    } else if (light_.kind == LightKind::Disk) {
      const double sector = std::floor(p.y * corners());
      const glm::dvec2 c0 = corner(sector), c1 = corner(sector + 1.0);
      b = std::sqrt(p.x) * (c0 + (p.y * corners() - sector) * (c1 - c0));
    }
    const glm::dvec3 to =
        to_corner_ + b.x * glm::dvec3(light_.edge1) + b.y * glm::dvec3(light_.edge2);
    const double distance = glm::length(to);
    const glm::dvec3 normal = glm::normalize(light_.cross_edges());
    const double cosine = std::abs(glm::dot(normal, to)) / distance;
    return {to / distance, distance, light_.area() * cosine / (distance * distance)};
  }

  glm::dvec2 to_square(glm::dvec3 wi) const {
    if (light_.is_sphere()) {
      const glm::dvec2 q = sphere_.to_square(wi);
      return {q.x * 2.0 / cone_, q.y};
    }
    // Cramer's rule for to_corner + s edge1 + t edge2 = distance wi.
    const glm::dvec3 e1(light_.edge1), e2(light_.edge2);
    const double determinant = glm::dot(wi, glm::cross(e1, e2));
    const double s = glm::dot(wi, glm::cross(e2, to_corner_)) / determinant;
    const double t = glm::dot(wi, glm::cross(to_corner_, e1)) / determinant;
    if (light_.kind == LightKind::Parallelogram) return {s, t};
    if (light_.kind == LightKind::Disk) {
      const double turns = std::atan2(t, s) / (2.0 * pi_d);
      const double sector = std::floor((turns < 0.0 ? turns + 1.0 : turns) * corners());
      const glm::dvec2 c0 = corner(sector), along = corner(sector + 1.0) - c0;
      const double r = (s * along.y - t * along.x) / (c0.x * along.y - c0.y * along.x);
      const double share = glm::dot(glm::dvec2(s, t) / r - c0, along) / glm::dot(along, along);
      return {r * r, (sector + share) / corners()};
    }
    return {(s + t) * (s + t), s / (s + t)};
  }

  // Solid angle of the light: an integral of the map, checked against closed forms below.
  double solid_angle() const {
    return integrate([&](glm::dvec2 p) { return at(p).solid_angle_per_area; }, {0.0, 0.0},
                     {1.0, 1.0}, 1e-9);
  }

 private:
  double corners() const { return double(light_.outline); }
  glm::dvec2 corner(double i) const {
    const double angle = 2.0 * pi_d * i / corners();
    return {std::cos(angle), std::sin(angle)};
  }

  LightCase light_;
  glm::dvec3 to_corner_;
  DirectionMap sphere_;
  double cone_;  // 1 - cos of the half angle of a sphere; 2 from inside
};

}  // namespace lockstep::test_light
