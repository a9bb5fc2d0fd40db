// RenderSettings::clamp: what it does to samples, and that it does nothing where it is not set.
#include "core/error.h"
#include "core/vec.h"
#include "tests/t_scenes.h"

#include <gtest/gtest.h>

#include <limits>

namespace lockstep::test_clamp {
namespace {

RenderSettings settings_of(std::optional<float> clamp, int spp = 1) {
  RenderSettings s;
  s.seed = 3, s.spp = spp, s.depth = 4, s.threads = 2;
  s.clamp = clamp;
  return s;
}

Scene cornell() { return build(resized(builtin::make_cornell(), 48, 40)); }

float luminance_at(const Image& image, std::size_t pixel) {
  const float* p = image.pixels.data() + 3 * pixel;
  return luminance(Vec3<float>(p[0], p[1], p[2]));
}

// With one sample per pixel the image shows the samples themselves.
TEST(Clamp, ScalesBrightSamplesAloneAndCountsThem) {
  const Scene scene = cornell();
  for (const char* sampler : {"random", "strata", "cpt"}) {
    const RenderResult free = render(scene, parse_sampler(sampler), settings_of({}));
    const RenderResult clamped = render(scene, parse_sampler(sampler), settings_of(0.3f));
    std::uint64_t above = 0;
    for (std::size_t i = 0; i < 48 * 40; ++i) {
      const float was = luminance_at(free.image, i), is = luminance_at(clamped.image, i);
      above += was > 0.3f;
      for (std::size_t c = 0; c < 3; ++c) {
        const float scale = was > 0.3f ? 0.3f / was : 1.0f;
        ASSERT_FLOAT_EQ(clamped.image.pixels[3 * i + c], scale * free.image.pixels[3 * i + c]);
      }
      ASSERT_LE(is, 0.3f * (1.0f + 4.0f * std::numeric_limits<float>::epsilon()));
    }
    EXPECT_GT(above, 20u) << "the test sees nothing";
    EXPECT_EQ(clamped.stats.clamped, above) << sampler;
    EXPECT_EQ(free.stats.clamped, 0u);
  }
}

TEST(Clamp, ThatNoSampleReachesChangesNothing) {
  const Scene scene = cornell();
  const SamplerSpec owen = parse_sampler("owen");
  const Image free = render(scene, owen, settings_of({}, 4)).image;
  const RenderResult high = render(scene, owen, settings_of(1e9f, 4));
  EXPECT_TRUE(same_bytes(high.image, free));
  EXPECT_EQ(high.stats.clamped, 0u);
}

TEST(Clamp, IsTheSameForEveryWidthAndTakesLightAway) {
  const Scene scene = cornell();
  const SamplerSpec rcs = parse_sampler("rcs:pilot=2");
  RenderSettings s = settings_of(0.5f, 8);
  s.width = 1;
  const RenderResult expected = render(scene, rcs, s);
  EXPECT_LT(mean_of(expected.image), 0.99 * mean_of(render(scene, rcs, settings_of({}, 8)).image));
  for (const int width : {4, 8, 16}) {
    s.width = width;
    const RenderResult result = render(scene, rcs, s);
    EXPECT_TRUE(same_bytes(result.image, expected.image)) << width;
    EXPECT_EQ(result.stats.clamped, expected.stats.clamped) << width;
  }
}

TEST(Clamp, OfNothingIsRefused) {
  const Scene scene = cornell();
  for (const float clamp : {0.0f, -1.0f, std::numeric_limits<float>::quiet_NaN()}) {
    EXPECT_THROW(render(scene, parse_sampler("random"), settings_of(clamp)), UsageError) << clamp;
  }
}

}  // namespace
}  // namespace lockstep::test_clamp
