// Lights: directions sampled against the density that hit_light gives for them, solid angles and
// irradiance against closed forms, sides, and the choice among lights.
#include "core/light.h"

#include "tests/chi_square.h"
#include "tests/widths.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace lockstep {
namespace {

constexpr std::uint32_t sample_count = 1 << 17;
constexpr float choice = 0.25f;  // probability of choosing the light, in every row
constexpr double pi_d = 3.14159265358979323846;

struct LightCase {
  std::string name;
  LightKind kind;
  glm::vec3 corner{0.0f}, edge1{0.0f}, edge2{0.0f};
  float radius = 0.0f;  // of a sphere
  float side = 0.0f;
  glm::vec3 point{0.0f};  // that is lit
  float outline = 0.0f;   // as LightTable has it

  bool is_sphere() const { return kind == LightKind::Sphere; }
  glm::dvec3 cross_edges() const { return glm::cross(glm::dvec3(edge1), glm::dvec3(edge2)); }
  double area() const {
    const double corners = double(outline);
    const double share = kind == LightKind::Triangle ? 0.5
                         : kind == LightKind::Disk ? 0.5 * corners * std::sin(2.0 * pi_d / corners)
                                                   : 1.0;
    return share * glm::length(cross_edges());
  }
};

LightCase parallelogram(const char* name, glm::vec3 point, float side = 1.0f) {
  return {name,
          LightKind::Parallelogram,
          {-1.0f, -0.5f, 2.0f},
          {0.3f, 1.0f, 0.1f},
          {2.0f, 0.0f, 0.0f},
          0.0f,
          side,
          point};
}
// At right angles, its middle at `middle` and its normal +z.
LightCase rectangle(const char* name, glm::vec3 middle, float width, float height,
                    glm::vec3 point = glm::vec3(0.0f)) {
  const glm::vec3 x = width * normalize(glm::vec3(1.0f, -0.4f, 0.0f));
  const glm::vec3 y = height * normalize(glm::vec3(0.4f, 1.0f, 0.0f));
  return {name, LightKind::Parallelogram, middle - 0.5f * x - 0.5f * y, x, y, 0.0f, 0.0f, point,
          1.0f};
}
LightCase disk(const char* name, glm::vec3 point, float corners = 128.0f) {
  return {name,
          LightKind::Disk,
          {0.2f, -0.1f, 1.0f},
          {1.5f, 0.3f, 0.0f},
          {-0.3f, 1.2f, 0.2f},
          0.0f,
          0.0f,
          point,
          corners};
}
LightCase triangle(const char* name, glm::vec3 point, float side = 1.0f) {
  return {name,
          LightKind::Triangle,
          {-1.0f, -0.5f, 2.0f},
          {0.3f, 1.5f, 0.1f},
          {2.0f, 0.0f, 0.0f},
          0.0f,
          side,
          point};
}
LightCase sphere(const char* name, float radius, float distance, float side) {
  const glm::vec3 direction = normalize(glm::vec3(0.5f, -0.3f, 0.7f));
  const glm::vec3 centre(0.1f, 0.2f, -0.3f);
  LightCase c{name, LightKind::Sphere, centre};
  c.radius = radius, c.side = side;
  c.point = centre + distance * direction;
  return c;
}

// Every light seen from where it shines.
std::vector<LightCase> cases() {
  return {
      parallelogram("parallelogram", {0.2f, 0.3f, -1.0f}),
      parallelogram("parallelogram, near", {0.1f, 0.0f, 1.9f}),
      parallelogram("parallelogram, far", {5.0f, 20.0f, -30.0f}),
      parallelogram("parallelogram, grazing", {4.0f, 3.0f, 1.7f}),
      parallelogram("parallelogram, from behind", {0.1f, 0.4f, 3.0f}, 0.0f),
      rectangle("rectangle", {0.2f, 0.3f, -1.0f}, 1.0f, 2.0f),
      rectangle("rectangle, near", {0.1f, 0.2f, 0.1f}, 1.0f, 1.0f),
      rectangle("rectangle, far", {2.0f, 3.0f, -2.5f}, 1.0f, 1.0f),
      rectangle("rectangle, too far for its solid angle", {0.1f, 0.2f, 0.3f}, 1.0f, 1.0f,
                {50.0f, 80.0f, 30.0f}),
      rectangle("rectangle, grazing", {1.0f, 0.6f, 0.05f}, 1.0f, 1.0f),
      rectangle("rectangle, of great length", {0.0f, 0.0f, 1.0f}, 100.0f, 0.1f),
      rectangle("rectangle, over its corner", {0.5f, 0.5f, 0.3f}, 1.0f, 1.0f),
      disk("disk", {0.2f, 0.3f, -1.0f}),
      disk("disk, near", {0.5f, 0.0f, 0.9f}),
      disk("disk, far", {5.0f, 20.0f, -30.0f}),
      disk("disk, grazing", {4.0f, 3.0f, 0.7f}),
      disk("disk of few corners", {0.2f, 0.3f, -1.0f}, 5.0f),
      triangle("triangle", {0.2f, 0.3f, -1.0f}),
      triangle("triangle, near", {-0.3f, 0.0f, 1.9f}),
      triangle("triangle, far", {5.0f, 20.0f, -30.0f}),
      triangle("triangle, grazing", {3.0f, 1.0f, 1.7f}),
      triangle("triangle, from behind", {0.1f, 0.4f, 3.0f}, -1.0f),
      sphere("sphere", 1.0f, 2.0f, 1.0f),
      sphere("sphere, far", 0.01f, 50.0f, 1.0f),
      sphere("sphere, near", 1.0f, 1.01f, 1.0f),
      sphere("sphere, two-sided", 2.0f, 3.0f, 0.0f),
      sphere("sphere, from inside", 1.0f, 0.7f, -1.0f),
      sphere("sphere, from its centre", 1.0f, 0.0f, 0.0f),
      sphere("sphere, from just inside", 1.0f, 0.99f, -1.0f),
  };
}

// A scene of these lights, each chosen with probability `choice`.
struct LightScene {
  std::vector<float> rows;
  std::vector<float> cdf;
  SceneData data;

