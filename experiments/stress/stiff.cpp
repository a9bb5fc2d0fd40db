// Light that one way of sampling finds easily and another hardly ever.
#include "core/bsdf/metal.h"
#include "core/scene.h"
#include "experiments/stress/parts.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <cmath>

namespace lockstep::stress {
namespace {

using builtin::add_material;
using builtin::add_rectangle;
using builtin::add_sphere;

// A sphere light in the mirror direction of a metal floor, after Veach 1997, fig. 9.2. The metal
// reflects all.
struct Mirrored {
  float alpha;   // of the floor
  float radius;  // of the light, at distance 1
  float radiance;
};

MetalBsdf<float> metal_of(const Mirrored& m) {
  return {{Vec3<float>(0.0f), Vec3<float>(1.0f), {Vec2<float>(m.alpha)}}, Vec3<float>(1.0f), 0.0f};
}

constexpr double kSine = 0.70710678118654752;  // of the view's angle: 45 degrees

SceneDescription scene_of(const Mirrored& m) {
  SceneDescription scene;
  scene.name = "mirrored light";
  ConductorMaterial metal;
  metal.eta = glm::vec3(0.0f);
  metal.k = glm::vec3(1.0f);
  metal.alpha = glm::vec2(m.alpha);
  add_rectangle(scene, {0, 0, 0}, {0, 0, 1}, {1, 0, 0}, add_material(scene, metal));
  const auto s = float(kSine);
  add_sphere(scene, {s, s, 0}, m.radius, black(scene), Emission{glm::vec3(m.radiance)});
  look_straight(scene, {-s, s, 0}, {0, 0, 0}, 1e-5f);
  return scene;
}

// Integrals over the cone that the light fills: what arrives, and the second moments of its
// estimate by light sampling, BSDF sampling, and both by the power heuristic (Veach 1997, section
// 9.2). Midpoint rule, finer towards the axis.
struct Estimates {
  double mean = 0.0, light = 0.0, bsdf = 0.0;

