// Triangles whose emission has a texture: chosen as lights in proportion to its mean over them, and
// the same light whichever way it is found.
#include "tests/t_square.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lockstep::test_textured_lights {
namespace {

class TexturedLights : public TestWithImages {
 protected:
  // Two by two colours, the right ones bright.
  static glm::vec3 color(int x, int y) {
    return x == 0 ? glm::vec3(0.1f, 0.2f, 0.0f) : glm::vec3(4.0f, 1.0f + 2.0f * float(y), 3.0f);
  }

  // A white square, lit from above by a smaller one.
  static SceneDescription lamp() {
    SceneDescription d = square(DiffuseMaterial{glm::vec3(1.0f)});
    d.environment.reset();
    builtin::add_material(d, DiffuseMaterial{glm::vec3(0.0f)});
    return d;
  }
  // The lamp's part from `low` to `high`, shares of its sides; it faces down.
  static void add_part(SceneDescription& d, glm::vec2 low, glm::vec2 high, Emission emission) {
    const glm::vec2 middle = low + high - 1.0f, half = high - low;
    builtin::add_rectangle(d, {0.6f * middle.x, 0.6f * middle.y, 1.2f}, {0.0f, 0.6f * half.y, 0.0f},
                           {0.6f * half.x, 0.0f, 0.0f}, 1, std::move(emission));
  }
  // Corners on the texture: u along x, v against y.
  static void add_uvs(SceneDescription& d) {
    auto& mesh = std::get<TriangleMesh>(d.shapes.back().geometry);
    for (const glm::vec3 p : mesh.positions) {
      mesh.uvs.emplace_back(0.5f + p.x / 1.2f, 0.5f - p.y / 1.2f);
    }
  }
  SceneDescription textured_lamp(bool chosen = true) const {
    SceneDescription d = lamp();
    const int texture = add_texture(d, texture_of(exr("colors", 2, 2, color)));
    add_part(d, {0, 0}, {1, 1}, Emission{textured(texture, glm::vec3(2.0f))});
    add_uvs(d);
    // What has holes is found only; these are too small to matter.
    if (!chosen) d.materials[1].opacity = FloatInput(1.0f - 0x1p-20f);
    return d;
  }
};

// Against four lamps of one colour each, at depths 1 and 2: Welch's test of the means of each
// channel, at the level of t_images.h.
TEST_F(TexturedLights, ShineAsTheirColorsWould) {
  SceneDescription parts = lamp();
  for (const int y : {0, 1}) {
    for (const int x : {0, 1}) {
      const glm::vec2 low(0.5f * float(x), 0.5f - 0.5f * float(y));
      add_part(parts, low, low + 0.5f, Emission{2.0f * color(x, y)});
    }
  }
  const Scene expected = build(parts);
  for (const bool chosen : {true, false}) {
    const Scene scene = build(textured_lamp(chosen));
    EXPECT_TRUE(scene.features() & bit(Feature::TexturedLights));
    for (const int channel : {0, 1, 2}) {
      const Plan plan{.sampler = "random", .spp = 64, .depth = 1 + channel % 2, .seeds = 32};
      const Moments a = observe(expected, plan, channel).mean;
      const Moments b = observe(scene, plan, channel).mean;
      EXPECT_GT(equal_means(a, b, 2e-5 * a.mean), level)
          << a.mean << " against " << b.mean << (chosen ? ", chosen" : ", found");
    }
  }
}

// A small lamp is found by a few rays only.
TEST_F(TexturedLights, HaveLessNoiseWhenChosen) {
  double variance[2];
  for (const bool chosen : {false, true}) {
    SceneDescription d = textured_lamp(chosen);
    for (glm::vec3& p : std::get<TriangleMesh>(d.shapes.back().geometry).positions) {
      p = {0.1f * p.x, 0.1f * p.y, p.z};
    }
    variance[chosen] = observe(build(d), {.spp = 64, .seeds = 16}).mean.variance();
  }
  EXPECT_LT(50.0 * variance[true], variance[false]);
}

// The probability of a row goes with the texture's mean luminance over the triangle.
TEST_F(TexturedLights, AreChosenByTheTexturesMean) {
  SceneDescription d = lamp();
  const int texture = add_texture(
      d,
      texture_of(exr("halves", 2, 1, [](int x, int) { return glm::vec3(x == 0 ? 0.0f : 3.0f); })));
  for (const float left : {0.0f, 0.75f}) {
    add_part(d, {left, 0.0f}, {left + 0.25f, 1.0f}, Emission{textured(texture)});
    add_uvs(d);
  }
  add_part(d, {0.25f, 0.0f}, {0.5f, 1.0f}, Emission{glm::vec3(1.0f)});
  const Scene scene = build(d);
  const LightTable& lights = scene.data().lights;
  ASSERT_EQ(lights.count, 5);
  const auto probability = [&](int light) { return lights.rows[light * light_stride + 7]; };
  EXPECT_EQ(probability(0), 0.0f) << "black";
  EXPECT_EQ(probability(1), 0.0f) << "black";
  EXPECT_NEAR(probability(2), 1.5f / 4.0f, 1e-4f);
  EXPECT_NEAR(probability(3), 1.5f / 4.0f, 1e-4f);
  EXPECT_NEAR(probability(4), 1.0f / 4.0f, 1e-4f);
}

// Scenes without such lights keep rows and features as they were.
TEST_F(TexturedLights, CostOthersNothing) {
  SceneDescription d = lamp();
  add_part(d, {0, 0}, {1, 1}, Emission{glm::vec3(1.0f)});
  const Scene scene = build(d);
  EXPECT_FALSE(scene.features() & bit(Feature::TexturedLights));
  EXPECT_EQ(scene.data().lights.count, 1);
}

}  // namespace
}  // namespace lockstep::test_textured_lights
