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

namespace lockstep {
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
  std::map<int, int> worked = {};  // pieces by what was chosen

  Work(int first, unsigned seed) : choice(first, everything), random(seed) {}

  double noise() { return std::uniform_real_distribution(0.9, 1.1)(random); }
  void go(const Costs& costs, int pieces) {
    for (int i = 0; i < pieces; ++i) {
      const int chosen = choice.chosen();
      ++worked[chosen];
      const auto trial = choice.trial();
      if (!trial) continue;
      ++trials;
      ASSERT_NE(*trial, chosen);
      choice.record(*trial, costs[size_t(*trial)] * noise() / (costs[size_t(chosen)] * noise()));
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
    EXPECT_LE(work.trials, 500);
    EXPECT_GE(work.trials, 50) << "too few to notice a change";
  }
}

TEST(MeasuredChoice, RatiosThatAreNoNumbersChangeNothing) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const auto order = all_alternatives();
  MeasuredChoice choice(3, order);
  for (int i = 0; i < 100; ++i) {
    for (const double ratio : {0.0, -1.0, infinity, -infinity, std::nan("")}) {
      choice.record(5, ratio);
      ASSERT_EQ(choice.chosen(), 3);
    }
  }
  // They count as no trials either: three are needed.
  choice.record(5, 0.5);
  choice.record(5, 0.5);
  EXPECT_EQ(choice.chosen(), 3);
  choice.record(5, 0.5);
  EXPECT_EQ(choice.chosen(), 5);
}

// Layouts --------------------------------------------------------------------------------------

// The layouts used, `ratio` telling what a trial measures.
template <class Ratio>
std::map<std::string, int> lay_out(LayoutPolicy& policy, int tiles, const Ratio& ratio) {
  std::map<std::string, int> used;
  for (int i = 0; i < tiles; ++i) {
    const LayoutPlan plan = policy.plan(64);
    ++used[to_string(plan.lanes)];
    if (plan.trial) policy.record(ratio(plan));
  }
  return used;
}

// Samples in the second half of a tile cost `second`.
auto costs_by_layout(double second) {
  return [second](const LayoutPlan& plan) {
    const auto cost = [](const LaneLayout& l) {
      return l.samples == 1 ? 1.3 : l.samples == 4 ? 1.0 : 1.5;
    };
    const double ratio = cost(*plan.trial) / cost(plan.lanes);
    return plan.trial_first ? ratio / second : ratio * second;
  };
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
  EXPECT_GT(lay_out(policy, 1000, costs_by_layout(1.0))["2x2x4"], 0);
}

TEST(LayoutPolicy, FindsTheFastestEvenIfSecondHalvesAreFaster) {
  for (const double second : {1.0, 0.5, 2.0}) {
    LayoutPolicy policy({});
    const auto used = lay_out(policy, 2000, costs_by_layout(second));
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
    policy.record(plan.trial->samples == 4 ? 0.5 : 2.0);
  }
  EXPECT_EQ(policy.plan(1).lanes, (LaneLayout{2, 2, 4}));
  EXPECT_EQ(records % 2, 0);
  EXPECT_GE(records, 6) << "three trials of both orders";
}

// Traversal ------------------------------------------------------------------------------------

TEST(TraversalPolicy, AFixedModeStays) {
  const TraversalMode mode{Packets::StreamNM, true};
  TraversalPolicy policy(mode, 16);
  for (int i = 0; i < 1000; ++i) {
    const TraversalPlan plan = policy.plan(RayKind(i % 3), i % 12, 1024);
    ASSERT_EQ(plan.mode, mode);
    ASSERT_FALSE(plan.trial);
  }
}

TEST(TraversalPolicy, BeginsWithPacketsOfTheWidth) {
  for (const auto& [width, packets] : {std::pair{1, Packets::Single},
                                       {4, Packets::Four},
                                       {8, Packets::Eight},
                                       {16, Packets::Sixteen}}) {
    TraversalPolicy policy({}, width);
    const TraversalMode plain{packets, false}, first{packets, width > 1};
    EXPECT_EQ(policy.plan(RayKind::Camera, 0, 1024).mode, first);
    EXPECT_EQ(policy.plan(RayKind::Shadow, 0, 1024).mode, first);
    EXPECT_EQ(policy.plan(RayKind::Bounce, 1, 1024).mode, plain);
    EXPECT_EQ(policy.plan(RayKind::Shadow, 1, 1024).mode, plain);
  }
}

TEST(TraversalPolicy, ShortQueuesAreNoTrial) {
  TraversalPolicy policy({}, 8);
  for (int i = 0; i < 1000; ++i) ASSERT_FALSE(policy.plan(RayKind::Bounce, 2, 1 + i % 255).trial);
}

// Single rays are the fastest after the third bounce, coherent packets for shadow rays.
TEST(TraversalPolicy, LearnsByKindAndBounce) {
  const TraversalMode single{Packets::Single, false}, coherent{Packets::Eight, true};
  TraversalPolicy policy({}, 16);
  const auto work = [&](RayKind kind, int bounce, TraversalMode best) {
    for (int i = 0; i < 3000; ++i) {
      const TraversalPlan plan = policy.plan(kind, bounce, 512);
      if (!plan.trial) continue;
      EXPECT_NE(*plan.trial, (TraversalMode{Packets::Single, true}));
      const auto cost = [&](TraversalMode mode) { return mode == best ? 1.0 : 1.4; };
      policy.record(kind, bounce, *plan.trial, cost(*plan.trial) / cost(plan.mode));
    }
    EXPECT_EQ(policy.plan(kind, bounce, 512).mode, best);
  };
  work(RayKind::Bounce, 3, single);
  work(RayKind::Shadow, 3, coherent);
  EXPECT_EQ(policy.plan(RayKind::Bounce, 3, 512).mode, single);
  EXPECT_EQ(policy.plan(RayKind::Bounce, 2, 512).mode, (TraversalMode{Packets::Sixteen, false}));
  EXPECT_EQ(policy.plan(RayKind::Shadow, 2, 512).mode, (TraversalMode{Packets::Sixteen, false}));
}

}  // namespace
}  // namespace lockstep