  explicit LightScene(const std::vector<LightCase>& lights) {
    for (const LightCase& c : lights) append(c);
    data.lights = {int(lights.size()), rows.data(), cdf.data()};
  }

 private:
  void append(const LightCase& c) {
    const glm::vec3 normal =
        c.is_sphere() ? glm::vec3(0.0f) : glm::vec3(glm::normalize(c.cross_edges()));
    const auto add = [&](glm::vec3 v, float last) {
      rows.insert(rows.end(), {v.x, v.y, v.z, last});
    };
    add(c.corner, c.is_sphere() ? c.radius : float(c.area()));
    add(c.edge1, choice);
    add(c.edge2, c.side);
    add(normal, float(int(c.kind)));
    add(glm::vec3(3.0f, 2.0f, 1.0f), c.outline);
  }
};

LightSample<float> sample_case(const LightScene& scene, const LightCase& c, Vec2<float> u) {
  return sample_light<float>(scene.data, 0, c.point, frame_around(glm::vec3(0.0f, 0.0f, 1.0f)), u);
}

// Distance along w (unit) to the near side of the sphere, or from inside to its wall.
double sphere_distance(const LightCase& c, glm::dvec3 w) {
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

bool inside_unit_square(glm::dvec2 p) {
  constexpr double rounding = 1e-3;
  return p.x > -rounding && p.x < 1.0 + rounding && p.y > -rounding && p.y < 1.0 + rounding;
}

DensityTest test_density(const LightCase& c, std::uint32_t seed) {
  const LightScene scene({c});
  const LightMap map(c);
  CellCounts counts(24, 24);
  for (std::uint32_t i = 0; i < sample_count; ++i) {
    const LightSample<float> s = sample_case(scene, c, uniform2(i, seed));
    const glm::dvec2 p = map.to_square(glm::dvec3(s.wi));
    s.pdf > 0.0f && inside_unit_square(p) ? counts.add(p) : counts.add_lost();
  }
  return counts.test([&](glm::dvec2 p) {
    const LightMap::Target t = map.at(p);
    const Emitted<float> e =
        hit_light<float>(scene.data, 0, c.point, glm::vec3(t.wi), float(t.distance));
    return e.radiance.x > 0.0f ? double(e.pdf / choice) * t.solid_angle_per_area : 0.0;
  });
}

TEST(Light, SampledDirectionsHaveTheDensityOfHits) {
  const auto lights = cases();
  std::uint32_t seed = 0;
  for (const LightCase& c : lights) {
    const DensityTest test = test_density(c, ++seed);
    EXPECT_GT(test.chi_square.p_value, sidak_significance(int(lights.size())))
        << c.name << ": chi-square " << test.chi_square.statistic << " with "
        << test.chi_square.degrees << " degrees of freedom";
    EXPECT_NEAR(test.mass, 1.0, 1e-3) << c.name;
    EXPECT_NEAR(test.valid_share, 1.0, 1e-4) << c.name;
  }
}

TEST(Light, SamplesLieOnTheLightAndAgreeWithHits) {
  for (const LightCase& c : cases()) {
    const LightScene scene({c});
    int failures = 0;
    for (std::uint32_t i = 0; i < 4096 && failures < 3; ++i) {
      const LightSample<float> s = sample_case(scene, c, uniform2(i, 20));
      if (!(s.pdf > 0.0f)) continue;
      const Emitted<float> e = hit_light<float>(scene.data, 0, c.point, s.wi, s.distance);
      const glm::dvec3 end =
          glm::dvec3(c.point) + double(s.distance) * glm::dvec3(s.wi) - glm::dvec3(c.corner);
      const double off = c.is_sphere() ? glm::length(end) / double(c.radius) - 1.0
                                       : glm::dot(end, glm::normalize(c.cross_edges()));
      // Positions are rounded in proportion to the distance, densities where the light is grazed.
      const double reach =
          1.0 + glm::length(glm::dvec3(c.point)) / double(c.is_sphere() ? c.radius : 1.0f);
      const double kept_off = c.is_sphere() ? 0x1p-18 : 0.0;  // so that it does not hide itself
      if (std::abs(off) < 2e-6 * reach + kept_off && std::abs(e.pdf / s.pdf - 1.0f) < 5e-3f &&
          e.radiance == s.radiance && std::abs(length(s.wi) - 1.0f) < 1e-6f) {
        continue;
      }
      ++failures;
      ADD_FAILURE() << c.name << ", sample " << i << ": off the light by " << off << ", pdf "
                    << s.pdf << " against " << e.pdf;
    }
  }
}

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

struct Mean {
  double value, sigma;
};

// Mean of f(sample) / pdf over directions to the light, without the choice among lights.
template <class F>
Mean estimate(const LightCase& c, F f) {
  const LightScene scene({c});
  double sum = 0.0, squares = 0.0;
  for (std::uint32_t i = 0; i < sample_count; ++i) {
    const LightSample<float> s = sample_case(scene, c, uniform2(i, 30));
    const double x = s.pdf > 0.0f ? double(f(s)) * double(choice) / double(s.pdf) : 0.0;
    sum += x, squares += x * x;
  }
  const double n = sample_count;
  return {sum / n, std::sqrt(std::max(0.0, squares / n - sum * sum / (n * n)) / n)};
}

TEST(Light, SolidAnglesMatchClosedForms) {
  for (const LightCase& c : cases()) {
    const double expected = solid_angle(c);
    EXPECT_NEAR(LightMap(c).solid_angle() / expected, 1.0, 1e-4) << c.name;
    const Mean m = estimate(c, [](const LightSample<float>&) { return 1.0f; });
    EXPECT_NEAR(m.value, expected, 4.5 * m.sigma + 1e-5 * expected) << c.name;
  }
}

// Form factor from a small element to a parallel rectangle whose corner lies above it, by the
// rectangle's sides in units of the distance (Howell's catalogue, B-3).
double parallel_form_factor(double x, double y) {
  const double rx = std::sqrt(1.0 + x * x), ry = std::sqrt(1.0 + y * y);
  return (x / rx * std::atan(y / rx) + y / ry * std::atan(x / ry)) / (2.0 * pi_d);
}

TEST(Light, IrradianceOfARectangleMatchesItsFormFactor) {
  const auto lamp = [](float side) {
    return LightCase{"lamp",
                     LightKind::Parallelogram,
                     {0.0f, 0.0f, 2.0f},
                     {0.0f, 3.0f, 0.0f},
                     {1.0f, 0.0f, 0.0f},
                     0.0f,
                     side};
  };
  for (const float side : {1.0f, 0.0f}) {
    const Mean m = estimate(lamp(side), [](const LightSample<float>& s) {
      return s.radiance.x * std::max(0.0f, s.wi.z);
    });
    const double expected = 3.0 * pi_d * parallel_form_factor(0.5, 1.5);
    EXPECT_NEAR(m.value, expected, 4.5 * m.sigma);
    EXPECT_LT(m.sigma, 2e-3 * expected);
  }
}

TEST(Light, IrradianceOfASphereFollowsTheInverseSquare) {
  for (const float distance : {1.2f, 3.0f, 100.0f}) {
    LightCase c{"sphere", LightKind::Sphere, glm::vec3(0.0f)};
    c.radius = 0.5f, c.side = 1.0f;
    const glm::vec3 direction = normalize(glm::vec3(0.3f, 0.1f, 1.0f));
    c.corner = distance * direction;
    const Mean m = estimate(
        c, [](const LightSample<float>& s) { return s.radiance.y * std::max(0.0f, s.wi.z); });
    const double ratio = double(c.radius) / double(distance);
    EXPECT_NEAR(m.value, 2.0 * pi_d * ratio * ratio * double(direction.z), 4.5 * m.sigma + 1e-7);
  }
}

// As on a floor close to where a lamp touches it: the lamp fills nearly the whole hemisphere.
TEST(Light, IrradianceNextToASphereIsAlmostPi) {
  for (const float distance : {1.0001f, 1.00004f, 1.00002f}) {
    LightCase c{"sphere", LightKind::Sphere, {0.0f, 0.0f, distance}};
    c.radius = 1.0f, c.side = 1.0f;
    const Mean m = estimate(
        c, [](const LightSample<float>& s) { return s.radiance.z * std::max(0.0f, s.wi.z); });
    EXPECT_NEAR(m.value, pi_d / double(distance * distance), 4.5 * m.sigma + 1e-4) << distance;
  }
}

// Shadow rays end 2^-12 of their length before the light. That of a near sphere has lost more
// digits than that to rounding; only at the rim, where a ray just grazes, may they reach it.
TEST(Light, ANearSphereDoesNotHideItself) {
  for (const float distance : {1.2f, 1.01f, 1.0002f, 1.00002f}) {
    const LightCase c = sphere("sphere", 1.0f, distance, 1.0f);
    const LightScene scene({c});
    int hidden = 0, samples = 0;
    for (std::uint32_t i = 0; i < 20000; ++i) {
      const LightSample<float> s = sample_case(scene, c, uniform2(i, 3));
      if (!(s.pdf > 0.0f)) continue;
      ++samples;
      hidden += double(s.distance) * (1.0 - 0x1p-12) > sphere_distance(c, glm::dvec3(s.wi));
    }
    EXPECT_LT(hidden, 2e-3 * samples) << distance;
    EXPECT_GT(samples, 19000);
  }
}

TEST(Light, EnclosingSphereGivesIrradiancePi) {
  for (const float distance : {0.0f, 0.5f, 0.95f}) {
    const Mean m = estimate(sphere("", 1.0f, distance, -1.0f), [](const LightSample<float>& s) {
      return s.radiance.z * std::max(0.0f, s.wi.z);
    });
    EXPECT_NEAR(m.value, pi_d, 4.5 * m.sigma) << distance;
  }
}

TEST(Light, ShinesOnItsSideOnly) {
  const glm::vec3 front(0.2f, 0.3f, -1.0f), back(0.2f, 0.3f, 5.0f);
  struct Case {
    LightCase light;
    bool lit;
  };
  const Case sides[] = {
      {parallelogram("front", front, 1.0f), true},   {parallelogram("back", back, 1.0f), false},
      {parallelogram("front", front, -1.0f), false}, {parallelogram("back", back, -1.0f), true},
      {parallelogram("both", front, 0.0f), true},    {parallelogram("both", back, 0.0f), true},
      {triangle("front", front, 1.0f), true},        {triangle("back", back, 1.0f), false},
      {triangle("both", back, 0.0f), true},          {sphere("outside", 1.0f, 2.0f, 1.0f), true},
      {sphere("outside", 1.0f, 2.0f, -1.0f), false}, {sphere("inside", 1.0f, 0.5f, -1.0f), true},
      {sphere("inside", 1.0f, 0.5f, 1.0f), false},   {sphere("both", 1.0f, 0.5f, 0.0f), true},
      {sphere("both", 1.0f, 2.0f, 0.0f), true}};
  for (const auto& [light, lit] : sides) {
    const LightScene scene({light});
    const LightMap map(light);
    for (std::uint32_t i = 0; i < 200; ++i) {
      EXPECT_EQ(sample_case(scene, light, uniform2(i, 40)).pdf > 0.0f, lit)
          << light.name << " " << light.side;
      const auto target = map.at(glm::dvec2(uniform2(i, 41)));
      const auto hit = hit_light<float>(scene.data, 0, light.point, glm::vec3(target.wi),
                                        float(target.distance));
      EXPECT_EQ(hit.radiance.x, lit ? 3.0f : 0.0f) << light.name << " " << light.side;
    }
  }
}

TEST(Light, DegenerateViewsAreMasked) {
  // In the light's plane, on the light, and a light without area.
  LightCase edge_on{"edge on",
                    LightKind::Parallelogram,
                    {1.0f, 0.0f, 0.0f},
                    {1.0f, 0.0f, 0.0f},
                    {0.0f, 1.0f, 0.0f},
                    0.0f,
                    0.0f};
  LightCase on_it = edge_on, inside = edge_on;
  on_it.corner = glm::vec3(0.0f);
  inside.corner = glm::vec3(-0.5f, -0.25f, 0.0f);
  LightCase rectangle_edge_on = edge_on, rectangle_on_it = on_it, rectangle_inside = inside;
  rectangle_edge_on.outline = rectangle_on_it.outline = rectangle_inside.outline = 1.0f;
  LightCase triangle_inside = inside;
  triangle_inside.kind = LightKind::Triangle;
  for (const LightCase& c : {edge_on, on_it, inside, rectangle_edge_on, rectangle_on_it,
                             rectangle_inside, triangle_inside}) {
    const LightScene scene({c});
    for (const Vec2<float> u : {Vec2<float>(0.0f, 0.0f), Vec2<float>(0.5f, 0.25f)}) {
      EXPECT_EQ(sample_case(scene, c, u).pdf, 0.0f) << c.name;
    }
  }
}

TEST(Light, EnvironmentFollowsTheCosine) {
  LightCase c{"environment", LightKind::Environment};
  LightScene scene({c});
  const Frame<float> frame = frame_around(normalize(glm::vec3(0.4f, -0.7f, 0.2f)));
  const DirectionMap map{glm::dvec3(frame.z)};
  CellCounts counts(32, 32);
  for (std::uint32_t i = 0; i < sample_count; ++i) {
    const auto s = sample_light<float>(scene.data, 0, c.point, frame, uniform2(i, 50));
    ASSERT_NEAR(s.pdf, choice * cosine_hemisphere_pdf(dot(s.wi, frame.z)), 1e-6f);
    ASSERT_EQ(s.distance, std::numeric_limits<float>::infinity());
    counts.add(map.to_square(s.wi));
  }
  const DensityTest test = counts.test([&](glm::dvec2 p) {
    const float cosine = dot(glm::vec3(map.to_direction(p)), frame.z);
    return double(cosine_hemisphere_pdf(cosine)) * map.solid_angle_per_area(p);
  });
  EXPECT_GT(test.chi_square.p_value, test_significance);
}

// Cumulative distribution of these probabilities, the last value exactly 1.
std::vector<float> cumulative(const std::vector<double>& probabilities) {
  std::vector<float> cdf;
  double below = 0.0, total = 0.0;
  for (const double p : probabilities) total += p;
  for (const double p : probabilities) {
    cdf.push_back(float(below / total));
    below += p;
  }
  cdf.push_back(1.0f);
  return cdf;
}

TEST(ChooseLight, FindsTheIntervalThatHoldsU) {
  std::vector<std::vector<double>> sets = {{1.0},
                                           {0.3, 0.7},
                                           {0.0, 1.0},
                                           {1.0, 0.0},
                                           {0.2, 0.5, 0.3},
                                           {0.0, 1.0, 0.0},
                                           {0.0, 0.0, 1.0},
                                           {1.0, 0.0, 0.0, 0.0, 2.0},
                                           {}};
  for (std::uint32_t i = 0; i < 1000; ++i) {
    sets.back().push_back(i % 7 ? double(uniform3(i, 60).x) : 0.0);
  }
  for (const auto& probabilities : sets) {
    const std::vector<float> cdf = cumulative(probabilities);
    const int n = int(probabilities.size());
    const LightTable table{n, nullptr, cdf.data()};
    std::vector<float> values = {0.0f, 0x1p-24f, one_minus_epsilon};
    for (const float edge : cdf) {
      values.push_back(std::min(edge, one_minus_epsilon));
      values.push_back(std::max(0.0f, std::nextafter(edge, 0.0f)));
    }
    for (std::uint32_t i = 0; i < 1000; ++i) values.push_back(uniform3(i, 61).x);
    values.resize((values.size() + 15) / 16 * 16, 0.5f);
    std::vector<int> chosen;
    for (const float u : values) {
      const LightChoice<float> found = choose_light(table, Vec2<float>(u, one_minus_epsilon));
      const int i = found.index;
      chosen.push_back(i);
      ASSERT_TRUE(i >= 0 && i < n) << i << " of " << n;
      EXPECT_TRUE(found.u.x >= 0.0f && found.u.x < 1.0f) << "u " << u << " left " << found.u.x;
      EXPECT_TRUE(cdf[size_t(i)] <= u && u < cdf[size_t(i + 1)]) << "u " << u << " chose " << i;
      EXPECT_GT(probabilities[size_t(i)], 0.0) << "u " << u << " chose " << i;
    }
    for_each_width([&](auto width) {
      constexpr int W = width();
      for (std::size_t i = 0; i < values.size(); i += W) {
        const auto wide =
            choose_light(table, Vec2<Float<W>>(load<Float<W>>(&values[i]), Float<W>(0.3f)));
        for (int k = 0; k < W; ++k) {
          const auto one = choose_light(table, Vec2<float>(values[i + size_t(k)], 0.3f));
          EXPECT_EQ(wide.index[k], chosen[i + size_t(k)]);
          EXPECT_EQ(wide.u.x[k], one.u.x);
        }
      }
    });
  }
}

// What is left of u on lights of many probabilities, down to the single step of 2^-24 that a sample
// resolves: there u.x is always the same.
TEST(ChooseLight, WhatIsLeftOfUIsUniform) {
  constexpr float step = 0x1p-24f;
  const std::vector<float> steps = {1.0f, 2.0f, 3.0f, 17.0f, 1000.0f, 0x1p20f, 5e6f};
  std::vector<float> cdf{0.0f};
  for (const float n : steps) cdf.push_back(cdf.back() + n * step);
  cdf.push_back(1.0f);
  const LightTable table{int(steps.size()) + 1, nullptr, cdf.data()};
  for (std::size_t i = 0; i < steps.size(); ++i) {
    CellCounts counts(16, 16);
    for (std::uint32_t k = 0; k < sample_count; ++k) {
      const glm::vec3 r = uniform3(k, 90 + std::uint32_t(i));
      const float u = cdf[i] + std::min(std::floor(r.x * steps[i]), steps[i] - 1.0f) * step;
      const LightChoice<float> c = choose_light(table, Vec2<float>(u, r.y));
      ASSERT_EQ(c.index, int(i));
      counts.add(glm::dvec2(c.u));
    }
    const DensityTest test = counts.test([](glm::dvec2) { return 1.0; });
    EXPECT_GT(test.chi_square.p_value, sidak_significance(int(steps.size()))) << steps[i];
  }
}

template <int W>
void expect_same_bits_at_width(const LightScene& scene) {
  using V = Float<W>;
  const auto n = std::uint32_t(scene.data.lights.count);
  const Frame<float> frame = frame_around(normalize(glm::vec3(0.1f, 0.2f, 0.9f)));
  const Frame<V> wide_frame{splat<V>(frame.x), splat<V>(frame.y), splat<V>(frame.z)};
  for (std::uint32_t first = 0; first < 8192; first += W) {
    std::int32_t index[W];
    float u[W], v[W], point[3][W];
    for (int k = 0; k < W; ++k) {
      const std::uint32_t i = first + std::uint32_t(k);
      index[k] = std::int32_t(pcg3d(i, 2u, 3u).x % n);
      u[k] = uniform2(i, 70).x, v[k] = uniform2(i, 70).y;
      const glm::vec3 p = uniform3(i, 71) * 4.0f - 2.0f;
      for (int axis = 0; axis < 3; ++axis) point[axis][k] = p[axis];
    }
    const Int<W> at = load<Int<W>>(index);
    const Vec3<V> p(load<V>(point[0]), load<V>(point[1]), load<V>(point[2]));
    const auto wide =
        sample_light<V>(scene.data, at, p, wide_frame, Vec2<V>(load<V>(u), load<V>(v)));
    const auto wide_hit = hit_light<V>(scene.data, at, p, wide.wi, wide.distance);
    for (int k = 0; k < W; ++k) {
      const auto one = sample_light<float>(scene.data, index[k], lane(p, k), frame, {u[k], v[k]});
      const auto hit = hit_light<float>(scene.data, index[k], lane(p, k), one.wi, one.distance);
      ASSERT_TRUE(same_value(lane(wide.wi, k), one.wi)) << "W=" << W;
      ASSERT_TRUE(same_value(wide.distance[k], one.distance)) << "W=" << W;
      ASSERT_TRUE(same_value(lane(wide.radiance, k), one.radiance)) << "W=" << W;
      ASSERT_TRUE(same_value(wide.pdf[k], one.pdf)) << "W=" << W;
      ASSERT_TRUE(same_value(lane(wide_hit.radiance, k), hit.radiance)) << "W=" << W;
      ASSERT_TRUE(same_value(wide_hit.pdf[k], hit.pdf)) << "W=" << W;
    }
  }
}

TEST(Light, HasTheSameBitsAtEveryWidth) {
  auto lights = cases();
  lights.push_back({"environment", LightKind::Environment});
  const LightScene mixed(lights);
  for_each_width([&](auto width) { expect_same_bits_at_width<width()>(mixed); });
}

}  // namespace
}  // namespace lockstep
