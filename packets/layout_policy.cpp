#include "packets/layout_policy.h"

namespace lockstep {
namespace {

constexpr LaneLayout layouts[] = {{4, 4, 1}, {2, 2, 4}, {1, 1, 16}};
constexpr std::uint8_t layout_order[] = {1, 2, 0};
constexpr std::uint32_t fewest_samples = 32;
constexpr std::uint32_t layout_spacing = 4;  // half a tile is a large part

}  // namespace

LayoutPolicy::LayoutPolicy(std::optional<LaneLayout> fixed)
    : fixed_(fixed), choice_(0, layout_order, layout_spacing) {}

LayoutPlan LayoutPolicy::plan(std::uint32_t samples) {
  if (fixed_) return {*fixed_, {}};
  LayoutPlan plan{layouts[choice_.chosen()], {}};
  if (samples < fewest_samples) return plan;
  if (!half_done_) {
    const auto trial = choice_.trial();
    if (!trial) return plan;
    trying_ = *trial;
  }
  plan.trial = layouts[trying_];
  plan.trial_first = half_done_;
  return plan;
}

void LayoutPolicy::record(double trial_time, double plan_time) {
  if (half_done_) {
    choice_.record(trying_, first_trial_time_ + trial_time, first_plan_time_ + plan_time);
  }
  first_trial_time_ = trial_time;
  first_plan_time_ = plan_time;
  half_done_ = !half_done_;
}

}  // namespace lockstep
