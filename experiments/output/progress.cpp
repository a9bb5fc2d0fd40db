#include "experiments/output/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>

namespace lockstep {
namespace {

constexpr double kTerminalSeconds = 0.2;
constexpr double kPlainSeconds = 10.0;
constexpr double kSettleSeconds = 1.0;  // before this, an estimate of the time left is noise

volatile std::sig_atomic_t interrupt_flag = 0;

void on_interrupt(int signal) {
  interrupt_flag = 1;
  std::signal(signal, SIG_DFL);
}

double seconds_between(std::chrono::steady_clock::time_point a,
                       std::chrono::steady_clock::time_point b) {
  return std::chrono::duration<double>(b - a).count();
}

}  // namespace

std::string duration_text(double seconds) {
  const int total = int(seconds + 0.5);
  if (total < 60) return fmt::format("{} s", total);
  if (total < 3600) return fmt::format("{} min {:02} s", total / 60, total % 60);
  return fmt::format("{} h {:02} min", total / 3600, total % 3600 / 60);
}

ProgressMeter::ProgressMeter(bool quiet) : quiet_(quiet), terminal_(isatty(STDERR_FILENO) != 0) {}

ProgressMeter::~ProgressMeter() { clear(); }

void ProgressMeter::show(double fraction, std::string_view label) {
  const Clock::time_point now = Clock::now();
  if (first_ < 0.0) {
    first_ = fraction;
    start_ = now;
  }
  if (quiet_ || seconds_between(last_, now) < (terminal_ ? kTerminalSeconds : kPlainSeconds))
    return;
  last_ = now;
  const double elapsed = seconds_between(start_, now);
  std::string line = fmt::format("{:3.0f} %  {}", 100.0 * fraction, label);
  if (fraction > first_ && elapsed > kSettleSeconds) {
    const double left = elapsed * (1.0 - fraction) / (fraction - first_);
    line += fmt::format(", {} left", duration_text(left));
  }
  if (terminal_) {
    fmt::print(stderr, "\r{}\x1b[K", line);
  } else {
    fmt::print(stderr, "{}\n", line);
  }
  std::fflush(stderr);
  line_open_ = terminal_;
}

void ProgressMeter::clear() {
  if (!line_open_) return;
  fmt::print(stderr, "\r\x1b[K");
  std::fflush(stderr);
  line_open_ = false;
}

void catch_interrupts() {
  std::signal(SIGINT, on_interrupt);
  std::signal(SIGTERM, on_interrupt);
  std::signal(SIGXFSZ, SIG_IGN);  // a file that may not grow is an error of its write
}

bool interrupted() { return interrupt_flag != 0; }

}  // namespace lockstep
