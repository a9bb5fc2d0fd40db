// Choices by measurement, on synthetic costs: the best is found and kept, noise is withstood, and
// trials stay cheap.
#include "packets/layout_policy.h"
#include "packets/measured_choice.h"
#include "packets/traversal_policy.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <random>

namespace lockstep::test_measured_choice {
namespace {

using Costs = std::array<double, MeasuredChoice::most>;

std::array<std::uint8_t, MeasuredChoice::most> all_alternatives() {
  std::array<std::uint8_t, MeasuredChoice::most> order;
  std::iota(order.begin(), order.end(), std::uint8_t(0));
  return order;
}
const auto everything = all_alternatives();

// The fastest costs 1, the others from 1.25 to 2.
Costs costs_with_fastest(int fastest) {
  Costs costs;
  for (int i = 0; i < MeasuredChoice::most; ++i) costs[size_t(i)] = 1.25 + 0.75 * (i * 5 % 12) / 11;
  costs[size_t(fastest)] = 1.0;
  return costs;
}

// Work on `pieces` pieces, every time off by up to 10 %.
struct Work {
  MeasuredChoice choice;
  std::mt19937 random;
  int trials = 0;
  double lost = 0.0;               // with a quarter of a piece in a trial
  std::map<int, int> worked = {};  // pieces by what was chosen

  Work(int first, unsigned seed) : choice(first, everything, 2), random(seed) {}

  double noise() { return std::uniform_real_distribution(0.9, 1.1)(random); }
  void go(const Costs& costs, int pieces) {
    for (int i = 0; i < pieces; ++i) {
      const int chosen = choice.chosen();
      ++worked[chosen];
      const auto trial = choice.trial();
      if (!trial) continue;
      ++trials;
      lost += 0.25 * (costs[size_t(*trial)] - costs[size_t(chosen)]);
      ASSERT_NE(*trial, chosen);
      choice.record(*trial, costs[size_t(*trial)] * noise(), costs[size_t(chosen)] * noise());
    }
  }
};

TEST(MeasuredChoice, FindsTheFastestWhereverItBegins) {
  for (int fastest = 0; fastest < MeasuredChoice::most; ++fastest) {
    for (const int first : {0, 5, 11}) {
      Work work(first, unsigned(1 + fastest));
      work.go(costs_with_fastest(fastest), 10000);
      EXPECT_EQ(work.choice.chosen(), fastest) << "from " << first;
      EXPECT_GT(work.worked[fastest], 9000) << "from " << first;
    }
  }
}

TEST(MeasuredChoice, SticksToIt) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    Work work(0, seed);
    const Costs costs = costs_with_fastest(4);
    work.go(costs, 3000);
    work.worked.clear();
    work.go(costs, 20000);
    EXPECT_EQ(work.worked[4], 20000) << seed;
  }
}

TEST(MeasuredChoice, ChoosesAnewAfterTheCostsChange) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    Work work(0, seed);
    work.go(costs_with_fastest(4), 5000);
    ASSERT_EQ(work.choice.chosen(), 4);
    work.go(costs_with_fastest(9), 30000);
    EXPECT_EQ(work.choice.chosen(), 9) << seed;
  }
}

TEST(MeasuredChoice, SpendsLittleOnTrials) {
  for (unsigned seed = 0; seed < 5; ++seed) {
    Work work(0, seed);
    work.go(costs_with_fastest(7), 10000);
    EXPECT_LT(work.lost, 0.01 * 10000);
    EXPECT_GE(work.trials, 50) << "too few to notice a change";
  }
}

TEST(MeasuredChoice, TimesThatAreNoneChangeNothing) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  MeasuredChoice choice(3, everything, 2);
  for (int i = 0; i < 100; ++i) {
    for (const double time : {0.0, -1.0, infinity, -infinity, std::nan("")}) {
      choice.record(5, time, 1.0);
      choice.record(5, 1.0, time);
      choice.record(5, time, time);
      ASSERT_EQ(choice.chosen(), 3);
    }
  }
  // They count as no trials either: two are needed for this gain.
  choice.record(5, 0.5, 1.0);
  EXPECT_EQ(choice.chosen(), 3);
  choice.record(5, 0.5, 1.0);
  EXPECT_EQ(choice.chosen(), 5);
}

TEST(MeasuredChoice, GreatGainsNeedFewTrials) {
  const auto trials_until_chosen = [](double ratio) {
    MeasuredChoice choice(3, everything, 2);
    int trials = 0;
    while (choice.chosen() == 3 && trials < 50) choice.record(5, ratio, 1.0), ++trials;
    return trials;
  };
  EXPECT_EQ(trials_until_chosen(0.3), 1);
  EXPECT_EQ(trials_until_chosen(0.5), 2);
  EXPECT_EQ(trials_until_chosen(0.7), 4);
  EXPECT_EQ(trials_until_chosen(0.8), 8);
  EXPECT_EQ(trials_until_chosen(0.9), 16);
  EXPECT_EQ(trials_until_chosen(0.95), 32);
  EXPECT_EQ(trials_until_chosen(0.99), 50) << "no gain worth a change";
}

