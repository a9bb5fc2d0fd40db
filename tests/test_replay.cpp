// Ray logs and replays: every ray is there once, in classes, with times; what renders tell of their
// stages and modes adds up.
#include "packets/replay.h"

#include "packets/ray_log.h"
#include "tests/t_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

namespace lockstep::test_replay {
namespace {

constexpr int depth = 3;

Scene small_cornell() { return build(resized(builtin::make_cornell(), 48, 40)); }

RenderSettings settings_of(int spp) {
  RenderSettings s;
  s.seed = 4;
  s.spp = spp;
  s.depth = depth;
  s.threads = 1;
  return s;
}

bool is_measured(int mode) {
  return mode == policy_replay || traversal_mode(mode) != TraversalMode{Packets::Single, true};
}

std::uint64_t count_of(const RayCounts& rays, RayKind kind) {
  return kind == RayKind::Camera   ? rays.camera
         : kind == RayKind::Bounce ? rays.bounce
                                   : rays.shadow;
}

TEST(Replay, ClassesHoldEveryRayOnce) {
  const Scene scene = small_cornell();
  const Replay r = replay(scene, parse_sampler("owen"), settings_of(4), 1);
  std::set<std::pair<RayKind, int>> classes;
  std::uint64_t rays[ray_kinds] = {};
  for (const ReplayClass& c : r.classes) {
    EXPECT_TRUE(classes.emplace(c.kind, c.bounce).second) << "twice";
    rays[int(c.kind)] += c.rays;
  }
  std::set<std::pair<RayKind, int>> expected{{RayKind::Camera, 0}};
  for (int bounce = 0; bounce < depth; ++bounce) expected.emplace(RayKind::Shadow, bounce);
  for (int bounce = 1; bounce < depth; ++bounce) expected.emplace(RayKind::Bounce, bounce);
  EXPECT_EQ(classes, expected);
  for (const RayKind kind : {RayKind::Camera, RayKind::Bounce, RayKind::Shadow}) {
    EXPECT_EQ(rays[int(kind)], count_of(r.stats.rays, kind));
  }
  EXPECT_EQ(r.stats.rays.camera, 48u * 40u * 4u);
}

TEST(Replay, TellsTheTimeOfEveryModeAndTheLeast) {
  const Scene scene = small_cornell();
  const Replay r = replay(scene, parse_sampler("cpt"), settings_of(4), 3);
  EXPECT_GT(r.render_seconds, 0.0);
  double best_by_class = 0.0;
  for (const ReplayClass& c : r.classes) {
    double least = c.seconds[0];
    for (int mode = 0; mode < replay_modes; ++mode) {
      if (!is_measured(mode)) {
        EXPECT_EQ(c.seconds[mode], 0.0) << replay_name(mode);
        continue;
      }
      EXPECT_GT(c.seconds[mode], 0.0) << replay_name(mode);
      if (mode != policy_replay) least = std::min(least, c.seconds[mode]);
    }
    EXPECT_TRUE(is_measured(c.best_mode()) && c.best_mode() != policy_replay);
    EXPECT_EQ(c.seconds[c.best_mode()], least);
    best_by_class += least;
  }
  EXPECT_DOUBLE_EQ(r.best_by_class_seconds(), best_by_class);
  EXPECT_GT(r.policy_share(), 0.0);
  EXPECT_TRUE(std::isfinite(r.policy_share()));
  EXPECT_TRUE(is_measured(r.best_mode()) && r.best_mode() != policy_replay);
  for (int mode = 0; mode < traversal_modes; ++mode) {
    if (!is_measured(mode)) continue;
    EXPECT_LE(r.seconds(r.best_mode()), r.seconds(mode)) << replay_name(mode);
    EXPECT_LE(r.best_by_class_seconds(), r.seconds(mode) * (1.0 + 1e-9)) << replay_name(mode);
  }
}

TEST(Replay, NamesItsModes) {
  std::set<std::string> names;
  for (int mode = 0; mode < replay_modes; ++mode) names.insert(replay_name(mode));
  EXPECT_EQ(names.size(), size_t(replay_modes));
  EXPECT_EQ(replay_name(policy_replay), "auto");
  EXPECT_EQ(replay_name(index({Packets::Eight, true})), "packet8-coherent");
}

TEST(Replay, StopsWhenProgressSaysSo) {
  const Scene scene = small_cornell();
  std::vector<double> seen;
  replay(scene, parse_sampler("random"), settings_of(1), 2, [&](double done) {
    seen.push_back(done);
    return true;
  });
  EXPECT_TRUE(std::is_sorted(seen.begin(), seen.end()));
  EXPECT_DOUBLE_EQ(seen.back(), 1.0);
  const auto stop = [](double) { return false; };
  EXPECT_THROW(replay(scene, parse_sampler("random"), settings_of(1), 2, stop), Cancelled);
}

// Logs -----------------------------------------------------------------------------------------

void expect_whole(const RayLog& log, const RayCounts& rays) {
  std::uint64_t counted[ray_kinds] = {};
  std::size_t values = 0;
  for (const RayLog::Queue& q : log.queues) {
    ASSERT_GT(q.count, 0);
    ASSERT_EQ(q.first, values) << "queues lie one after another";
    values += size_t(q.count) * (q.kind == RayKind::Shadow ? 7 : 6);
    counted[int(q.kind)] += std::uint64_t(q.count);
    ASSERT_LE(q.bounce, depth);
    ASSERT_EQ(q.bounce == 0,
              q.kind == RayKind::Camera || (q.kind == RayKind::Shadow && q.bounce == 0));
  }
  EXPECT_EQ(log.values.size(), values);
  for (const RayKind kind : {RayKind::Camera, RayKind::Bounce, RayKind::Shadow}) {
    EXPECT_EQ(counted[int(kind)], count_of(rays, kind));
  }
}

TEST(RayLog, HoldsTheSameRaysWhateverTheMode) {
  const Scene scene = small_cornell();
  RenderSettings s = settings_of(2);
  s.lanes = LaneLayout{};
  const auto log_of = [&](std::optional<TraversalMode> mode) {
    RayLog log;
    s.log = &log;
    s.traversal = mode;
    expect_whole(log, {});
    const RenderResult r = render(scene, parse_sampler("owen"), s);
    expect_whole(log, r.stats.rays);
    return log;
  };
  const RayLog expected = log_of(TraversalMode{Packets::Single, false});
  for (const auto mode :
       {TraversalMode{Packets::Sixteen, true}, TraversalMode{Packets::Four, false},
        TraversalMode{Packets::Stream1M, false}}) {
    if (index(mode) >= traversal_modes) continue;
    EXPECT_EQ(log_of(mode).values, expected.values) << to_string(mode);
  }
  EXPECT_EQ(log_of(std::nullopt).values, expected.values);
}

TEST(RayLog, DirectionsAreUnitVectors) {
  RayLog log;
  RenderSettings s = settings_of(1);
  s.log = &log;
  render(small_cornell(), parse_sampler("random"), s);
  for (const RayLog::Queue& q : log.queues) {
    const float* x = log.values.data() + q.first + 3 * q.count;
    for (int i = 0; i < q.count; ++i) {
      const float y = x[i + q.count], z = x[i + 2 * q.count];
      ASSERT_NEAR(x[i] * x[i] + y * y + z * z, 1.0f, 1e-5f);
    }
  }
}

// Statistics of renders ------------------------------------------------------------------------

std::uint64_t sum_of(const std::uint64_t (&traced)[traversal_modes]) {
  return std::accumulate(std::begin(traced), std::end(traced), std::uint64_t(0));
}

TEST(RenderStats, StagesAddUpToTheRender) {
  const Scene scene = small_cornell();
  for (const int threads : {1, 2}) {
    RenderSettings s = settings_of(16);
    s.threads = threads;
    const RenderStats stats = render(scene, parse_sampler("owen"), s).stats;
    double sum = 0.0;
    for (const double seconds : stats.stage_seconds) {
      EXPECT_GT(seconds, 0.0);
      sum += seconds;
    }
    EXPECT_NEAR(sum, stats.cpu_seconds, 0.01 * stats.cpu_seconds);
  }
}

TEST(RenderStats, RaysAreCountedByKindAndMode) {
  const Scene scene = small_cornell();
  RenderSettings s = settings_of(4);
  for (int i = -1; i < traversal_modes; ++i) {
    if (i >= 0 && !is_measured(i)) continue;
    if (i >= 0) s.traversal = traversal_mode(i);
    const RenderStats stats = render(scene, parse_sampler("owen"), s).stats;
    for (const RayKind kind : {RayKind::Camera, RayKind::Bounce, RayKind::Shadow}) {
      const auto& traced = stats.traced[int(kind)];
      EXPECT_EQ(sum_of(traced), count_of(stats.rays, kind));
      if (i >= 0) {
        EXPECT_EQ(traced[i], count_of(stats.rays, kind)) << replay_name(i);
      }
    }
  }
}

}  // namespace
}  // namespace lockstep::test_replay