  double variance_of_better() const { return std::min(light, bsdf) - mean * mean; }
};

Estimates estimates_of(const Mirrored& m) {
  constexpr int rings = 1200, sectors = 64;
  const MetalBsdf<float> metal = metal_of(m);
  const Vec3<float> wo(-float(kSine), 0.0f, float(kSine));
  const glm::dvec3 axis(kSine, 0.0, kSine), across(kSine, 0.0, -kSine), up(0.0, 1.0, 0.0);
  const double largest = std::asin(double(m.radius));
  const double solid_angle = 2.0 * pi_double * 2.0 * std::pow(std::sin(0.5 * largest), 2.0);
  Estimates e;
  for (int i = 0; i < rings; ++i) {
    const double t = (i + 0.5) / rings, theta = largest * t * t;
    const double ring = std::sin(theta) * largest * 2.0 * t / rings * 2.0 * pi_double / sectors;
    for (int j = 0; j < sectors; ++j) {
      const double phi = 2.0 * pi_double * (j + 0.5) / sectors, s = std::sin(theta);
      const glm::dvec3 wi =
          s * (std::cos(phi) * across + std::sin(phi) * up) + std::cos(theta) * axis;
      const auto v = eval(metal, wo, Vec3<float>(wi));
      const double f = double(v.f_cos.x) * double(m.radiance), pdf = double(v.pdf);
      e.mean += f * ring;
      e.light += f * f * solid_angle * ring;
      if (pdf > 0.0) e.bsdf += f * f / pdf * ring;
    }
  }
  return e;
}

std::string text_of(const Mirrored& m) {
  return fmt::format("metal of roughness {:.0e}, a light of radius {:.0e}", m.alpha, m.radius);
}

StressCase mean_of_mirrored(const char* name, const Mirrored& m) {
  return {name, "stiff", text_of(m), "quadrature over the light in double precision",
          StressScene{.make = [m](const std::string&) { return scene_of(m); },
                      .expected = estimates_of(m).mean,
                      .rounding = 1e-2,
                      .spp = 64}};
}

// Variance of single samples: pixels of 32 renders.
StressCase variance_of_mirrored(const char* name, const Mirrored& m) {
  const auto run = [m](const StressSetting& setting) {
    const Scene scene(scene_of(m), embree_isa(choose_isa()));
    RenderSettings s;
    s.spp = 1, s.depth = 1, s.threads = 1, s.width = setting.width;
    const Estimates e = estimates_of(m);
    double squares = 0.0, n = 0.0;
    for (s.seed = 0; s.seed < 32; ++s.seed) {
      const Image image = render(scene, parse_sampler("random"), s).image;
      for (std::size_t i = 0; i < image.pixels.size(); i += 3, n += 1.0) {
        squares += std::pow(double(image.pixels[i]) - e.mean, 2.0);
      }
    }
    return StressFinding{
        .expected = 2.0, .got = squares / n / e.variance_of_better(), .at_most = true};
  };
  return {name, "stiff", "variance: " + text_of(m),
          "both techniques together have at most twice the variance of the better one alone",
          StressComputation{run, true, false}};
}

std::vector<StressCase> mirrored() {
  const Mirrored both{1e-3f, 1e-3f, 1.0f}, rough{0.3f, 1e-3f, 1e6f}, large{1e-3f, 0.3f, 1.0f},
      middle{0.05f, 0.05f, 1.0f};
  return {mean_of_mirrored("mis-sharp-small", both),
          mean_of_mirrored("mis-rough-small", rough),
          mean_of_mirrored("mis-sharp-large", large),
          variance_of_mirrored("mis-variance-sharp-small", both),
          variance_of_mirrored("mis-variance-rough-small", rough),
          variance_of_mirrored("mis-variance-middle", middle)};
}

// Light through glass, which only chance finds
// -----------------------------------------------------

// What a point under a sheet of index eta gets from a square lamp of half size a at height h, of
// the lamp's radiance: the midpoint rule over the lamp, each way dimmed by the sheet's
// transmittance (1 - R) / (1 + R).
double through_sheet(double a, double h, double eta) {
  constexpr int steps = 400;
  double sum = 0.0;
  for (int i = 0; i < steps; ++i) {
    for (int j = 0; j < steps; ++j) {
      const double x = a * (2.0 * (i + 0.5) / steps - 1.0), y = a * (2.0 * (j + 0.5) / steps - 1.0);
      const double d2 = x * x + y * y + h * h, cosine = h / std::sqrt(d2);
      const double cos_t = std::sqrt(1.0 - (1.0 - cosine * cosine) / (eta * eta));
      const double s = (cosine - eta * cos_t) / (cosine + eta * cos_t);
      const double p = (eta * cosine - cos_t) / (eta * cosine + cos_t);
      const double r = 0.5 * (s * s + p * p);
      sum += cosine * cosine / d2 * (1.0 - r) / (1.0 + r);
    }
  }
  return sum * 4.0 * a * a / double(steps) / double(steps) / pi_double;
}

// Most paths miss the lamp, those that do not are bright.
StressCase through_window(float half_size, int spp) {
  const double share = through_sheet(double(half_size), 1.0, 1.5);
  const auto radiance = float(1.0 / (double(floor_albedo) * share));
  const auto make = [=](const std::string&) {
    SceneDescription scene = lit_floor();
    DielectricMaterial sheet;
    sheet.thin = true;
    add_rectangle(scene, {0, 0.5f, 0}, {0, 0, 9}, {9, 0, 0}, add_material(scene, sheet));
    add_lamp(scene, half_size, half_size, 1.0f, glm::vec3(radiance));
    look_straight(scene, {0.3f, 0.4f, 0.1f}, {0, 0, 0}, 1e-3f);
    return scene;
  };
  return {fmt::format("caustic-{:.1f}", half_size), "stiff",
          fmt::format("a lamp of half size {:.1f} behind a smooth pane, found by chance alone",
                      half_size),
          "quadrature over the lamp with Fresnel's transmittance; fireflies are kept and counted",
          StressScene{.make = make, .rounding = 2e-3, .spp = spp, .depth = 2}};
}

// A sphere light whose texture keeps it from being sampled: found by chance alone.
StressCase textured_lamp() {
  constexpr double radius = 0.2, radiance = 20.0;
  const auto make = [](const std::string&) {
    SceneDescription scene = lit_floor();
    CheckerboardTexture constant;
    constant.odd = constant.even;
    scene.textures.emplace_back(constant);
    add_sphere(scene, {0, 1, 0}, float(radius), black(scene), Emission{glm::vec3(float(radiance))});
    scene.shapes.back().emission->radiance.texture = 0;
    return scene;
  };
  return {"lamp-found-by-chance", "stiff", "a small lamp that is never sampled, only hit",
          "irradiance of a sphere wholly above the horizon",
          StressScene{.make = make,
                      .expected = radiance * double(floor_albedo) * radius * radius,
                      .rounding = 2e-3,
                      .spp = 256}};
}

}  // namespace

std::vector<StressCase> stiff_cases() {
  std::vector<StressCase> cases = mirrored();
  cases.push_back(through_window(0.5f, 64));
  cases.push_back(through_window(0.2f, 256));
  cases.push_back(textured_lamp());
  return cases;
}

}  // namespace lockstep::stress
