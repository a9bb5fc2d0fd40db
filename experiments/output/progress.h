// How far a long run is, on stderr: one line that rewrites itself on a terminal, a plain line every
// ten seconds elsewhere, nothing when quiet.
#pragma once

#include <chrono>
#include <string>
#include <string_view>

namespace lockstep {

// "45 s", "3 min 20 s", "2 h 05 min".
std::string duration_text(double seconds);

class ProgressMeter {
 public:
  explicit ProgressMeter(bool quiet);
  ~ProgressMeter();

  // Progress stands at `fraction` of the whole run, working on `label`. Cheap to call often.
  void show(double fraction, std::string_view label);

  // Removes the line from the terminal, so that other output starts on a fresh one.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;
  bool quiet_;
  bool terminal_;
  bool line_open_ = false;
  double first_ = -1.0;  // the fraction at which it began: some may have been done before
  Clock::time_point start_ = Clock::now();
  Clock::time_point last_ = start_;
};

// Ctrl-C and SIGTERM ask a render to stop at its next tile; a second one ends the program.
void catch_interrupts();
bool interrupted();

}  // namespace lockstep
