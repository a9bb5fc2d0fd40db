// Direct light of every kind of lamp against closed forms; where shadow rays begin and end.
#include "tests/t_path.h"

#include <gtest/gtest.h>
#include <glm/gtc/matrix_transform.hpp>

#include <array>
#include <cmath>

namespace lockstep::test_direct_light {
namespace {

using builtin::add_rectangle;
using builtin::add_sphere;

TEST(DirectLight, OfARectangle) {
  for (const auto& [a, b, h] :
       {std::array{1.0f, 1.0f, 1.0f}, std::array{0.5f, 0.2f, 1.4f}, std::array{4.0f, 0.1f, 0.7f}}) {
    SceneDescription d = lit_floor();
    add_lamp(d, a, b, h, {glm::vec3(5.0f)});
    const Scene scene = build(std::move(d));
    ASSERT_EQ(scene.data().lights.count, 1);
    for (const int depth : {1, 2}) {  // the lamp is black: no interreflection
      expect_mean(
          channel_means(scene, {.depth = depth}),
          5.0 * double(floor_albedo) * rectangle_form_factor(double(a), double(b), double(h)),
          1e-3);
    }
  }
}

TEST(DirectLight, OfTriangles) {
  SceneDescription d = lit_floor();
  TriangleMesh fan;  // four triangles about the lamp's middle
  fan.positions = {{0, 1, 0}, {1, 1, 0.5f}, {1, 1, -0.5f}, {-1, 1, -0.5f}, {-1, 1, 0.5f}};
  fan.triangles = {{0, 1, 2}, {0, 3, 4}, {0, 2, 3}, {0, 4, 1}};
  for (auto& t : fan.triangles) std::swap(t.y, t.z);
  const int black = lamp(d);
  builtin::add_mesh(d, fan, black);
  d.shapes.back().emission = Emission{glm::vec3(5.0f), true};
  const Scene scene = build(std::move(d));
  ASSERT_EQ(scene.data().lights.count, 4);
  const double expected = 5.0 * double(floor_albedo) * rectangle_form_factor(1.0, 0.5, 1.0);
  expect_mean(channel_means(scene, {.spp = 32}), expected, 1e-3);
}

TEST(DirectLight, OfADisk) {
  for (const auto& [radius, h] : {std::array{0.5f, 1.0f}, std::array{2.0f, 1.5f}}) {
    SceneDescription d = lit_floor();
    d.shapes.push_back({Disk{{0, h, 0}, {0, -1, 0}, radius}, lamp(d), Emission{glm::vec3(5.0f)}});
    const Scene scene = build(std::move(d));
    ASSERT_EQ(scene.data().lights.count, 1);
    const double r2 = double(radius) * double(radius), h2 = double(h) * double(h);
    for (const int depth : {1, 2}) {  // 1e-3: it is a polygon of the same area
      expect_mean(channel_means(scene, {.depth = depth}),
                  5.0 * double(floor_albedo) * r2 / (r2 + h2), 1e-3);
    }
  }
}

TEST(DirectLight, OfASphere) {
  // E = pi L (R / D)^2 cos(theta) while the whole sphere is above the horizon.
  for (const auto& [x, y, radius] :
       {std::array{0.0f, 2.0f, 0.5f}, std::array{1.0f, 1.0f, 0.6f}, std::array{0.0f, 1.0f, 0.95f},
        std::array{3.0f, 4.0f, 0.01f}}) {
    SceneDescription d = lit_floor(DiffuseMaterial{glm::vec3(floor_albedo)}, {-3, 0.7f, 3});
    add_sphere(d, {x, y, 0}, radius, lamp(d), Emission{glm::vec3(5.0f)});
    const Scene scene = build(std::move(d));
    const double distance = std::hypot(double(x), double(y));
    const double expected = 5.0 * double(floor_albedo) * double(radius) * double(radius) /
                            (distance * distance) * double(y) / distance;
    for (const int depth : {1, 2})
      expect_mean(channel_means(scene, {.depth = depth}), expected, 2e-3);
  }
}

TEST(DirectLight, OfASphereFromInside) {
  SceneDescription d = lit_floor();
  add_sphere(d, {0.5f, 1, 0.2f}, 40, lamp(d), Emission{glm::vec3(5.0f)});
  std::get<Sphere>(d.shapes.back().geometry).emits_inwards = true;
  expect_mean(channel_means(build(std::move(d)), {.spp = 64}), 5.0 * double(floor_albedo), 1e-4);
}

TEST(DirectLight, OfAConstantEnvironment) {
  SceneDescription d = lit_floor();
  d.environment = glm::vec3(5.0f);
  for (const int depth : {1, 2}) {
    const PathPlan plan{.depth = depth};
    expect_mean(channel_means(build(d), plan), 5.0 * double(floor_albedo));
  }
}

TEST(DirectLight, OfSeveralLightsAddsUp) {
  SceneDescription d = lit_floor();
  add_lamp(d, 0.5f, 0.5f, 2.0f, {glm::vec3(4.0f)});
  const float side = 2.5f;
  add_sphere(d, {-side, 1.5f, 0}, 0.5f, lamp(d), Emission{glm::vec3(30.0f)});
  add_sphere(d, {0, 1.5f, -side}, 0.25f, lamp(d), Emission{glm::vec3(1.0f)});
  const Scene scene = build(std::move(d));
  ASSERT_EQ(scene.data().lights.count, 3);
  const double d2 = 2.5 * 2.5 + 1.5 * 1.5, cos_theta = 1.5 / std::sqrt(d2);
  const double expected =
      double(floor_albedo) * (4.0 * rectangle_form_factor(0.5, 0.5, 2.0) +
                              30.0 * 0.25 / d2 * cos_theta + 1.0 * 0.0625 / d2 * cos_theta);
  for (const char* sampler : {"random", "owen"}) {
    for (const int depth : {1, 2}) {
      const PathPlan plan{.sampler = sampler, .spp = 64, .depth = depth};
      expect_mean(channel_means(scene, plan), expected, 1e-3);
    }
  }
}

// A square of emission L over the floor blocks as much of the sky as it lights itself.
TEST(DirectLight, IsBlockedByWhatIsInTheWay) {
  SceneDescription d = lit_floor();
  d.environment = glm::vec3(2.0f);
  add_rectangle(d, {0, 1, 0}, {1, 0, 0}, {0, 0, 1}, lamp(d));
  const double open = 1.0 - rectangle_form_factor(1.0, 1.0, 1.0);
  expect_mean(channel_means(build(d), {.spp = 64}), 2.0 * double(floor_albedo) * open, 1e-3);
  d.shapes.back().emission = Emission{glm::vec3(2.0f)};
  expect_mean(channel_means(build(d), {.spp = 64}), 2.0 * double(floor_albedo), 1e-3);
}

// Rays leave a surface just outside the rounding error of its own coordinates: neither a scene far
// from the origin nor a camera far from the scene moves what lies close above a surface.
TEST(RayOffset, IsSmallFarFromTheOriginAndFromTheCamera) {
  const auto mean_at = [](glm::vec3 origin, float camera_distance) {
    SceneDescription d = lit_floor();
    add_lamp(d, 0.5f, 0.5f, 0.125f, {glm::vec3(5.0f)});
    for (Shape& shape : d.shapes) {
      for (glm::vec3& p : std::get<TriangleMesh>(shape.geometry).positions) p += origin;
    }
    const glm::vec3 from = glm::normalize(glm::vec3(-1.0f, 0.05f, 0.0f)) * camera_distance;
    look_closely(d, origin + from, origin);
    d.camera.fov_degrees = 0.02f / camera_distance;
    RenderSettings settings;
    settings.spp = 64;
    settings.depth = 1;
    return mean_of(render(build(std::move(d)), parse_sampler("owen"), settings).image);
  };
  const double expected = mean_at(glm::vec3(0.0f), 1.0f);
  ASSERT_GT(expected, 1.0);
  EXPECT_NEAR(mean_at(glm::vec3(8192.0f, 0.0f, 0.0f), 1.0f) / expected, 1.0, 2e-2);
  EXPECT_NEAR(mean_at(glm::vec3(0.0f, 8192.0f, 0.0f), 1.0f) / expected, 1.0, 2e-2);
  EXPECT_NEAR(mean_at(glm::vec3(0.0f), 20000.0f) / expected, 1.0, 1e-2);
}

// Points on tilted lights are rounded to coordinates off their plane: shadow rays end before it.
// Rays leave 0.005 above the floor here.
TEST(RayOffset, DoesNotHideTiltedLightsFarFromTheOrigin) {
  SceneDescription d = lit_floor();
  add_lamp(d, 0.5f, 0.5f, 1.0f, {glm::vec3(5.0f)});
  const glm::mat3 tilt(glm::rotate(glm::mat4(1.0f), 0.7f, glm::vec3(0.6f, 0.0f, 0.8f)));
  const glm::vec3 place(8000.0f, -5000.0f, 3000.0f);
  for (Shape& shape : d.shapes) {
    for (glm::vec3& p : std::get<TriangleMesh>(shape.geometry).positions) p = tilt * p + place;
  }
  look_closely(d, tilt * glm::vec3(3, 2, 1) + place, place);
  const double expected = 5.0 * double(floor_albedo) * rectangle_form_factor(0.5, 0.5, 1.0);
  expect_mean(channel_means(build(std::move(d)), {.sampler = "owen", .spp = 64}), expected, 0.012);
}

// A lamp that touches the floor beside the point in view, 2e-4 away from it.
TEST(DirectLight, OfASphereThatTouchesTheFloor) {
  SceneDescription d = lit_floor(DiffuseMaterial{glm::vec3(floor_albedo)}, {0, 0.03f, 3}, 4.0f);
  add_sphere(d, {0.02f, 1, 0}, 1.0f, lamp(d), Emission{glm::vec3(5.0f)});
  d.camera.fov_degrees = 1e-4f;
  expect_mean(channel_means(build(std::move(d)), {.spp = 64}),
              5.0 * double(floor_albedo) / std::pow(1.0004, 1.5), 5e-3);
}

}  // namespace
}  // namespace lockstep::test_direct_light
