// How a render ends: by its samples, its time or a word from outside, or not beginning at all.
#include "core/error.h"
#include "tests/t_cornell.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace lockstep::test_render_end {
namespace {

TEST(Render, StopsWhenTimeIsUp) {
  const Scene scene = small_cornell();
  for (const char* sampler : {"random", "rcs"}) {
    RenderSettings s = small_render(1);
    s.time_seconds = 0.3;
    const RenderResult r = render(scene, parse_sampler(sampler), s);
    EXPECT_GT(r.stats.spp, 1) << sampler;
    EXPECT_EQ(r.stats.paths, std::uint64_t(r.stats.spp) * 3500u);
    EXPECT_LT(r.stats.wall_seconds, 3.0) << "far beyond the time asked for";
    // The samples are those of a render by their number.
    if (r.stats.pilot_spp == 0) {
      EXPECT_TRUE(same_bytes(
          r.image, render(scene, parse_sampler(sampler), small_render(r.stats.spp)).image));
    }
  }
}

TEST(Render, ATimeTooShortGivesOneSampleAllTheSame) {
  RenderSettings s = small_render(1);
  s.time_seconds = 1e-9;
  const RenderResult r = render(small_cornell(), parse_sampler("owen"), s);
  EXPECT_EQ(r.stats.spp, 1);
}

TEST(Render, ProgressRisesToOne) {
  std::vector<double> seen;
  render(small_cornell(), parse_sampler("rcs"), small_render(8), [&](double fraction) {
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
    RenderSettings s = small_render(64);
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
  EXPECT_THROW(render(scene, random, small_render(0)), UsageError);
  EXPECT_THROW(render(scene, random, small_render(1, 0)), UsageError);
  EXPECT_THROW(render(scene, random, small_render(1, 1021)), UsageError);
  RenderSettings s = small_render(1);
  s.width = 3;
  EXPECT_THROW(render(scene, random, s), UsageError);
  EXPECT_NO_THROW(render(scene, random, small_render(1, 1020)));
}

}  // namespace
}  // namespace lockstep::test_render_end
