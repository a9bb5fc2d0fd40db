#include "packets/measured_choice.h"

#include <algorithm>
#include <cmath>

namespace lockstep {
namespace {

constexpr int enough = 3;            // trials of an alternative before it may be chosen
constexpr float gain = 0.015f;       // by which it must be faster; all as logarithms of ratios
constexpr float slower = 0.12f;      // its next trials are put off,
constexpr float much_slower = 0.5f;  // and put off for long

// Pieces from one trial to the next.
std::uint32_t spacing(std::uint32_t pieces) { return pieces < 128 ? 8 : pieces < 512 ? 16 : 64; }

}  // namespace

float MeasuredChoice::Arm::median() const {
  std::array<float, kept> sorted = log_ratios;
  const auto middle = sorted.begin() + std::min(count, kept) / 2;
  std::nth_element(sorted.begin(), middle, sorted.begin() + std::min(count, kept));
  return *middle;
}

MeasuredChoice::MeasuredChoice(int first, std::span<const std::uint8_t> order)
    : chosen_(first), order_(order) {}

std::optional<int> MeasuredChoice::trial() {
  ++pieces_;
  if (pieces_ % spacing(pieces_) != 0) return std::nullopt;
  for (std::size_t looked = 0; looked < order_.size(); ++looked) {
    const int alternative = order_[next_];
    next_ = (next_ + 1) % order_.size();
    if (alternative == chosen_) continue;
    Arm& arm = arms_[std::size_t(alternative)];
    if (arm.rest == 0) return alternative;
    --arm.rest;
  }
  return std::nullopt;
}

void MeasuredChoice::record(int trial, double ratio) {
  if (!(ratio > 0.0) || std::isinf(ratio)) return;
  Arm& arm = arms_[std::size_t(trial)];
  arm.log_ratios[std::size_t(arm.count % Arm::kept)] = float(std::log(ratio));
  ++arm.count;
  const float median = arm.median();
  if (median > slower) arm.rest = median > much_slower ? 32 : 8;
  if (arm.count >= enough && median < -gain) choose(trial, median);
}

void MeasuredChoice::choose(int alternative, float log_ratio) {
  // What is known of the others now counts from the new choice.
  for (Arm& arm : arms_) {
    for (float& r : arm.log_ratios) r -= log_ratio;
  }
  Arm& old = arms_[std::size_t(chosen_)];
  old = Arm{};
  old.log_ratios.fill(-log_ratio);
  old.count = enough;
  chosen_ = alternative;
}

}  // namespace lockstep
