// Samples that are not finite: counted, located and left out.
#include "tests/t_path.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace lockstep::test_nonfinite {
namespace {

using builtin::add_rectangle;

constexpr float infinite = std::numeric_limits<float>::infinity();
constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();

void expect_counted(SceneDescription d, const char* what) {
  const Scene scene = build(resized(std::move(d), 20, 20));
  for (const int width : {1, 4, 16}) {
    RenderSettings s;
    s.spp = 2;
    s.depth = 2;
    s.width = width;
    const RenderResult r = render(scene, parse_sampler("random"), s);
    EXPECT_GT(r.stats.nonfinite, 0u) << what;
    EXPECT_LE(r.stats.nonfinite, r.stats.paths) << what;
    ASSERT_FALSE(r.stats.bad_samples.empty()) << what;
    EXPECT_LE(r.stats.bad_samples.size(), r.stats.nonfinite);
    for (const BadSample& bad : r.stats.bad_samples) {
      EXPECT_TRUE(bad.x >= 0 && bad.x < 20 && bad.y >= 0 && bad.y < 20 && bad.sample < 2u) << what;
    }
    for (const float x : r.image.pixels) ASSERT_TRUE(std::isfinite(x)) << what;
  }
}

TEST(NonFinite, LightIsCountedWhereItIsSeenAndWhereItShines) {
  for (const float value : {infinite, not_a_number}) {
    for (const bool all_channels : {true, false}) {
      const glm::vec3 radiance(1.0f, value, all_channels ? value : 1.0f);
      const char* what = std::isnan(value) ? "NaN" : "infinity";
      SceneDescription seen;
      seen.name = "seen lamp";
      add_rectangle(seen, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, lamp(seen), Emission{radiance});
      look_closely(seen, {0, 0, 3}, {0, 0, 0});
      expect_counted(seen, what);

      SceneDescription shining = lit_floor();
      add_lamp(shining, 1, 1, 1, {radiance});
      expect_counted(shining, what);

      SceneDescription sky = lit_floor();
      sky.environment = radiance;
      expect_counted(sky, what);
      look_closely(sky, {0, 1, 0}, {0, 2, 0.1f});
      expect_counted(sky, what);
    }
  }
}

TEST(NonFinite, SamplesAreLocatedAndLeftOut) {
  // The lamp covers the middle of an image that is white elsewhere.
  SceneDescription d;
  d.name = "bad lamp";
  add_rectangle(d, {0, 0, 0}, {0.25f, 0, 0}, {0, 0.25f, 0}, lamp(d), Emission{glm::vec3(infinite)});
  d.environment = glm::vec3(1.0f);
  d.camera.camera_to_world = builtin::look_at({0, 0, 1}, {0, 0, 0});
  const Scene scene = build(resized(std::move(d), 40, 40));
  RenderSettings s;
  s.spp = 3;
  const RenderResult r = render(scene, parse_sampler("owen"), s);
  EXPECT_EQ(r.stats.nonfinite, 10u * 10u * 3u);
  for (const BadSample& bad : r.stats.bad_samples) {
    EXPECT_TRUE(bad.x >= 15 && bad.x < 25 && bad.y >= 15 && bad.y < 25);
  }
  for (int y = 0; y < 40; ++y) {
    for (int x = 0; x < 40; ++x) {
      const bool bad = x >= 15 && x < 25 && y >= 15 && y < 25;
      ASSERT_EQ(r.image.at(x, y)[0], bad ? 0.0f : 1.0f) << x << ' ' << y;
    }
  }
}

TEST(NonFinite, OrdinaryScenesHaveNone) {
  for (const BuiltinScene& builtin : builtin_scenes()) {
    const Scene scene = build(resized(builtin.make(), 64, 48));
    RenderSettings s;
    s.spp = 4;
    s.depth = 6;
    const RenderResult r = render(scene, parse_sampler("random"), s);
    EXPECT_EQ(r.stats.nonfinite, 0u) << builtin.name;
    for (const float x : r.image.pixels) ASSERT_TRUE(std::isfinite(x) && x >= 0.0f) << builtin.name;
  }
}

}  // namespace
}  // namespace lockstep::test_nonfinite