TEST(MeasuredChoice, InterruptionsOfTheChosenOneDoNotCount) {
  MeasuredChoice choice(3, everything, 2);
  for (int i = 0; i < 10; ++i) choice.record(5, 1.0, 100.0);
  EXPECT_EQ(choice.chosen(), 3);
}

// Twice as fast on cheap work and 1.3 times as slow where it costs ten times as much: a median of
// ratios would choose it.
TEST(MeasuredChoice, SlowWorkCountsForMore) {
  MeasuredChoice choice(3, everything, 2);
  choice.record(5, 13.0, 10.0);
  for (int i = 0; i < 50; ++i) {
    const bool slow = i % 3 == 0;
    choice.record(5, slow ? 13.0 : 0.5, slow ? 10.0 : 1.0);
    ASSERT_EQ(choice.chosen(), 3);
  }
}

// An alternative that looked good at first is left again as soon as it is not.
TEST(MeasuredChoice, GoesBack) {
  Work work(0, 1);
  Costs beginning = costs_with_fastest(0), later = beginning;
  beginning[4] = 0.5;
  later[4] = 2.0;
  work.go(beginning, 60);
  ASSERT_EQ(work.choice.chosen(), 4);
  work.worked.clear();
  work.go(later, 600);
  EXPECT_EQ(work.choice.chosen(), 0);
  EXPECT_LT(work.worked[4], 80);
}

// Layouts --------------------------------------------------------------------------------------

double cost_of(const LaneLayout& l) { return l.samples == 1 ? 1.3 : l.samples == 4 ? 1.0 : 1.5; }

// The layouts used. Samples in the second half of a tile cost `second` times as much.
std::map<std::string, int> lay_out(LayoutPolicy& policy, int tiles, double second) {
  std::map<std::string, int> used;
  for (int i = 0; i < tiles; ++i) {
    const LayoutPlan plan = policy.plan(64);
    ++used[to_string(plan.lanes)];
    if (!plan.trial) continue;
    policy.record(cost_of(*plan.trial) * (plan.trial_first ? 1.0 : second),
                  cost_of(plan.lanes) * (plan.trial_first ? second : 1.0));
  }
  return used;
}

TEST(LayoutPolicy, AFixedLayoutStays) {
  LayoutPolicy policy(LaneLayout{8, 2, 1});
  for (int i = 0; i < 1000; ++i) {
    const LayoutPlan plan = policy.plan(256);
    ASSERT_EQ(plan.lanes, (LaneLayout{8, 2, 1}));
    ASSERT_FALSE(plan.trial);
  }
}

TEST(LayoutPolicy, FewSamplesAreNoTrial) {
  LayoutPolicy policy({});
  for (int i = 0; i < 1000; ++i) {
    const LayoutPlan plan = policy.plan(std::uint32_t(1 + i % 31));
    ASSERT_EQ(plan.lanes, (LaneLayout{4, 4, 1}));
    ASSERT_FALSE(plan.trial);
  }
  EXPECT_GT(lay_out(policy, 1000, 1.0)["2x2x4"], 0);
}

TEST(LayoutPolicy, FindsTheFastestEvenIfSecondHalvesAreFaster) {
  for (const double second : {1.0, 0.5, 2.0}) {
    LayoutPolicy policy({});
    const auto used = lay_out(policy, 2000, second);
    EXPECT_GT(used.at("2x2x4"), 1800) << second;
  }
}

TEST(LayoutPolicy, BothOrdersAreTriedBeforeATrialCounts) {
  LayoutPolicy policy({});
  LayoutPlan first;
  int records = 0;
  for (int i = 0; i < 500 && policy.plan(1).lanes == LaneLayout{4, 4, 1}; ++i) {
    const LayoutPlan plan = policy.plan(64);
    if (!plan.trial) {
      EXPECT_EQ(records % 2, 0) << "the other order is due";
      continue;
    }
    EXPECT_EQ(plan.trial_first, records % 2 == 1);
    if (plan.trial_first) {
      EXPECT_EQ(plan.trial, first.trial);
      EXPECT_EQ(plan.lanes, first.lanes);
    }
    first = plan;
    ++records;
    policy.record(plan.trial->samples == 4 ? 0.8 : 2.0, 1.0);
  }
  EXPECT_EQ(policy.plan(1).lanes, (LaneLayout{2, 2, 4}));
  EXPECT_EQ(records % 2, 0);
  EXPECT_GE(records, 6) << "some trials of both orders";
}

