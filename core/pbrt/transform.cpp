#include "core/pbrt/transform.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <string>

namespace lockstep::pbrt {

namespace {

double read_number(Lexer& lexer, const char* directive) {
  return lexer.expect_number(std::string("a number for ") + directive);
}

glm::dvec3 read_vector(Lexer& lexer, const char* directive) {
  glm::dvec3 v(0.0);
  for (int i = 0; i < 3; ++i) v[i] = read_number(lexer, directive);
  return v;
}

glm::dmat4 from_columns(glm::dvec3 x, glm::dvec3 y, glm::dvec3 z, glm::dvec3 origin) {
  return {glm::dvec4(x, 0.0), glm::dvec4(y, 0.0), glm::dvec4(z, 0.0), glm::dvec4(origin, 1.0)};
}

glm::dmat4 translation(Lexer& lexer, const Location&) {
  return from_columns({1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0},
                      read_vector(lexer, "Translate"));
}

glm::dmat4 scaling(Lexer& lexer, const Location&) {
  const glm::dvec3 s = read_vector(lexer, "Scale");
  return from_columns({s.x, 0.0, 0.0}, {0.0, s.y, 0.0}, {0.0, 0.0, s.z}, glm::dvec3(0.0));
}

// Angle in degrees, then the axis.
glm::dmat4 rotation(Lexer& lexer, const Location& where) {
  const double angle = glm::radians(read_number(lexer, "Rotate"));
  const glm::dvec3 given = read_vector(lexer, "Rotate");
  const double length = glm::length(given);
  if (!(length > 0.0)) fail(where, "Rotate needs an axis that is not zero");
  const glm::dvec3 axis = given / length;
  const double s = std::sin(angle), c = std::cos(angle);
  const auto turned = [&](glm::dvec3 v) {  // Rodrigues
    return c * v + s * glm::cross(axis, v) + (1.0 - c) * glm::dot(axis, v) * axis;
  };
  return from_columns(turned({1.0, 0.0, 0.0}), turned({0.0, 1.0, 0.0}), turned({0.0, 0.0, 1.0}),
                      glm::dvec3(0.0));
}

// Eye, point looked at, up; from world to a camera that looks along +z with x to its right.
glm::dmat4 look_at(Lexer& lexer, const Location& where) {
  const glm::dvec3 eye = read_vector(lexer, "LookAt");
  const glm::dvec3 forward = read_vector(lexer, "LookAt") - eye;
  const glm::dvec3 up = read_vector(lexer, "LookAt");
  const glm::dvec3 right = glm::cross(up, forward);
  if (!(glm::length(right) > 1e-10 * glm::length(up) * glm::length(forward))) {
    fail(where, "LookAt needs two distinct points and an up vector not along the view");
  }
  const glm::dvec3 z = glm::normalize(forward), x = glm::normalize(right);
  return glm::inverse(from_columns(x, glm::cross(z, x), z, eye));
}

// Sixteen numbers, column by column.
glm::dmat4 matrix(Lexer& lexer, const Location& where) {
  const bool bracket = lexer.peek().kind == Token::Kind::Open;
  if (bracket) lexer.next();
  glm::dmat4 m(1.0);
  for (int i = 0; i < 16; ++i) m[i / 4][i % 4] = lexer.expect_number("16 numbers of a matrix");
  if (bracket) lexer.expect(Token::Kind::Close, "] after the 16 numbers of a matrix");
  const double w = m[3][3];
  const double tilt = std::max({std::abs(m[0][3]), std::abs(m[1][3]), std::abs(m[2][3])});
  if (w == 0.0 || tilt > 1e-6 * std::abs(w)) {
    fail(where, "the matrix is projective; only affine transforms are supported");
  }
  m /= w;
  m[0][3] = m[1][3] = m[2][3] = 0.0;
  return m;
}

glm::dmat4 identity(Lexer&, const Location&) { return glm::dmat4(1.0); }

struct TransformDirective {
  std::string_view name;
  glm::dmat4 (*read)(Lexer&, const Location&);
  bool replaces;  // the current matrix, instead of being multiplied to it
};

constexpr TransformDirective directives[] = {
    {"Translate", translation, false},  {"Scale", scaling, false},
    {"Rotate", rotation, false},        {"LookAt", look_at, false},
    {"ConcatTransform", matrix, false}, {"Transform", matrix, true},
    {"Identity", identity, true},
};

const TransformDirective* directive_named(std::string_view name) {
  const auto* found = std::find_if(std::begin(directives), std::end(directives),
                                   [&](const TransformDirective& d) { return d.name == name; });
  return found == std::end(directives) ? nullptr : found;
}

// Singular up to the rounding of matrices that files give with float digits.
bool is_invertible(const glm::dmat4& m) {
  const glm::dmat3 linear(m);
  const double volume = glm::length(linear[0]) * glm::length(linear[1]) * glm::length(linear[2]);
  return std::isfinite(volume) && std::abs(glm::determinant(linear)) > 1e-9 * volume;
}

bool fits_float(const glm::dmat4& m) {
  constexpr double largest = 1e30;
  for (int i = 0; i < 16; ++i) {
    if (!(std::abs(m[i / 4][i % 4]) < largest)) return false;
  }
  return glm::length(m[0]) > 1.0 / largest;
}

}  // namespace

bool is_transform_directive(std::string_view directive) {
  return directive_named(directive) != nullptr;
}

void apply_transform_directive(const Token& directive, Lexer& lexer, glm::dmat4& ctm) {
  const TransformDirective* found = directive_named(directive.text);
  const Location where = lexer.at(directive);
  const glm::dmat4 m = found->read(lexer, where);
  ctm = found->replaces ? m : ctm * m;
  if (!is_invertible(ctm) || !fits_float(ctm)) {
    fail(where, std::string(directive.text) + " gives a transform that cannot be inverted");
  }
}

bool swaps_handedness(const glm::dmat4& m) { return glm::determinant(glm::dmat3(m)) < 0.0; }

}  // namespace lockstep::pbrt
