// Solid angles of lights, and how samples share them, against closed forms.
#include "tests/t_light_map.h"

#include <gtest/gtest.h>

namespace lockstep::test_light {
namespace {

// Solid angle of a triangle (van Oosterom and Strackee 1983) seen from the origin.
double triangle_solid_angle(glm::dvec3 a, glm::dvec3 b, glm::dvec3 c) {
  a = glm::normalize(a), b = glm::normalize(b), c = glm::normalize(c);
  const double numerator = std::abs(glm::dot(a, glm::cross(b, c)));
  return 2.0 * std::atan2(numerator, 1.0 + glm::dot(a, b) + glm::dot(b, c) + glm::dot(c, a));
}

double solid_angle(const LightCase& c) {
  const glm::dvec3 o = glm::dvec3(c.corner) - glm::dvec3(c.point), e1(c.edge1), e2(c.edge2);
  if (c.is_sphere()) {
    const double d = glm::length(o), r = double(c.radius);
    if (d <= r) return 4.0 * pi_d;
    const double sin2 = r * r / (d * d);
    return 2.0 * pi_d * sin2 / (1.0 + std::sqrt(1.0 - sin2));
  }
  if (c.kind == LightKind::Disk) {
    double sum = 0.0;
    const double angle = 2.0 * pi_d / double(c.outline);
    for (double a = 0.5; a < double(c.outline); a += 1.0) {
      const auto at = [&](double i) { return std::cos(i * angle) * e1 + std::sin(i * angle) * e2; };
      sum += triangle_solid_angle(o, o + at(a - 0.5), o + at(a + 0.5));
    }
    return sum;
  }
  const double half = triangle_solid_angle(o, o + e1, o + e2);
  if (c.kind == LightKind::Triangle) return half;
  return half + triangle_solid_angle(o + e1, o + e1 + e2, o + e2);
}

// A rectangle in its own frame, in units of its height above the point that is lit.
struct Rectangle {
  double x0, x1, y0, y1;