// Traversal ------------------------------------------------------------------------------------

TEST(TraversalPolicy, AFixedModeStays) {
  const TraversalMode mode{Packets::Sixteen, true};
  TraversalPolicy policy(mode, 16);
  for (int i = 0; i < 1000; ++i) {
    const TraversalPlan plan = policy.plan({RayKind(i % 3), i % 12, i % spreads}, 1024);
    ASSERT_EQ(plan.mode, mode);
    ASSERT_FALSE(plan.trial);
  }
}

TEST(TraversalPolicy, BeginsWithPacketsOfTheWidthCoherentOnesForParallelRays) {
  for (const auto& [width, packets] : {std::pair{1, Packets::Single},
                                       {4, Packets::Four},
                                       {8, Packets::Eight},
                                       {16, Packets::Sixteen}}) {
    TraversalPolicy policy({}, width);
    for (const RayKind kind : {RayKind::Camera, RayKind::Bounce, RayKind::Shadow}) {
      for (int spread = 0; spread < spreads; ++spread) {
        TraversalMode expected{packets, spread == 0 && width > 1};
        if (kind == RayKind::Shadow && width == 16) {
          expected = {Packets::Sixteen, false};
        } else if (has_streams && kind == RayKind::Shadow && spread > 0 && width > 1) {
          expected = {Packets::Stream1M, false};
        }
        EXPECT_EQ(policy.plan({kind, 0, spread}, 1024).mode, expected);
      }
    }
  }
}

TEST(TraversalPolicy, ShortQueuesAreNoTrial) {
  TraversalPolicy policy({}, 8);
  for (int i = 0; i < 1000; ++i) {
    ASSERT_FALSE(policy.plan({RayKind::Bounce, 2, 3}, 1 + i % 63).trial);
  }
}

TEST(TraversalPolicy, SpreadsAreInOrder) {
  EXPECT_EQ(spread_class(1.0f), 0);
  EXPECT_EQ(spread_class(0.0f), spreads - 1);
  int last = 0;
  for (float cosine = 1.0f; cosine > 0.0f; cosine -= 0.001f) {
    EXPECT_GE(spread_class(cosine), last);
    last = spread_class(cosine);
  }
}

// Single rays are the fastest after the third bounce, coherent packets for shadow rays, but where
// they spread.
TEST(TraversalPolicy, LearnsByClass) {
  const TraversalMode single{Packets::Single, false}, coherent{Packets::Eight, true};
  TraversalPolicy policy({}, 16);
  const auto work = [&](const QueueClass& queue, TraversalMode best) {
    for (int i = 0; i < 3000; ++i) {
      const TraversalPlan plan = policy.plan(queue, 512);
      if (!plan.trial) continue;
      EXPECT_NE(*plan.trial, (TraversalMode{Packets::Single, true}));
      const auto cost = [&](TraversalMode mode) { return mode == best ? 1.0 : 1.4; };
      policy.record(queue, *plan.trial, cost(*plan.trial), cost(plan.mode));
    }
    EXPECT_EQ(policy.plan(queue, 512).mode, best);
  };
  work({RayKind::Bounce, 3, 2}, single);
  work({RayKind::Shadow, 3, 2}, coherent);
  EXPECT_EQ(policy.plan({RayKind::Bounce, 3, 2}, 512).mode, single);
  const TraversalMode untouched{Packets::Sixteen, false};
  EXPECT_EQ(policy.plan({RayKind::Bounce, 2, 2}, 512).mode, untouched);
  EXPECT_EQ(policy.plan({RayKind::Bounce, 3, 1}, 512).mode, untouched);
  const TraversalMode untouched_shadow =
      TraversalPolicy({}, 16).plan({RayKind::Shadow, 0, 2}, 1).mode;
  EXPECT_EQ(policy.plan({RayKind::Shadow, 2, 2}, 512).mode, untouched_shadow);
  EXPECT_EQ(policy.plan({RayKind::Shadow, 3, 1}, 512).mode, untouched_shadow);
}

TEST(TraversalPolicy, NeverTriesTheFlagOnRaysInAllDirections) {
  for (const int spread : {spreads - 2, spreads - 1}) {
    TraversalPolicy policy({}, 8);
    const QueueClass queue{RayKind::Bounce, 1, spread};
    int coherent = 0, trials = 0;
    for (int i = 0; i < 2000; ++i) {
      const TraversalPlan plan = policy.plan(queue, 512);
      if (!plan.trial) continue;
      ++trials;
      coherent += plan.trial->coherent;
      policy.record(queue, *plan.trial, 1.2, 1.0);
    }
    EXPECT_GT(trials, 50);
    EXPECT_EQ(coherent > 0, spread < spreads - 1);
  }
}

}  // namespace
}  // namespace lockstep::test_measured_choice
