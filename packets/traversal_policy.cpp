#include "packets/traversal_policy.h"

#include <algorithm>

namespace lockstep {
namespace {

constexpr int smallest_queue = 64;  // rays; a trial on fewer says little
constexpr std::uint32_t mode_spacing = 2;

// The order of trials: first what is often best.
constexpr std::uint8_t mode_order[] = {
    std::uint8_t(index({Packets::Eight, true})),    std::uint8_t(index({Packets::Sixteen, true})),
    std::uint8_t(index({Packets::Eight, false})),   std::uint8_t(index({Packets::StreamNM, true})),
    std::uint8_t(index({Packets::Sixteen, false})), std::uint8_t(index({Packets::Stream1M, false})),
    std::uint8_t(index({Packets::Four, false})),    std::uint8_t(index({Packets::StreamNM, false})),
    std::uint8_t(index({Packets::Single, false})),  std::uint8_t(index({Packets::Four, true})),
    std::uint8_t(index({Packets::Stream1M, true}))};

Packets packets_of(int width) {
  return width == 16  ? Packets::Sixteen
         : width == 8 ? Packets::Eight
         : width == 4 ? Packets::Four
                      : Packets::Single;
}

}  // namespace

int spread_class(float cosine) {
  return cosine > 0.999f ? 0 : cosine > 0.99f ? 1 : cosine > 0.9f ? 2 : 3;
}

TraversalPolicy::TraversalPolicy(std::optional<TraversalMode> fixed, int width) : fixed_(fixed) {
  const Packets packets = packets_of(width);
  for (int i = 0; i < 2 * bounces * spreads; ++i) {
    const bool coherent = i % spreads == 0 && width > 1;
    choices_.emplace_back(index({packets, coherent}), mode_order, mode_spacing);
  }
}

MeasuredChoice& TraversalPolicy::choice(const QueueClass& queue) {
  const int kind = queue.kind == RayKind::Shadow ? 1 : 0;
  const int bounce = std::min(queue.bounce, bounces - 1);
  return choices_[std::size_t((kind * bounces + bounce) * spreads + queue.spread)];
}

TraversalPlan TraversalPolicy::plan(const QueueClass& queue, int rays) {
  if (fixed_) return {*fixed_, {}};
  MeasuredChoice& c = choice(queue);
  TraversalPlan plan{traversal_mode(c.chosen()), {}};
  if (rays < smallest_queue) return plan;
  if (const auto trial = c.trial()) {
    plan.trial = traversal_mode(*trial);
    plan.trial_first = c.trial_first(*trial);
  }
  return plan;
}

void TraversalPolicy::record(const QueueClass& queue, TraversalMode trial, double trial_time,
                             double plan_time) {
  choice(queue).record(index(trial), trial_time, plan_time);
}

}  // namespace lockstep
