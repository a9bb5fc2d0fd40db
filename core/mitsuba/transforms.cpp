#include "core/mitsuba/transforms.h"

#include "core/mitsuba/values.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>

namespace lockstep::mitsuba {
namespace {

glm::dmat4 from_columns(glm::dvec3 x, glm::dvec3 y, glm::dvec3 z, glm::dvec3 origin) {
  return {glm::dvec4(x, 0.0), glm::dvec4(y, 0.0), glm::dvec4(z, 0.0), glm::dvec4(origin, 1.0)};
}

glm::dmat4 translation(const Element& e) {
  return from_columns({1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}, vector(e, 0.0));
}

glm::dmat4 scaling(const Element& e) {
  const glm::dvec3 s = vector(e, 1.0);
  return from_columns({s.x, 0.0, 0.0}, {0.0, s.y, 0.0}, {0.0, 0.0, s.z}, glm::dvec3(0.0));
}

glm::dmat4 rotation(const Element& e) {
  const double angle = glm::radians(number(e, "angle"));
  const glm::dvec3 given = vector(e, 0.0);
  const double length = glm::length(given);
  if (!(length > 0.0)) fail(e.where(), "<rotate> needs an axis that is not zero");
  const glm::dvec3 axis = given / length;
  const double s = std::sin(angle), c = std::cos(angle);
  const auto turned = [&](glm::dvec3 v) {  // Rodrigues
    return c * v + s * glm::cross(axis, v) + (1.0 - c) * glm::dot(axis, v) * axis;
  };
  return from_columns(turned({1.0, 0.0, 0.0}), turned({0.0, 1.0, 0.0}), turned({0.0, 0.0, 1.0}),
                      glm::dvec3(0.0));
}

glm::dvec3 point(const Element& e, const char* attribute) {
  const std::vector<double> v = numbers_of(e, e.attribute(attribute));
  if (v.size() != 3) {
    fail(e.where(), std::string("<lookat> needs three numbers as its ") + attribute);
  }
  return {v[0], v[1], v[2]};
}

// x to the left, y up, z to the target: a right-handed frame.
glm::dmat4 look_at(const Element& e) {
  const glm::dvec3 origin = point(e, "origin");
  const glm::dvec3 forward = point(e, "target") - origin;
  glm::dvec3 up = e.has("up") ? point(e, "up") : glm::dvec3(0.0);
  if (up == glm::dvec3(0.0)) {  // any will do
    up = std::abs(forward.y) < 0.9 * glm::length(forward) ? glm::dvec3(0.0, 1.0, 0.0)
                                                          : glm::dvec3(1.0, 0.0, 0.0);
  }
  const glm::dvec3 left = glm::cross(up, forward);
  if (!(glm::length(left) > 1e-10 * glm::length(up) * glm::length(forward))) {
    fail(e.where(), "<lookat> needs two distinct points and an up vector not along the view");
  }
  const glm::dvec3 z = glm::normalize(forward), x = glm::normalize(left);
  return from_columns(x, glm::cross(z, x), z, origin);
}

// Row by row; nine numbers are a linear map.
glm::dmat4 matrix(const Element& e) {
  const std::vector<double> v = numbers_of(e, e.attribute("value"));
  if (v.size() != 9 && v.size() != 16) fail(e.where(), "<matrix> needs 9 or 16 numbers");
  const std::size_t size = v.size() == 9 ? 3 : 4;
  glm::dmat4 m(1.0);
  for (std::size_t i = 0; i < v.size(); ++i) m[int(i % size)][int(i / size)] = v[i];
  return m;
}

// Makes the last row (0, 0, 0, 1).
glm::dmat4 affine(const Element& e, glm::dmat4 m) {
  const double w = m[3][3];
  const double tilt = std::max({std::abs(m[0][3]), std::abs(m[1][3]), std::abs(m[2][3])});
  if (w == 0.0 || tilt > 1e-6 * std::abs(w)) {
    fail(e.where(), "the transform is projective; only affine ones are supported");
  }
  m /= w;
  m[0][3] = m[1][3] = m[2][3] = 0.0;
  return m;
}

// Singular up to the rounding of matrices that files give with float digits.
bool is_usable(const glm::dmat4& m) {
  constexpr double largest = 1e30;
  for (int i = 0; i < 16; ++i) {
    if (!(std::abs(m[i / 4][i % 4]) < largest)) return false;
  }
  const glm::dmat3 linear(m);
  const double volume = glm::length(linear[0]) * glm::length(linear[1]) * glm::length(linear[2]);
  return volume > 0.0 && std::abs(glm::determinant(linear)) > 1e-9 * volume;
}

}  // namespace

glm::dmat4 read_transform(const Element& element, Warnings& warnings) {
  if (element.tag() == "animation") {
    warnings.add(element.where(), "motion is not supported; the first transform is used");
    const std::vector<Element> steps = element.children();
    return steps.empty() ? glm::dmat4(1.0) : read_transform(steps.front(), warnings);
  }
  glm::dmat4 m(1.0);
  for (const Element& e : element.children()) {
    const std::string tag = e.tag();
    if (tag == "translate") {
      m = translation(e) * m;
    } else if (tag == "rotate") {
      m = rotation(e) * m;
    } else if (tag == "scale") {
      m = scaling(e) * m;
    } else if (tag == "lookat") {
      m = look_at(e) * m;
    } else if (tag == "matrix") {
      m = matrix(e) * m;
    } else {
      fail(e.where(),
           e.shown() + " is no transform; expected translate, rotate, scale, lookat or matrix");
    }
  }
  m = affine(element, m);
  if (!is_usable(m)) fail(element.where(), "the transform cannot be inverted");
  return m;
}

UvTransform to_uv_transform(const glm::dmat4& m) {
  UvTransform uv;
  uv.u_row = {float(m[0][0]), float(m[1][0])};
  uv.v_row = {float(m[0][1]), float(m[1][1])};
  uv.offset = {float(m[2][0] + m[3][0]), float(m[2][1] + m[3][1])};
  return uv;
}

}  // namespace lockstep::mitsuba
