#include "packets/traversal_policy.h"

#include <algorithm>
#include <array>

namespace lockstep {
namespace {

constexpr int smallest_queue = 64;  // rays; a trial on fewer says little
constexpr std::uint32_t mode_spacing = 1;

// The order of trials: first what is often best.
constexpr TraversalMode best_first[] = {
    {Packets::Eight, true},    {Packets::Sixteen, true},   {Packets::Eight, false},
    {Packets::StreamNM, true}, {Packets::Sixteen, false},  {Packets::Stream1M, false},
    {Packets::Four, false},    {Packets::StreamNM, false}, {Packets::Single, false},
    {Packets::Four, true},     {Packets::Stream1M, true}};
constexpr bool is_tried(TraversalMode mode, bool with_coherent) {
  return index(mode) < traversal_modes && (with_coherent || !mode.coherent);
}

template <bool with_coherent>
constexpr auto order_of() {
  constexpr auto tried = [](TraversalMode mode) { return is_tried(mode, with_coherent); };
  std::array<std::uint8_t, std::ranges::count_if(best_first, tried)> order{};
  std::size_t n = 0;
  for (const TraversalMode mode : best_first) {
    if (tried(mode)) order[n++] = std::uint8_t(index(mode));
  }
  return order;
}
constexpr auto all_modes = order_of<true>();
// Rays in all directions take twice as long with the flag: not even worth trials.
constexpr auto incoherent_modes = order_of<false>();

Packets packets_of(int width) {
  return width == 16  ? Packets::Sixteen
         : width == 8 ? Packets::Eight
         : width == 4 ? Packets::Four
                      : Packets::Single;
}

// What is best most often, before anything is measured.
TraversalMode first_mode(int width, bool shadow, int spread) {
  if (width == 1) return {Packets::Single, false};
  if (shadow && width == 16) return {Packets::Sixteen, false};
  if (has_streams && shadow && spread > 0) return {Packets::Stream1M, false};
  return {packets_of(width), spread == 0};
}

}  // namespace

int spread_class(float cosine) {
  return cosine > 0.999f ? 0 : cosine > 0.99f ? 1 : cosine > 0.9f ? 2 : 3;
}

TraversalPolicy::TraversalPolicy(std::optional<TraversalMode> fixed, int width) : fixed_(fixed) {
  for (int i = 0; i < 2 * bounces * spreads; ++i) {
    const int spread = i % spreads;
    const bool shadow = i >= bounces * spreads;
    const TraversalMode first = first_mode(width, shadow, spread);
    if (spread < spreads - 1) {
      choices_.emplace_back(index(first), all_modes, mode_spacing);
    } else {
      choices_.emplace_back(index(first), incoherent_modes, mode_spacing);
    }
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
