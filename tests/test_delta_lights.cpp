// Point, spot and distant lights against the inverse square, their falloffs and the cosine. A
// single direction has no variance: one sample shows the answer.
#include "core/light_description.h"
#include "tests/t_scenes.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include <cmath>
#include <numbers>

namespace lockstep::test_delta_lights {
namespace {

constexpr float albedo = 0.6f;
constexpr double reflected = double(albedo) / std::numbers::pi;  // radiance per irradiance

// A diffuse floor in y = 0, of which the camera sees the origin.
SceneDescription floor_under(std::vector<LightSource> lights) {
  SceneDescription d;
  d.name = "floor";
  const int grey = builtin::add_material(d, DiffuseMaterial{glm::vec3(albedo)});
  builtin::add_rectangle(d, {0, 0, 0}, {0, 0, 50}, {50, 0, 0}, grey);
  look_closely(d, {3, 2, 1}, {0, 0, 0});
  d.lights = std::move(lights);
  return d;
}

double radiance(SceneDescription d, const char* sampler = "random", int spp = 1, int depth = 1) {
  RenderSettings s;
  s.spp = spp;
  s.depth = depth;
  return channel_mean(render(build(std::move(d)), parse_sampler(sampler), s).image, 0);
}

TEST(PointLight, FollowsTheInverseSquareAndTheCosine) {
  for (const glm::vec3 position :
       {glm::vec3(0, 1, 0), glm::vec3(2, 3, -1), glm::vec3(0, 1000, 1)}) {
    const double d2 = double(glm::dot(position, position));
    const double expected = 7.0 * double(position.y) / std::sqrt(d2) / d2 * reflected;
    for (const char* sampler : {"random", "cpt", "strata"}) {
      EXPECT_NEAR(radiance(floor_under({PointLight{position, glm::vec3(7.0f)}}), sampler), expected,
                  2e-4 * expected);
    }
  }
}

TEST(PointLight, UnderTheFloorLightsNothing) {
  EXPECT_EQ(radiance(floor_under({PointLight{{0, -1, 0}, glm::vec3(7.0f)}})), 0.0);
}

TEST(PointLight, CastsShadows) {
  SceneDescription d = floor_under({PointLight{{0, 2, 0}, glm::vec3(7.0f)}});
  builtin::add_rectangle(d, {0, 1, 0}, {0, 0, 0.5f}, {0.5f, 0, 0}, 0);
  EXPECT_EQ(radiance(std::move(d)), 0.0);
}

TEST(DistantLight, FollowsTheCosineFromAnyDistance) {
  const glm::vec3 direction = glm::normalize(glm::vec3(0.3f, -0.9f, 0.2f));
  const double expected = 5.0 * double(-direction.y) * reflected;
  EXPECT_NEAR(radiance(floor_under({DistantLight{direction, glm::vec3(5.0f)}})), expected,
              2e-4 * expected);
  EXPECT_EQ(radiance(floor_under({DistantLight{-direction, glm::vec3(5.0f)}})), 0.0);
}

// The light stands over the origin and looks past it by `angle`.
double through_spot(SpotLight::Falloff falloff, double inner, double outer, double angle) {
  SpotLight s;
  s.position = {0, 1, 0};
  s.direction = {float(std::sin(angle)), float(-std::cos(angle)), 0.0f};
  s.intensity = glm::vec3(7.0f);
  s.cos_inner = float(std::cos(inner)), s.cos_outer = float(std::cos(outer));
  s.falloff = falloff;
  return radiance(floor_under({s})) / (7.0 * reflected);
}

TEST(SpotLight, FallsOffAsItsKindSays) {
  using enum SpotLight::Falloff;
  const double inner = 0.3, outer = 0.7;
  for (const auto kind : {Smoothstep, Quartic, Squared, LinearAngle}) {
    EXPECT_NEAR(through_spot(kind, inner, outer, 0.0), 1.0, 1e-3);
    EXPECT_NEAR(through_spot(kind, inner, outer, 0.29), 1.0, 1e-3);
    EXPECT_EQ(through_spot(kind, inner, outer, 0.72), 0.0);
    EXPECT_EQ(through_spot(kind, inner, outer, 3.0), 0.0);
  }
  for (const double angle : {0.35, 0.5, 0.65}) {
    const double x = (std::cos(angle) - std::cos(outer)) / (std::cos(inner) - std::cos(outer));
    EXPECT_NEAR(through_spot(Smoothstep, inner, outer, angle), x * x * (3 - 2 * x), 2e-3);
    EXPECT_NEAR(through_spot(Quartic, inner, outer, angle), std::pow(x, 4.0), 2e-3);
    EXPECT_NEAR(through_spot(Squared, inner, outer, angle), x * x, 2e-3);
    EXPECT_NEAR(through_spot(LinearAngle, inner, outer, angle), (outer - angle) / (outer - inner),
                2e-3);
  }
}

TEST(SpotLight, MayHaveAHardEdge) {
  EXPECT_NEAR(through_spot(SpotLight::Falloff::Smoothstep, 0.5, 0.5, 0.49), 1.0, 1e-3);
  EXPECT_EQ(through_spot(SpotLight::Falloff::Smoothstep, 0.5, 0.5, 0.51), 0.0);
}

// Chosen with probabilities, together with a lamp that rays can hit.
TEST(DeltaLights, AddUpWithOthers) {
  SceneDescription d = floor_under(
      {PointLight{{0, 2, 0}, glm::vec3(4.0f)}, DistantLight{{0, -1, 0}, glm::vec3(2.0f)}});
  d.environment = glm::vec3(0.5f);
  // E = 4 / 2^2 + 2 + pi / 2
  const double expected = (1.0 + 2.0 + 0.5 * std::numbers::pi) * reflected;
  EXPECT_NEAR(radiance(std::move(d), "owen", 1 << 14), expected, 2e-3 * expected);
}

// No ray finds the light: glossy reflection of it is light sampling alone, at any depth.
TEST(DeltaLights, OnMetalAreTheBrdfItself) {
  SceneDescription d = floor_under({PointLight{{-3, 2, -1}, glm::vec3(7.0f)}});
  ConductorMaterial metal;
  metal.alpha = glm::vec2(0.4f);
  d.materials[0] = metal;
  const double once = radiance(d);
  EXPECT_GT(once, 0.0);
  EXPECT_NEAR(radiance(d, "random", 64, 4), once, 1e-4 * once);
}

TEST(DeltaLights, LeaveImagesTheSameAtEveryWidth) {
  SceneDescription d = floor_under(
      {PointLight{{0, 2, 0}, glm::vec3(4.0f)},
       SpotLight{
           {1, 1, 0}, {0, -1, 0}, glm::vec3(3.0f), 0.9f, 0.5f, SpotLight::Falloff::LinearAngle},
       DistantLight{{0, -1, 0}, glm::vec3(2.0f)}});
  builtin::add_sphere(d, {0, 0.5f, 0}, 0.4f, 0);
  d.camera.camera_to_world = builtin::look_at({3, 2, 1}, {0, 0, 0});
  d.camera.fov_degrees = 50.0f;
  d.film.width = d.film.height = 40;
  const Scene scene = build(std::move(d));
  RenderSettings s;
  s.spp = 4;
  s.depth = 3;
  s.width = 1;
  const Image one = render(scene, parse_sampler("random"), s).image;
  for (const int width : {4, 8, 16}) {
    s.width = width;
    EXPECT_TRUE(same_bytes(render(scene, parse_sampler("random"), s).image, one)) << width;
  }
}

}  // namespace
}  // namespace lockstep::test_delta_lights
