// Irradiance under one light against closed forms.
#include "tests/t_light.h"

#include <gtest/gtest.h>

namespace lockstep::test_light {
namespace {

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

TEST(Light, EnclosingSphereGivesIrradiancePi) {
  for (const float distance : {0.0f, 0.5f, 0.95f}) {
    const Mean m = estimate(sphere("", 1.0f, distance, -1.0f), [](const LightSample<float>& s) {
      return s.radiance.z * std::max(0.0f, s.wi.z);
    });
    EXPECT_NEAR(m.value, pi_d, 4.5 * m.sigma) << distance;
  }
}

}  // namespace
}  // namespace lockstep::test_light