  // Solid angle of the part up to x; of the whole by default.
  double solid_angle(double x) const {
    const auto corner = [](double a, double b) {
      return std::atan2(a * b, std::sqrt(1.0 + a * a + b * b));
    };
    return corner(x, y1) - corner(x0, y1) - corner(x, y0) + corner(x0, y0);
  }
  // Share of the line at x that lies below y.
  double share_of_line(double x, double y) const {
    const auto sine = [&](double b) { return b / std::sqrt(1.0 + x * x + b * b); };
    return (sine(y) - sine(y0)) / (sine(y1) - sine(y0));
  }
};

// The maps from u to the solid angle below x, and on the line at x to that below y, are the
// identity: from near (a thousandth of the rectangle's size) to far, over its middle, its edges and
// its corners, beside it and of great length.
TEST(SphericalRectangle, SharesOfTheSolidAngleAreThoseOfU) {
  constexpr float size = 3.0f;
  for (const float height : {0.001f, 0.01f, 0.1f, 1.0f, 10.0f, 10000.0f}) {
    for (const glm::vec2 corner :
         {glm::vec2(-0.5f), glm::vec2(0.0f), glm::vec2(-1.0f, -0.4f), glm::vec2(-0.99f),
          glm::vec2(0.5f, -0.1f), glm::vec2(0.3f, -2.0f)}) {
      for (const float length : {1.0f, 30.0f}) {
        const float width = size * length, z = size * height;
        const glm::vec3 to_corner(corner.x * width, corner.y * size, z);
        const auto seen = spherical_rectangle<float>(to_corner, {width, 0.0f, 0.0f},
                                                     {0.0f, size, 0.0f}, {0.0f, 0.0f, -1.0f});
        const double h = double(seen.z);
        const Rectangle r{double(seen.x0) / h, (double(seen.x0) + double(seen.width)) / h,
                          double(seen.y0) / h, (double(seen.y0) + double(seen.height)) / h};
        const std::string what = "height " + std::to_string(height) + ", corner " +
                                 std::to_string(corner.x) + " " + std::to_string(corner.y) +
                                 ", length " + std::to_string(length);
        const double whole = r.solid_angle(r.x1);
        if (height < 100.0f) {
          EXPECT_NEAR(double(seen.solid_angle) / whole, 1.0, 2e-4) << what;
        }
        if (!(seen.solid_angle >= min_solid_angle)) continue;
        for (std::uint32_t i = 0; i < 500; ++i) {
          const Vec2<float> u = uniform2(i, 80);
          const glm::dvec2 st(sample_spherical_rectangle(seen, u));
          ASSERT_TRUE(st.x >= 0.0 && st.x <= 1.0 && st.y >= 0.0 && st.y <= 1.0) << what;
          const double x = r.x0 + st.x * (r.x1 - r.x0), y = r.y0 + st.y * (r.y1 - r.y0);
          ASSERT_NEAR(r.solid_angle(x) / whole, double(u.x), 2e-3) << what;
          ASSERT_NEAR(r.share_of_line(x, y), double(u.y), 2e-3) << what;
        }
      }
    }
  }
}

// As for rectangles: u.x is the solid angle's share of the part a, b, c' in which c' lies on the
// edge a c, and u.y the place between b and c'.
TEST(SphericalTriangle, SharesOfTheSolidAngleAreThoseOfU) {
  for (const float height : {0.001f, 0.01f, 0.1f, 1.0f, 10.0f, 10000.0f}) {
    for (const glm::vec3 corner : {glm::vec3(-0.3f, -0.3f, 0.0f), glm::vec3(0.0f),
                                   glm::vec3(0.5f, -0.1f, 0.0f), glm::vec3(-2.0f, 1.0f, 0.0f)}) {
      for (const glm::vec3 edge : {glm::vec3(0.2f, 1.0f, 0.0f), glm::vec3(9.0f, 1.0f, 0.3f)}) {
        const auto seen = spherical_triangle<float>(corner + glm::vec3(0.0f, 0.0f, height),
                                                    {1.0f, 0.0f, 0.0f}, edge);
        if (!(seen.solid_angle >= min_solid_angle)) continue;
        if (!(seen.solid_angle <= max_triangle_angle)) continue;
        const glm::dvec3 a(seen.to_corner), b = a + glm::dvec3(seen.edge1),
                                            c = a + glm::dvec3(seen.edge2);
        const double whole = triangle_solid_angle(a, b, c);
        const std::string what =
            "height " + std::to_string(height) + ", corner " + std::to_string(corner.x);
        EXPECT_NEAR(double(seen.solid_angle) / whole, 1.0, 2e-4) << what;
        for (std::uint32_t i = 0; i < 500; ++i) {
          const Vec2<float> u = uniform2(i, 82);
          const glm::dvec2 st(sample_spherical_triangle(seen, u));
          ASSERT_TRUE(st.x >= 0.0 && st.y >= 0.0 && st.x + st.y <= 1.0 + 1e-6) << what;
          const glm::dvec3 w =
              glm::normalize(a + st.x * glm::dvec3(seen.edge1) + st.y * glm::dvec3(seen.edge2));
          glm::dvec3 c1 = glm::normalize(glm::cross(glm::cross(b, w), glm::cross(a, c)));
          if (glm::dot(c1, glm::normalize(a) + glm::normalize(c)) < 0.0) c1 = -c1;
          const auto gap = [](glm::dvec3 v, glm::dvec3 to) { return glm::dot(v - to, v - to); };
          const glm::dvec3 n = glm::normalize(b);
          ASSERT_NEAR(triangle_solid_angle(a, b, c1) / whole, double(u.x), 2e-3) << what;
          ASSERT_NEAR(gap(n, w) / gap(n, c1), double(u.y), 2e-3) << what;
        }
      }
    }
  }
}

// Next to a large rectangle half of all directions meet it, and hardly one weighs more than
// another.
TEST(Light, RectanglesNearbyHaveTheDensityOfTheirSolidAngle) {
  for (const float distance : {0.3f, 1e-2f, 1e-3f}) {
    const LightCase c = rectangle("near", {0.1f, -0.2f, distance}, 1.0f, 1.0f);
    const LightScene scene({c});
    for (std::uint32_t i = 0; i < 200; ++i) {
      const LightSample<float> s = sample_case(scene, c, uniform2(i, 81));
      EXPECT_NEAR(double(choice / s.pdf) / solid_angle(c), 1.0, 1e-3) << distance;
    }
  }
}

TEST(Light, SolidAnglesMatchClosedForms) {
  for (const LightCase& c : cases()) {
    const double expected = solid_angle(c);
    EXPECT_NEAR(LightMap(c).solid_angle() / expected, 1.0, 1e-4) << c.name;
    const Mean m = estimate(c, [](const LightSample<float>&) { return 1.0f; });
    EXPECT_NEAR(m.value, expected, 4.5 * m.sigma + 1e-5 * expected) << c.name;
  }
}

}  // namespace
}  // namespace lockstep::test_light
