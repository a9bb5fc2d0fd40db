// What the processor counts while this thread works: cycles, instructions and cache misses in user
// mode, through Linux's perf_event_open.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace lockstep {

struct HardwareCounts {
  double cycles = 0.0;
  double instructions = 0.0;
  double cache_misses = 0.0;  // of the last level

  double instructions_per_cycle() const { return cycles > 0.0 ? instructions / cycles : 0.0; }
};

// Counters of the calling thread and of those it starts.
class HardwareCounters {
 public:
  HardwareCounters();
  ~HardwareCounters();
  HardwareCounters(const HardwareCounters&) = delete;
  HardwareCounters& operator=(const HardwareCounters&) = delete;

  // Why nothing can be counted here, as one line; empty where it can.
  const std::string& unavailable() const { return unavailable_; }

  void start();
  // Since start(); nothing where the machine does not let this program count.
  std::optional<HardwareCounts> stop();

 private:
  static constexpr int kEvents = 3;
  int files_[kEvents] = {-1, -1, -1};
  std::string unavailable_;
};

}  // namespace lockstep
