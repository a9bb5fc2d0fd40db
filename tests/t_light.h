// Lights for tests of lights: each alone in a scene, seen from one point.
#pragma once

#include "core/light.h"
#include "tests/widths.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace lockstep::test_light {

inline constexpr std::uint32_t sample_count = 1 << 17;
inline constexpr float choice = 0.25f;  // probability of choosing the light, in every row
inline constexpr double pi_d = 3.14159265358979323846;

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

inline LightCase parallelogram(const char* name, glm::vec3 point, float side = 1.0f) {
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
inline LightCase rectangle(const char* name, glm::vec3 middle, float width, float height,
                           glm::vec3 point = glm::vec3(0.0f)) {
  const glm::vec3 x = width * normalize(glm::vec3(1.0f, -0.4f, 0.0f));
  const glm::vec3 y = height * normalize(glm::vec3(0.4f, 1.0f, 0.0f));
  return {name, LightKind::Parallelogram, middle - 0.5f * x - 0.5f * y, x, y, 0.0f, 0.0f, point,
          1.0f};
}
inline LightCase disk(const char* name, glm::vec3 point, float corners = 128.0f) {
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
inline LightCase triangle(const char* name, glm::vec3 point, float side = 1.0f) {
  return {name,
          LightKind::Triangle,
          {-1.0f, -0.5f, 2.0f},
          {0.3f, 1.5f, 0.1f},
          {2.0f, 0.0f, 0.0f},
          0.0f,
          side,
          point};
}
inline LightCase sphere(const char* name, float radius, float distance, float side) {
  const glm::vec3 direction = normalize(glm::vec3(0.5f, -0.3f, 0.7f));
  const glm::vec3 centre(0.1f, 0.2f, -0.3f);
  LightCase c{name, LightKind::Sphere, centre};
  c.radius = radius, c.side = side;
  c.point = centre + distance * direction;
  return c;
}

// Every light seen from where it shines.
inline std::vector<LightCase> cases() {
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

// What is inlined by force, once for all tests.
template <int W>
[[gnu::noinline]] LightSample<Float<W>> sample_lanes(const LightScene& scene, Int<W> light,
                                                     const Vec3<Float<W>>& point,
                                                     const Frame<Float<W>>& frame,
                                                     Vec2<Float<W>> u) {
  return sample_light<Float<W>>(scene.data, light, point, frame, u);
}
template <int W>
[[gnu::noinline]] Emitted<Float<W>> hit_lanes(const LightScene& scene, Int<W> light,
                                              const Vec3<Float<W>>& point, const Vec3<Float<W>>& wi,
                                              Float<W> distance) {
  return hit_light<Float<W>>(scene.data, light, point, wi, distance);
}

inline LightSample<float> sample_case(const LightScene& scene, const LightCase& c, Vec2<float> u) {
  return sample_lanes<1>(scene, 0, c.point, frame_around(glm::vec3(0.0f, 0.0f, 1.0f)), u);
}
inline Emitted<float> hit_case(const LightScene& scene, const LightCase& c, glm::vec3 wi,
                               float distance) {
  return hit_lanes<1>(scene, 0, c.point, wi, distance);
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

}  // namespace lockstep::test_light
