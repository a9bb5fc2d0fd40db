// Lamps as the renderer sees them: how often they are chosen, and the side that they shine from.
#include "tests/t_path.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace lockstep::test_lamps {
namespace {

using builtin::add_rectangle;
using builtin::add_sphere;

// What a light's row says is the probability with which samples of 24 bits choose it.
TEST(Lights, AreChosenWithTheProbabilityTheyState) {
  SceneDescription d = lit_floor();
  for (int i = 0; i < 300; ++i) {
    add_sphere(d, {float(i), 3.0f, 0.0f}, 0.1f, lamp(d),
               Emission{glm::vec3(i == 7 ? 1e-9f : 1.0f)});
  }
  const Scene scene = build(std::move(d));
  const LightTable& lights = scene.data().lights;
  ASSERT_EQ(lights.count, 300);
  for (int i = 0; i < lights.count; ++i) {
    const float probability = lights.rows[i * light_stride + 7];
    EXPECT_EQ(probability, lights.cdf[i + 1] - lights.cdf[i]);
    EXPECT_GE(probability, 0x1p-24f) << "a light that shines must be found";
    EXPECT_EQ(lights.cdf[i] * 0x1p24f, std::floor(lights.cdf[i] * 0x1p24f));
  }
}

// An ellipse of 20 triangles; `moved` is the way that one corner is put out of place.
TriangleMesh ellipse(float moved) {
  TriangleMesh fan;
  fan.positions.emplace_back(0.1f, 1.0f, 0.2f);
  for (unsigned i = 0; i < 20; ++i) {
    const float a = float(i) * 0.1f * std::numbers::pi_v<float>;
    fan.positions.push_back(fan.positions[0] + std::cos(a) * glm::vec3(1.0f, 0.2f, 0.0f) -
                            std::sin(a) * glm::vec3(0.3f, 0.1f, 2.0f));
    fan.triangles.emplace_back(0u, 1u + i, 1u + (i + 1u) % 20u);
  }
  fan.positions[5].y += moved;
  return fan;
}

TEST(Lights, AFanThatIsADiskIsOneLight) {
  for (const bool disk : {true, false}) {
    SceneDescription d = lit_floor();
    const TriangleMesh fan = ellipse(disk ? 0.0f : 0.01f);
    builtin::add_mesh(d, fan, lamp(d));
    d.shapes.back().emission = Emission{glm::vec3(5.0f)};
    const Scene scene = build(std::move(d));
    const LightTable& lights = scene.data().lights;
    ASSERT_EQ(lights.count, disk ? 1 : 20);
    if (!disk) continue;
    float area = 0.0f;
    for (const glm::uvec3 t : fan.triangles) {
      const glm::vec3 p = fan.positions[t.x];
      area += 0.5f * glm::length(glm::cross(fan.positions[t.y] - p, fan.positions[t.z] - p));
    }
    EXPECT_NEAR(lights.rows[3], area, 1e-5f * area);
    EXPECT_EQ(lights.rows[15], float(int(LightKind::Disk)));
  }
}

TEST(Emission, LeavesOneSideOnly) {
  SceneDescription d = lit_floor();
  add_rectangle(d, {0, 1, 0}, {0, 0, 1}, {1, 0, 0}, lamp(d), Emission{glm::vec3(5.0f)});  // up
  for (const int depth : {1, 3}) {
    EXPECT_EQ(channel_means(build(d), {.depth = depth, .seeds = 2}).mean, 0.0);
  }
  d.shapes.back().emission->two_sided = true;
  expect_mean(channel_means(build(d), {}),
              5.0 * double(floor_albedo) * rectangle_form_factor(1, 1, 1), 1e-3);
}

TEST(Emission, IsSeenDirectlyFromItsSide) {
  for (const bool two_sided : {false, true}) {
    SceneDescription d;
    d.name = "lamp";
    add_rectangle(d, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, lamp(d),
                  Emission{glm::vec3(5.0f, 2.0f, 0.0f), two_sided});
    look_closely(d, {0.1f, 0, 3}, {0.2f, 0.1f, 0});
    const Scene front = build(d);
    EXPECT_FLOAT_EQ(float(channel_means(front, {.seeds = 1}, 0).mean), 5.0f);
    EXPECT_FLOAT_EQ(float(channel_means(front, {.seeds = 1}, 1).mean), 2.0f);
    look_closely(d, {0.1f, 0, -3}, {0.2f, 0.1f, 0});
    EXPECT_FLOAT_EQ(float(channel_means(build(d), {.seeds = 1}, 0).mean), two_sided ? 5.0f : 0.0f);
  }
  for (const bool inwards : {false, true}) {
    SceneDescription d;
    d.name = "bulb";
    add_sphere(d, {0, 0, 0}, 1, lamp(d), Emission{glm::vec3(5.0f)});
    std::get<Sphere>(d.shapes[0].geometry).emits_inwards = inwards;
    look_closely(d, {0, 0, 3}, {0, 0, 0});
    EXPECT_FLOAT_EQ(float(channel_means(build(d), {.seeds = 1}).mean), inwards ? 0.0f : 5.0f);
    look_closely(d, {0, 0, 0.5f}, {0, 1, 0});
    EXPECT_FLOAT_EQ(float(channel_means(build(d), {.seeds = 1}).mean), inwards ? 5.0f : 0.0f);
  }
}

}  // namespace
}  // namespace lockstep::test_lamps
