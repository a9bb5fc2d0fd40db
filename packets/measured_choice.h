// Choosing the fastest of some alternatives while working: now and then part of the work goes to
// another alternative, and the ratio of its time to that of the chosen one, taken on neighbouring
// work, is remembered. Trials are frequent at first and then take about one part in a hundred.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

namespace lockstep {

class MeasuredChoice {
 public:
  static constexpr int most = 12;  // alternatives, numbered from 0

  // `order` lists what is tried, and must outlive the object.
  MeasuredChoice(int first, std::span<const std::uint8_t> order);

  int chosen() const { return chosen_; }

  // Call for each piece of work large enough to be divided: what to give half of it to, if
  // anything.
  std::optional<int> trial();

  // The time of the trial's half over that of the chosen one's. Ratios that are no numbers are
  // ignored.
  void record(int trial, double ratio);

 private:
  struct Arm {
    static constexpr int kept = 5;
    std::array<float, kept> log_ratios{};  // to the chosen alternative, the newest last
    int count = 0;                         // trials so far
    int rest = 0;                          // turns to sit out: it was slower

    float median() const;
  };

  void choose(int alternative, float log_ratio);

  int chosen_;
  std::span<const std::uint8_t> order_;
  std::array<Arm, most> arms_;
  std::uint32_t pieces_ = 0;
  std::size_t next_ = 0;  // in order_
};

}  // namespace lockstep
