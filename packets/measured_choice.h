// Choosing the fastest of some alternatives while working: now and then part of the work goes to
// another alternative, and the times of both, taken on neighbouring work, are remembered. All are
// tried soon after the beginning; later mostly the runner-up is, and the slow ones seldom.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

namespace lockstep {

class MeasuredChoice {
 public:
  static constexpr int most = 12;  // alternatives, numbered from 0

  // `order` lists what is tried, and must outlive the object. The larger the part of a piece that
  // a trial takes, the larger should be the `spacing` of trials.
  MeasuredChoice(int first, std::span<const std::uint8_t> order, std::uint32_t spacing);

  int chosen() const { return chosen_; }

  // Call for each piece of work large enough to be divided: what to give part of it to, if
  // anything.
  std::optional<int> trial();

  // Whether to work on the trial's part before a part for comparison: in turn, as what comes second
  // may find caches warm.
  bool trial_first(int trial) const { return arms_[std::size_t(trial)].count % 2 == 1; }

  // What the trial's part took, and one of the same piece given to the chosen one, per unit of
  // work. Pairs that are no times, or in which the chosen one took over four times as long, are
  // ignored: it was interrupted.
  void record(int trial, double trial_time, double chosen_time);

 private:
  // Sums over its trials, the older ones with less weight. Sums, because where work is slow is
  // where a choice matters.
  struct Arm {
    double time = 0.0, chosen_time = 0.0;
    int count = 0;  // trials so far
    int rest = 0;   // turns to sit out: it was much slower

    double ratio() const { return time / chosen_time; }
  };

  std::optional<int> next_in_order();
  std::optional<int> runner_up() const;
  void choose(int alternative);

  int chosen_;
  std::span<const std::uint8_t> order_;
  std::uint32_t spacing_;
  std::array<Arm, most> arms_;
  std::uint32_t random_ = 1;
  std::uint32_t later_pieces_ = 0;  // after all were tried, those that fell due
  std::size_t turns_ = 0;           // taken in order_
};

}  // namespace lockstep
