#include "packets/measured_choice.h"

#include <algorithm>
#include <cmath>

namespace lockstep {
namespace {

// Once all were tried, pieces of work from one trial to the next, times the spacing: of the
// runner-up, and of any other or a runner-up that is far behind.
constexpr std::uint32_t of_runner_up = 4, of_others = 16;

constexpr double remembered = 0.95;  // of a sum when the next trial is added
constexpr double outlier = 4.0;      // ratios beyond: a thread was interrupted
constexpr double close = 1.15;       // a runner-up
constexpr double very_close = 1.1;   // one that is tried whenever a trial is due, so many times
constexpr int unsure = 16;           // at first: most that is lost is lost before the choice
constexpr double much_slower = 1.5;  // above this ratio an alternative
constexpr int turns_of_rest = 3;     // sits out that many turns

// The ratio below which an alternative is chosen after so many trials: one is off by a tenth.
double convincing(int trials) {
  return trials < 2    ? 0.4
         : trials < 4  ? 0.6
         : trials < 8  ? 0.75
         : trials < 16 ? 0.88
         : trials < 32 ? 0.93
                       : 0.965;
}

}  // namespace

MeasuredChoice::MeasuredChoice(int first, std::span<const std::uint8_t> order,
                               std::uint32_t spacing)
    : chosen_(first), order_(order), spacing_(spacing) {}

std::optional<int> MeasuredChoice::trial() {
  // At random: pieces come in cycles, such as the samples of a tile.
  random_ = random_ * 1664525u + 1013904223u;
  if ((random_ >> 16) % spacing_ != 0) return std::nullopt;
  if (turns_ < order_.size()) return next_in_order();
  const auto second = runner_up();
  const Arm runner = second ? arms_[std::size_t(*second)] : Arm{};
  if (second && runner.count < unsure && runner.ratio() < very_close) return second;
  ++later_pieces_;
  if (later_pieces_ % of_others == 0) return next_in_order();
  if (later_pieces_ % of_runner_up != 0) return std::nullopt;
  const bool is_close = second && runner.ratio() < close;
  return is_close || later_pieces_ % of_others == of_runner_up ? second : std::nullopt;
}

std::optional<int> MeasuredChoice::next_in_order() {
  for (std::size_t looked = 0; looked < order_.size(); ++looked) {
    const int alternative = order_[turns_++ % order_.size()];
    if (alternative == chosen_) continue;
    Arm& arm = arms_[std::size_t(alternative)];
    if (arm.rest == 0) return alternative;
    --arm.rest;
  }
  return std::nullopt;
}

std::optional<int> MeasuredChoice::runner_up() const {
  std::optional<int> best;
  for (const std::uint8_t alternative : order_) {
    const Arm& arm = arms_[alternative];
    if (alternative == chosen_ || arm.count == 0) continue;
    if (!best || arm.ratio() < arms_[std::size_t(*best)].ratio()) best = alternative;
  }
  return best;
}

void MeasuredChoice::record(int trial, double trial_time, double chosen_time) {
  const double ratio = trial_time / chosen_time;
  if (!(chosen_time > 0.0) || !(ratio > 1.0 / outlier) || !std::isfinite(ratio)) return;
  Arm& arm = arms_[std::size_t(trial)];
  arm.time = remembered * arm.time + std::min(ratio, outlier) * chosen_time;
  arm.chosen_time = remembered * arm.chosen_time + chosen_time;
  ++arm.count;
  if (arm.ratio() > much_slower) arm.rest = turns_of_rest;
  if (arm.ratio() < convincing(arm.count)) choose(trial);
}

void MeasuredChoice::choose(int alternative) {
  const Arm chosen = arms_[std::size_t(alternative)];
  // What is known of the others now counts from the new choice, and may be out of date.
  for (Arm& arm : arms_) arm.chosen_time *= chosen.ratio(), arm.rest = 0;
  turns_ = 0;
  arms_[std::size_t(chosen_)] = {chosen.chosen_time, chosen.time, chosen.count, 0};
  arms_[std::size_t(alternative)] = {};
  chosen_ = alternative;
}

}  // namespace lockstep
