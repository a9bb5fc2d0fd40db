// Multiple importance sampling: glossy surfaces under lamps and skies, against quadrature.
#include "core/bsdf.h"
#include "tests/t_path.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

namespace lockstep::test_mis {
namespace {

using builtin::add_sphere;

// Radiance that `bsdf` sends to wo from directions within a cone about `axis`, where the radiance
// is 1; all in the local frame. A midpoint rule with steps that are finer towards the axis.
template <class Bsdf>
std::array<double, 3> quadrature(const Bsdf& bsdf, glm::dvec3 axis, glm::dvec3 wo, double cos_max,
                                 int n = 500) {
  const glm::dvec3 helper = std::abs(axis.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0);
  const glm::dvec3 a = glm::normalize(glm::cross(helper, axis)), b = glm::cross(axis, a);
  std::array<double, 3> sum{};
  for (int i = 0; i < n; ++i) {
    const double t = (i + 0.5) / n, below = (1.0 - cos_max) * t * t * t * t;  // 1 - cos
    const double z = 1.0 - below, r = std::sqrt(below * (2.0 - below));
    for (int j = 0; j < n; ++j) {
      const double phi = 2.0 * std::numbers::pi * (j + 0.5) / n;
      const glm::dvec3 w = r * std::cos(phi) * a + r * std::sin(phi) * b + z * axis;
      if (w.z <= 0.0) continue;
      const auto f = eval(bsdf, Vec3<float>(float(wo.x), float(wo.y), float(wo.z)),
                          Vec3<float>(float(w.x), float(w.y), float(w.z)));
      const double weight = t * t * t;
      sum[0] += weight * double(f.f_cos.x);
      sum[1] += weight * double(f.f_cos.y);
      sum[2] += weight * double(f.f_cos.z);
    }
  }
  for (double& s : sum) s *= 4.0 * (1.0 - cos_max) * 2.0 * std::numbers::pi / (double(n) * n);
  return sum;
}

// The floor's material by itself, as the kernels see it.
template <class F>
auto with_bsdf(const Scene& scene, const Material& material, F f) {
  if (std::holds_alternative<ConductorMaterial>(material.model)) {
    return f(load_conductor(scene.data().materials, std::int32_t(0)));
  }
  return f(load_coated(scene.data().materials, std::int32_t(0)));
}

// World axes of the floor to a local frame with z up. All materials here are isotropic.
glm::dvec3 local(glm::dvec3 v) { return glm::normalize(glm::dvec3(v.z, v.x, v.y)); }

std::vector<Material> glossy_materials() {
  std::vector<Material> list;
  for (const float alpha : {0.05f, 0.2f, 0.5f, 1.0f}) {
    ConductorMaterial metal;
    metal.alpha = glm::vec2(alpha);
    list.emplace_back(metal);
  }
  for (const bool layered : {true, false}) {
    list.emplace_back(CoatedMaterial{glm::vec3(0.5f, 0.2f, 0.0f), glm::vec3(layered ? 1.0f : 0.3f),
                                     0.1f, 1.5f, layered});
  }
  return list;
}

// The lamp stands where the floor mirrors the camera, so that both techniques matter.
TEST(Mis, GlossySurfacesUnderSphereLights) {
  const glm::vec3 eye(-3, 3, 0), centre(2, 2.2f, 0.1f);
  for (const Material& material : glossy_materials()) {
    for (const float radius : {0.02f, 0.3f, 1.5f}) {
      SceneDescription d = lit_floor(material, eye);
      add_sphere(d, centre, radius, lamp(d), Emission{glm::vec3(5.0f)});
      const Scene scene = build(std::move(d));
      const double distance = double(glm::length(centre));
      const double sin2 = double(radius * radius) / (distance * distance);
      const auto expected = with_bsdf(scene, material, [&](const auto& bsdf) {
        return quadrature(bsdf, local(centre), local(eye), std::sqrt(1.0 - sin2));
      });
      for (int c = 0; c < 3; ++c) {
        SCOPED_TRACE("material " + std::to_string(material.model.index()) + " radius " +
                     std::to_string(radius) + " channel " + std::to_string(c));
        expect_mean(channel_means(scene, {.spp = 64, .seeds = 24}, c), 5.0 * expected[size_t(c)],
                    4e-3);
      }
    }
  }
}

TEST(Mis, GlossySurfacesUnderASky) {
  const glm::vec3 eye(-3, 2, 0);
  for (const Material& material : glossy_materials()) {
    SceneDescription d = lit_floor(material, eye);
    d.environment = glm::vec3(5.0f);
    const Scene scene = build(std::move(d));
    // About the mirror direction, where the integrand has its peak.
    const auto expected = with_bsdf(scene, material, [&](const auto& bsdf) {
      return quadrature(bsdf, local(glm::vec3(3, 2, 0)), local(eye), -1.0, 1000);
    });
    for (int c = 0; c < 3; ++c) {
      SCOPED_TRACE("material " + std::to_string(material.model.index()));
      expect_mean(channel_means(scene, {.spp = 64, .seeds = 24}, c), 5.0 * expected[size_t(c)],
                  3e-3);
    }
  }
}

// Several lights of all kinds at once: the choice of light belongs to both densities.
TEST(Mis, GlossySurfacesUnderSeveralLights) {
  const glm::vec3 eye(-3, 3, 0), lamp_centre(2, 2.2f, 0.1f), other(0.5f, 2.0f, 1.5f);
  ConductorMaterial metal;
  metal.alpha = glm::vec2(0.3f);
  SceneDescription d = lit_floor(metal, eye);
  add_sphere(d, lamp_centre, 0.5f, lamp(d), Emission{glm::vec3(5.0f)});
  add_sphere(d, other, 0.4f, lamp(d), Emission{glm::vec3(20.0f)});
  const Scene scene = build(std::move(d));
  const auto part = [&](glm::vec3 centre, double radius) {
    const double distance = double(glm::length(centre));
    const double cos_max = std::sqrt(1.0 - radius * radius / (distance * distance));
    return quadrature(load_conductor(scene.data().materials, std::int32_t(0)), local(centre),
                      local(eye), cos_max)[0];
  };
  const double expected = 5.0 * part(lamp_centre, 0.5) + 20.0 * part(other, 0.4);
  for (const int depth : {1, 2}) {
    const PathPlan plan{.spp = 128, .depth = depth};
    expect_mean(channel_means(scene, plan), expected, 3e-3);
  }
}

TEST(Mis, GlossySurfacesUnderASkyAndALamp) {
  const glm::vec3 eye(-3, 3, 0), centre(2, 2.2f, 0.1f);
  ConductorMaterial metal;
  metal.alpha = glm::vec2(0.4f);
  SceneDescription d = lit_floor(metal, eye, 3);  // so that both lights are chosen often
  d.environment = glm::vec3(5.0f);
  add_sphere(d, centre, 1.0f, lamp(d), Emission{glm::vec3(60.0f)});
  const Scene scene = build(std::move(d));
  const auto part = [&](glm::vec3 axis, double cos_max) {
    return quadrature(load_conductor(scene.data().materials, std::int32_t(0)), local(axis),
                      local(eye), cos_max)[0];
  };
  const double distance = double(glm::length(centre));
  const double expected = 5.0 * part({3, 3, 0}, -1.0) +
                          (60.0 - 5.0) * part(centre, std::sqrt(1.0 - 1.0 / (distance * distance)));
  expect_mean(channel_means(scene, {.spp = 256, .seeds = 64}), expected, 2e-3);
}

// A closed room of metal and light: two sizes of tiling of the same emitting wall agree.
TEST(Mis, DoesNotDependOnHowALightIsCutUp) {
  ConductorMaterial metal;
  metal.alpha = glm::vec2(0.25f);
  std::vector<Moments> means;
  for (const bool split : {false, true}) {
    SceneDescription d = closed_box(0.5f, 0.0f, split);
    d.materials[0] = metal;
    means.push_back(channel_means(build(std::move(d)), {.spp = 16, .depth = 3, .seeds = 64}));
  }
  EXPECT_GT(equal_means(means[0], means[1], 1e-4), level) << means[0].mean << ' ' << means[1].mean;
}

}  // namespace
}  // namespace lockstep::test_mis
