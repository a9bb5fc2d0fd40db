#include "packets/layout_policy.h"

#include <cmath>

namespace lockstep {
namespace {

constexpr LaneLayout layouts[] = {{4, 4, 1}, {2, 2, 4}, {1, 1, 16}};
constexpr std::uint8_t order[] = {1, 2, 0};
constexpr std::uint32_t fewest_samples = 32;

}  // namespace

LayoutPolicy::LayoutPolicy(std::optional<LaneLayout> fixed) : fixed_(fixed), choice_(0, order) {}

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

void LayoutPolicy::record(double ratio) {
  const double log_ratio = std::log(ratio);
  if (half_done_) choice_.record(trying_, std::exp(0.5 * (first_log_ratio_ + log_ratio)));
  first_log_ratio_ = log_ratio;
  half_done_ = !half_done_;
}

}  // namespace lockstep
