// What a render counts and reports.
#include "tests/t_cornell.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace lockstep::test_render_stats {
namespace {

TEST(RenderStats, CountWhatWasTraced) {
  const Scene scene = small_cornell();
  for (const char* sampler : all_kinds_of_samplers) {
    for (const int width : {1, 4, 8, 16}) {
      RenderSettings s = small_render(6);
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
  const RenderResult r = render(small_cornell(), parse_sampler("random"), small_render(2, 1));
  EXPECT_EQ(r.stats.rays.bounce, 0u);
  EXPECT_LE(r.stats.rays.shadow, r.stats.paths);
}

TEST(RenderStats, PilotAndWeightsAreReported) {
  const Scene scene = small_cornell();
  const auto pilot = [&](const char* sampler, int spp) {
    return render(scene, parse_sampler(sampler), small_render(spp)).stats.pilot_spp;
  };
  EXPECT_EQ(pilot("random", 8), 0);
  EXPECT_EQ(pilot("rcs:weight=0.5", 8), 0);
  EXPECT_EQ(pilot("rcs", 8), 2);
  EXPECT_EQ(pilot("rcs", 3), 1);
  EXPECT_EQ(pilot("rcs:pilot=5", 8), 5);
  EXPECT_EQ(pilot("rcs:pilot=5", 4), 4);

  const RenderResult rcs = render(scene, parse_sampler("rcs"), small_render(8));
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

  const RenderResult random = render(scene, parse_sampler("random"), small_render(1));
  EXPECT_FALSE(random.weights);
  EXPECT_EQ(random.stats.mean_weight, 1.0);
  EXPECT_EQ(random.stats.zero_weights, 0.0);
  const auto zeros = std::count(rcs.weights->pixels.begin(), rcs.weights->pixels.end(), 0.0f);
  EXPECT_DOUBLE_EQ(rcs.stats.zero_weights, double(zeros) / 3500.0);
  EXPECT_EQ(render(scene, parse_sampler("cpt"), small_render(1)).stats.zero_weights, 1.0);
  EXPECT_EQ(render(scene, parse_sampler("cpt"), small_render(1)).stats.mean_weight, 0.0);
  const SamplerSpec quarter = parse_sampler("rcs:weight=0.25");
  EXPECT_EQ(render(scene, quarter, small_render(1)).stats.mean_weight, 0.25);
}

}  // namespace
}  // namespace lockstep::test_render_stats
