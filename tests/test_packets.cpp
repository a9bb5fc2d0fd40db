// The renderer as a whole: the same bytes for every width, thread count, lane layout and resume
// point; what it counts; how it stops.
#include "core/error.h"
#include "packets/pass.h"
#include "tests/t_scenes.h"

#include <gtest/gtest.h>

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

namespace lockstep {
namespace {

const char* const samplers[] = {"random", "owen", "cpt", "rcs", "rcs:offset=fresh"};

// 70 x 50 pixels: the last tiles are cut on both sides, to sizes that no lane layout divides.
SceneDescription small(const BuiltinScene& scene) { return resized(scene.make(), 70, 50); }

Scene small_cornell() { return build(resized(builtin::make_cornell(), 70, 50)); }

RenderSettings settings_of(int spp, int depth = 4) {
  RenderSettings s;
  s.seed = 11;
  s.spp = spp;
  s.depth = depth;
  s.roulette_depth = 2;
  s.threads = 2;
  return s;
}

class BuiltinScenes : public testing::TestWithParam<std::size_t> {};

TEST_P(BuiltinScenes, GiveTheSameBytesForEveryWidthLayoutAndThreadCount) {
  const BuiltinScene& builtin = builtin_scenes()[GetParam()];
  const int threads[] = {1, 2, 7};
  for (const Isa isa : available_isas()) {
    const Scene scene = build(small(builtin), isa);
    for (const char* sampler : samplers) {
      const SamplerSpec spec = parse_sampler(sampler);
      RenderSettings s = settings_of(3);
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
    RenderSettings s = settings_of(64);
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
  const RenderSettings s = settings_of(2);
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
    RenderSettings s = settings_of(3);
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
  const Image one = render(scene, owen, settings_of(1)).image;
  const Image two = render(scene, owen, settings_of(2)).image;
  std::size_t darker = 0;  // where the mean of two is below half the first, the second is negative
  for (std::size_t i = 0; i < one.pixels.size(); ++i) {
    darker += two.pixels[i] < 0.5f * one.pixels[i] * (1.0f - 1e-6f);
  }
  EXPECT_EQ(darker, 0u);
}

// Statistics ------------------------------------------------------------------------------------

TEST(RenderStats, CountWhatWasTraced) {
  const Scene scene = small_cornell();
  for (const char* sampler : samplers) {
    for (const int width : {1, 4, 8, 16}) {
      RenderSettings s = settings_of(6);
      s.width = width;
      if (width == 1) s.traversal = TraversalMode{Packets::Single, false};
      const RenderResult r = render(scene, parse_sampler(sampler), s);
      EXPECT_EQ(r.stats.paths, 70u * 50u * 6u);
      EXPECT_EQ(r.stats.rays.camera, r.stats.paths);
      EXPECT_GT(r.stats.rays.bounce, 0u);
      EXPECT_LE(r.stats.rays.bounce, 4u * r.stats.paths);
      EXPECT_GT(r.stats.rays.shadow, 0u);
      EXPECT_LE(r.stats.rays.shadow, 4u * r.stats.paths);
      EXPECT_GT(r.stats.lanes_active, 0.5);
      EXPECT_LE(r.stats.lanes_active, 1.0);
      const RayCounts& rays = r.stats.rays;
      if (width == 1) {
        EXPECT_EQ(r.stats.lanes_active, 1.0);
        EXPECT_EQ(r.stats.packets, rays.camera + rays.bounce + rays.shadow);
      } else {
        EXPECT_LT(r.stats.packets, rays.camera + rays.bounce + rays.shadow);
      }
      EXPECT_EQ(r.stats.width, width);
      EXPECT_EQ(r.stats.threads, 2);
      EXPECT_EQ(r.stats.spp, 6);
      EXPECT_EQ(r.stats.nonfinite, 0u);
      EXPECT_TRUE(r.stats.bad_samples.empty());
      EXPECT_GT(r.stats.cpu_seconds, 0.0);
      EXPECT_GT(r.stats.wall_seconds, 0.0);
    }
  }
}

TEST(RenderStats, DirectLightOnDiffuseSurfacesNeedsNoBounces) {
  const RenderResult r = render(small_cornell(), parse_sampler("random"), settings_of(2, 1));
  EXPECT_EQ(r.stats.rays.bounce, 0u);
  EXPECT_LE(r.stats.rays.shadow, r.stats.paths);
}

TEST(RenderStats, PilotAndWeightsAreReported) {
  const Scene scene = small_cornell();
  const auto pilot = [&](const char* sampler, int spp) {
    return render(scene, parse_sampler(sampler), settings_of(spp)).stats.pilot_spp;
  };
  EXPECT_EQ(pilot("random", 8), 0);
  EXPECT_EQ(pilot("rcs:weight=0.5", 8), 0);
  EXPECT_EQ(pilot("rcs", 8), 2);
  EXPECT_EQ(pilot("rcs", 3), 1);
  EXPECT_EQ(pilot("rcs:pilot=5", 8), 5);
  EXPECT_EQ(pilot("rcs:pilot=5", 4), 4);

  const RenderResult rcs = render(scene, parse_sampler("rcs"), settings_of(8));
  ASSERT_TRUE(rcs.weights);
  EXPECT_EQ(rcs.weights->width, 70);
  EXPECT_EQ(rcs.weights->height, 50);
  EXPECT_EQ(rcs.weights->channels, 1);
  double sum = 0.0;
  for (const float w : rcs.weights->pixels) {
    ASSERT_TRUE(w >= 0.0f && w <= 1.0f);
    sum += double(w);
  }
  EXPECT_DOUBLE_EQ(rcs.stats.mean_weight, sum / 3500.0);
  EXPECT_EQ(rcs.stats.spp, 8);
  EXPECT_EQ(rcs.stats.paths, 3500u * 8u);

  const RenderResult random = render(scene, parse_sampler("random"), settings_of(1));
  EXPECT_FALSE(random.weights);
  EXPECT_EQ(random.stats.mean_weight, 1.0);
  EXPECT_EQ(random.stats.zero_weights, 0.0);
  const auto zeros = std::count(rcs.weights->pixels.begin(), rcs.weights->pixels.end(), 0.0f);
  EXPECT_DOUBLE_EQ(rcs.stats.zero_weights, double(zeros) / 3500.0);
  EXPECT_EQ(render(scene, parse_sampler("cpt"), settings_of(1)).stats.zero_weights, 1.0);
  EXPECT_EQ(render(scene, parse_sampler("cpt"), settings_of(1)).stats.mean_weight, 0.0);
  const SamplerSpec quarter = parse_sampler("rcs:weight=0.25");
  EXPECT_EQ(render(scene, quarter, settings_of(1)).stats.mean_weight, 0.25);
}

// c = 0 keeps every pixel on the shared sequence, as cpt is.
TEST(Render, PilotAndImageAreAddedBySampleCounts) {
  const Scene scene = small_cornell();
  const Image all = render(scene, parse_sampler("rcs:c=0,pilot=2"), settings_of(8)).image;
  const Image pilot = render(scene, parse_sampler("rcs:pilot=2"), settings_of(2)).image;
  const Image coherent = render(scene, parse_sampler("cpt"), settings_of(6)).image;
  for (std::size_t i = 0; i < all.pixels.size(); ++i) {
    const double expected =
        (2.0 * double(pilot.pixels[i]) + 6.0 * double(coherent.pixels[i])) / 8.0;
    ASSERT_NEAR(double(all.pixels[i]), expected, 1e-5 * (1.0 + expected));
  }
}

TEST(Render, CombineByWeightInterpolates) {
  const Scene scene = small_cornell();
  const RenderResult r =
      render(scene, parse_sampler("rcs:c=0,pilot=2,combine=weight"), settings_of(8));
  EXPECT_TRUE(same_bytes(r.image, render(scene, parse_sampler("cpt"), settings_of(6)).image));
  // From t = 0 and a huge c on, w = 1 wherever neighbours differ at all.
  const RenderResult full =
      render(scene, parse_sampler("rcs:c=1e9,t=0,pilot=2,combine=weight"), settings_of(8));
  const Image pilot = render(scene, parse_sampler("rcs:pilot=2"), settings_of(2)).image;
  for (int y = 0; y < 50; ++y) {
    for (int x = 0; x < 70; ++x) {
      if (*full.weights->at(x, y) == 1.0f) {
        ASSERT_EQ(full.image.at(x, y)[0], pilot.at(x, y)[0]);
      }
    }
  }
}

// Were R's keys C's, R would be the image that C's sequence gives where no pixel shares it.
TEST(Render, ThePilotHasKeysOfItsOwn) {
  const Scene scene = small_cornell();
  for (const auto& [pilot, image] :
       {std::pair{"rcs:pilot=2", "owen"}, {"rcs:pilot=2,sequence=random", "random"}}) {
    const Image a = render(scene, parse_sampler(pilot), settings_of(2)).image;
    const Image b = render(scene, parse_sampler(image), settings_of(2)).image;
    std::size_t lit = 0, equal = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
      if (b.pixels[i] <= 0.0f || b.pixels[i] > 10.0f) continue;  // black, or the lamp itself
      ++lit;
      equal += a.pixels[i] == b.pixels[i];
    }
    EXPECT_GT(lit, 5000u);
    EXPECT_LT(double(equal), 0.001 * double(lit)) << image;
  }
}

// Resuming --------------------------------------------------------------------------------------

class Resume : public testing::Test {
 protected:
  void SetUp() override {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    file_ = std::filesystem::temp_directory_path() /
            ("lockstep-test-" + std::string(info->name()) + "-" + std::to_string(getpid()));
    std::filesystem::remove(file_);
  }
  void TearDown() override { std::filesystem::remove(file_); }

  RenderSettings resuming(int spp) const {
    RenderSettings s = settings_of(spp);
    s.resume_file = file_;
    return s;
  }
  // The error with which a render from the file fails; empty where it does not.
  std::string refusal(const Scene& scene, const char* sampler, const RenderSettings& s) {
    try {
      render(scene, parse_sampler(sampler), s);
    } catch (const Error& error) {
      return error.what();
    }
    return {};
  }

  std::string file_;
};

TEST_F(Resume, TwoHalvesAreOneRender) {
  const Scene scene = small_cornell();
  for (const char* sampler : {"owen", "random", "cpt", "rcs:pilot=2", "rcs:pilot=2,combine=weight",
                              "rcs:weight=0.3,offset=fresh"}) {
    std::filesystem::remove(file_);
    const SamplerSpec spec = parse_sampler(sampler);
    const RenderResult half = render(scene, spec, resuming(4));
    EXPECT_TRUE(same_bytes(half.image, render(scene, spec, settings_of(4)).image)) << sampler;
    RenderSettings rest = resuming(8);
    rest.width = 4;  // neither width nor threads are part of the image
    rest.threads = 1;
    const RenderResult whole = render(scene, spec, rest);
    EXPECT_TRUE(same_bytes(whole.image, render(scene, spec, settings_of(8)).image)) << sampler;
    EXPECT_EQ(whole.stats.spp, 8);
    EXPECT_EQ(whole.stats.paths, 3500u * 8u) << "what both runs traced";
    EXPECT_GT(whole.stats.cpu_seconds, half.stats.cpu_seconds);
  }
}

TEST_F(Resume, AFinishedRenderIsNotDoneAgain) {
  const Scene scene = small_cornell();
  const Image image = render(scene, parse_sampler("owen"), resuming(4)).image;
  const RenderResult again = render(scene, parse_sampler("owen"), resuming(4));
  EXPECT_TRUE(same_bytes(again.image, image));
  EXPECT_EQ(again.stats.paths, 3500u * 4u);
  EXPECT_EQ(again.stats.spp, 4);
}

TEST_F(Resume, OtherSettingsAreRefused) {
  const Scene scene = small_cornell();
  render(scene, parse_sampler("rcs:pilot=2"), resuming(4));
  EXPECT_EQ(refusal(scene, "rcs:pilot=2", resuming(4)), "");
  RenderSettings s = resuming(8);
  s.seed = 99;
  EXPECT_NE(refusal(scene, "rcs:pilot=2", s).find("other settings"), std::string::npos);
  s = resuming(8);
  s.depth = 3;
  EXPECT_NE(refusal(scene, "rcs:pilot=2", s).find("other settings"), std::string::npos);
  s = resuming(8);
  s.roulette_depth = 7;
  EXPECT_NE(refusal(scene, "rcs:pilot=2", s).find("other settings"), std::string::npos);
  for (const char* sampler : {"owen", "rcs:pilot=1", "rcs:pilot=2,c=5"}) {
    EXPECT_NE(refusal(scene, sampler, resuming(8)).find("other settings"), std::string::npos);
  }
  const Scene wider = build(resized(builtin::make_cornell(), 71, 50));
  EXPECT_NE(refusal(wider, "rcs:pilot=2", resuming(8)).find("other settings"), std::string::npos);
  SceneDescription brighter = resized(builtin::make_cornell(), 70, 50);  // the name stays
  for (Shape& shape : brighter.shapes) {
    if (shape.emission) shape.emission->radiance.value *= 2.0f;
  }
  EXPECT_NE(refusal(build(brighter), "rcs:pilot=2", resuming(8)).find("another scene"),
            std::string::npos);
  const Scene other = build(resized(builtin::make_furnace(), 70, 50));
  EXPECT_NE(refusal(other, "rcs:pilot=2", resuming(8)).find(file_), std::string::npos);
}

TEST_F(Resume, DamagedFilesAreRefused) {
  const Scene scene = small_cornell();
  render(scene, parse_sampler("owen"), resuming(4));
  const auto size = std::filesystem::file_size(file_);
  for (const auto cut : {size - 1, size / 2, std::uintmax_t(60), std::uintmax_t(20),
                         std::uintmax_t(3), std::uintmax_t(0)}) {
    std::filesystem::resize_file(file_, cut);
    const std::string error = refusal(scene, "owen", resuming(8));
    EXPECT_NE(error.find(file_), std::string::npos) << cut;
    EXPECT_NE(error.find("remove it"), std::string::npos) << cut;
  }
  std::ofstream(file_) << "some other file that happens to lie here";
  EXPECT_NE(refusal(scene, "owen", resuming(8)).find("not a saved film"), std::string::npos);
}

TEST_F(Resume, ACancelledRenderLeavesNoHalfPassBehind) {
  const Scene scene = small_cornell();
  const SamplerSpec owen = parse_sampler("owen");
  render(scene, owen, resuming(2));
  int calls = 0;
  EXPECT_THROW(render(scene, owen, resuming(8), [&](double) { return ++calls < 9; }), Cancelled);
  const Image image = render(scene, owen, resuming(8)).image;
  EXPECT_TRUE(same_bytes(image, render(scene, owen, settings_of(8)).image));
}

TEST_F(Resume, AFileThatCannotBeWrittenIsAnError) {
  RenderSettings s = settings_of(1);
  s.resume_file = file_ + "/no/such/folder/film";
  EXPECT_NE(refusal(small_cornell(), "owen", s).find("cannot write"), std::string::npos);
}

// Stopping --------------------------------------------------------------------------------------

TEST(Render, StopsWhenTimeIsUp) {
  const Scene scene = small_cornell();
  for (const char* sampler : {"random", "rcs"}) {
    RenderSettings s = settings_of(1);
    s.time_seconds = 0.3;
    const RenderResult r = render(scene, parse_sampler(sampler), s);
    EXPECT_GT(r.stats.spp, 1) << sampler;
    EXPECT_EQ(r.stats.paths, std::uint64_t(r.stats.spp) * 3500u);
    EXPECT_LT(r.stats.wall_seconds, 3.0) << "far beyond the time asked for";
    // The samples are those of a render by their number.
    if (r.stats.pilot_spp == 0) {
      EXPECT_TRUE(same_bytes(
          r.image, render(scene, parse_sampler(sampler), settings_of(r.stats.spp)).image));
    }
  }
}

TEST(Render, ATimeTooShortGivesOneSampleAllTheSame) {
  RenderSettings s = settings_of(1);
  s.time_seconds = 1e-9;
  const RenderResult r = render(small_cornell(), parse_sampler("owen"), s);
  EXPECT_EQ(r.stats.spp, 1);
}

TEST(Render, ProgressRisesToOne) {
  std::vector<double> seen;
  render(small_cornell(), parse_sampler("rcs"), settings_of(8), [&](double fraction) {
    seen.push_back(fraction);
    return true;
  });
  ASSERT_FALSE(seen.empty());
  EXPECT_TRUE(std::is_sorted(seen.begin(), seen.end()));
  EXPECT_GT(seen.front(), 0.0);
  EXPECT_DOUBLE_EQ(seen.back(), 1.0);
}

TEST(Render, StopsWhenProgressSaysSo) {
  for (const int threads : {1, 2}) {
    RenderSettings s = settings_of(64);
    s.threads = threads;
    int calls = 0;
    EXPECT_THROW(
        render(small_cornell(), parse_sampler("random"), s, [&](double) { return ++calls < 3; }),
        Cancelled);
    EXPECT_LE(calls, 3 + threads);
  }
}

TEST(Render, ImpossibleSettingsAreRefused) {
  const Scene scene = small_cornell();
  const SamplerSpec random = parse_sampler("random");
  EXPECT_THROW(render(scene, random, settings_of(0)), UsageError);
  EXPECT_THROW(render(scene, random, settings_of(1, 0)), UsageError);
  EXPECT_THROW(render(scene, random, settings_of(1, 1021)), UsageError);
  RenderSettings s = settings_of(1);
  s.width = 3;
  EXPECT_THROW(render(scene, random, s), UsageError);
  EXPECT_NO_THROW(render(scene, random, settings_of(1, 1020)));
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

// Instruction sets ------------------------------------------------------------------------------

TEST(Kernels, ExistForEveryInstructionSetAndWidth) {
  const std::vector<Isa> isas = available_isas();
  ASSERT_FALSE(isas.empty());
  for (const Isa isa : isas) {
    EXPECT_EQ(choose_isa(name(isa)), isa);
    RenderSettings s = settings_of(1);
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
    RenderSettings s = settings_of(16);
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
}  // namespace lockstep
