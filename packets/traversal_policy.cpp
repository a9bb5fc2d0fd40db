#include "packets/traversal_policy.h"

#include <algorithm>

namespace lockstep {
namespace {

constexpr int smallest_queue = 256;  // rays; a trial on fewer says little

// The order of trials: first what is often best.
constexpr std::uint8_t order[] = {
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

TraversalPolicy::TraversalPolicy(std::optional<TraversalMode> fixed, int width) : fixed_(fixed) {
  const Packets packets = packets_of(width);
  choices_.assign(2 * bounces, MeasuredChoice(index({packets, false}), order));
  if (width > 1) {
    choice(RayKind::Camera, 0) = MeasuredChoice(index({packets, true}), order);
    choice(RayKind::Shadow, 0) = MeasuredChoice(index({packets, true}), order);
  }
}

MeasuredChoice& TraversalPolicy::choice(RayKind kind, int bounce) {
  const int at = std::min(bounce, bounces - 1) + (kind == RayKind::Shadow ? bounces : 0);
  return choices_[std::size_t(at)];
}

TraversalPlan TraversalPolicy::plan(RayKind kind, int bounce, int rays) {
  if (fixed_) return {*fixed_, {}};
  MeasuredChoice& c = choice(kind, bounce);
  TraversalPlan plan{traversal_mode(c.chosen()), {}};
  if (rays < smallest_queue) return plan;
  if (const auto trial = c.trial()) plan.trial = traversal_mode(*trial);
  return plan;
}

void TraversalPolicy::record(RayKind kind, int bounce, TraversalMode trial, double ratio) {
  choice(kind, bounce).record(index(trial), ratio);
}

}  // namespace lockstep
