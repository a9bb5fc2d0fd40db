// The renderer as a whole: the same bytes for every width, thread count and lane layout; kernels
// for every instruction set.
#include "core/error.h"
#include "packets/pass.h"
#include "tests/t_cornell.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lockstep::test_packets {
namespace {

SceneDescription small(const BuiltinScene& scene) { return resized(scene.make(), 70, 50); }

class BuiltinScenes : public testing::TestWithParam<std::size_t> {};

TEST_P(BuiltinScenes, GiveTheSameBytesForEveryWidthLayoutAndThreadCount) {
  const BuiltinScene& builtin = builtin_scenes()[GetParam()];
  const int threads[] = {1, 2, 7};
  for (const Isa isa : available_isas()) {
    const Scene scene = build(small(builtin), isa);
    for (const char* sampler : all_kinds_of_samplers) {
      const SamplerSpec spec = parse_sampler(sampler);
      RenderSettings s = small_render(3);
      s.isa = isa;
      s.width = 1;
      s.threads = 1;
      const RenderResult expected = render(scene, spec, s);
      int n = 0;
      for (const int width : {1, 4, 8, 16}) {
        for (const char* layout : {"4x4x1", "2x2x4", "1x1x16", "8x2x1", "16x16x1"}) {
          s.width = width;
          s.threads = threads[n++ % 3];
          s.lanes = parse_lane_layout(layout);
          const RenderResult result = render(scene, spec, s);
          EXPECT_TRUE(same_bytes(result.image, expected.image))
              << name(isa) << ' ' << sampler << " width " << width << " lanes " << layout
              << " threads " << s.threads;
          EXPECT_EQ(result.stats.rays.bounce, expected.stats.rays.bounce);
          EXPECT_EQ(result.stats.rays.shadow, expected.stats.rays.shadow);
          EXPECT_EQ(result.weights.has_value(), expected.weights.has_value());
          if (result.weights) {
            EXPECT_TRUE(same_bytes(*result.weights, *expected.weights));
          }
        }
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, BuiltinScenes,
                         testing::Range<std::size_t>(0, builtin_scenes().size()),
                         [](const auto& p) { return std::string(builtin_scenes()[p.param].name); });

// Passes of 64 samples, long enough for the policy to try one layout against another.
TEST(Render, MeasuredLayoutsGiveTheBytesOfAFixedOne) {
  const Scene scene = small_cornell();
  for (const char* sampler : {"owen", "rcs"}) {
    const SamplerSpec spec = parse_sampler(sampler);
    RenderSettings s = small_render(64);
    s.lanes = LaneLayout{4, 4, 1};
    const Image expected = render(scene, spec, s).image;
    s.lanes.reset();
    for (const int threads : {1, 2, 7}) {
      s.threads = threads;
      EXPECT_TRUE(same_bytes(render(scene, spec, s).image, expected)) << sampler << ' ' << threads;
    }
  }
}

// Guards the test above.
TEST(Render, SixtyFourSamplesAreEnoughToTryLayouts) {
  const Scene scene = small_cornell();
  const SamplerState sampler;
  const Kernel& kernel = find_kernel(choose_isa(), 0);
  Workers workers(TraversalPolicy({}, kernel.width), LayoutPolicy({}));
  Pass pass;
  pass.kernel = &kernel, pass.scene = &scene.data(), pass.sampler = &sampler;
  pass.workers = &workers;
  pass.samples = 64;
  Film film(70, 50);
  PassTotals totals;
  EXPECT_TRUE(run_pass(pass, film, totals, [](double) { return true; }));
  std::uint64_t paths = 0;
  for (const LayoutCount& layout : totals.counts.layouts) paths += layout.paths;
  EXPECT_EQ(paths, 70u * 50u * 64u);
  EXPECT_EQ(totals.counts.layouts[0].lanes, (LaneLayout{4, 4, 1}));
  EXPECT_GT(totals.counts.layouts[1].paths, 0u);
}

TEST(Render, EverySettingThatIsPartOfTheImageChangesIt) {
  const Scene scene = small_cornell();
  const RenderSettings s = small_render(2);
  const Image base = render(scene, parse_sampler("random"), s).image;
  RenderSettings other = s;
  other.seed = 12;
  EXPECT_FALSE(same_bytes(render(scene, parse_sampler("random"), other).image, base));
  other = s;
  other.depth = 3;
  EXPECT_FALSE(same_bytes(render(scene, parse_sampler("random"), other).image, base));
  other = s;
  other.roulette_depth = 9;
  EXPECT_FALSE(same_bytes(render(scene, parse_sampler("random"), other).image, base));
  EXPECT_FALSE(same_bytes(render(scene, parse_sampler("owen"), s).image, base));
}

TEST(Render, ImagesSmallerThanATileWork) {
  for (const auto& [width, height] : {std::pair{1, 1}, {1, 40}, {40, 1}, {3, 2}}) {
    const Scene scene = build(resized(builtin::make_cornell(), width, height));
    RenderSettings s = small_render(3);
    s.width = 1;
    const Image one = render(scene, parse_sampler("rcs"), s).image;
    EXPECT_EQ(one.width, width);
    EXPECT_EQ(one.height, height);
    for (const char* layout : {"4x4x1", "1x1x16"}) {
      s.width = 16;
      s.lanes = parse_lane_layout(layout);
      EXPECT_TRUE(same_bytes(render(scene, parse_sampler("rcs"), s).image, one));
    }
  }
}

// A pixel's samples are numbered from 0: fewer of them are the first of more.
TEST(Render, SamplesAddUp) {
  const Scene scene = small_cornell();
  const SamplerSpec owen = parse_sampler("owen");
  const Image one = render(scene, owen, small_render(1)).image;
  const Image two = render(scene, owen, small_render(2)).image;
  std::size_t darker = 0;  // where the mean of two is below half the first, the second is negative
  for (std::size_t i = 0; i < one.pixels.size(); ++i) {
    darker += two.pixels[i] < 0.5f * one.pixels[i] * (1.0f - 1e-6f);
  }
  EXPECT_EQ(darker, 0u);
}

TEST(LaneLayout, IsParsedOrRefused) {
  const LaneLayout lanes = parse_lane_layout("2x4x8");
  EXPECT_EQ(lanes.x, 2);
  EXPECT_EQ(lanes.y, 4);
  EXPECT_EQ(lanes.samples, 8);
  EXPECT_EQ(to_string(lanes), "2x4x8");
  for (const char* text : {"", "auto", "4", "4x4", "4x4x", "x4x1", "3x4x1", "4x4x1x1", "32x1x1",
                           "-4x4x1", "0x4x1", "16x16x2", "1x1x512", "4X4X1", "axbxc"}) {
    EXPECT_THROW(parse_lane_layout(text), UsageError) << text;
  }
}

TEST(Kernels, ExistForEveryInstructionSetAndWidth) {
  const std::vector<Isa> isas = available_isas();
  ASSERT_FALSE(isas.empty());
  for (const Isa isa : isas) {
    EXPECT_EQ(choose_isa(name(isa)), isa);
    RenderSettings s = small_render(1);
    s.isa = isa;
    const Scene scene = build(resized(builtin::make_cornell(), 8, 8), isa);
    EXPECT_EQ(render(scene, parse_sampler("random"), s).stats.width, default_width(isa));
  }
  EXPECT_THROW(choose_isa("mmx"), UsageError);
}

// Hits may differ between instruction sets, at edges and in the last bits; the picture does not.
TEST(Kernels, InstructionSetsAgreeOnTheImage) {
  std::vector<Image> images;
  for (const Isa isa : available_isas()) {
    const Scene scene = build(resized(builtin::make_cornell(), 70, 50), isa);
    RenderSettings s = small_render(16);
    s.isa = isa;
    images.push_back(render(scene, parse_sampler("owen"), s).image);
  }
  for (const Image& image : images) {
    EXPECT_NEAR(mean_of(image), mean_of(images[0]), 2e-3 * mean_of(images[0]));
    std::size_t near = 0;
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
      near += std::abs(image.pixels[i] - images[0].pixels[i]) <= 1e-3f * images[0].pixels[i];
    }
    EXPECT_GT(double(near), 0.9 * double(image.pixels.size()));
  }
}

}  // namespace
}  // namespace lockstep::test_packets
