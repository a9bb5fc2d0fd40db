#include "experiments/profile/hardware_counters.h"

#include <fmt/format.h>
#include <linux/perf_event.h>
#include <sys/ioctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace lockstep {
namespace {

int open_counter(std::uint64_t event) {
  perf_event_attr attributes{};
  attributes.type = PERF_TYPE_HARDWARE;
  attributes.size = sizeof attributes;
  attributes.config = event;
  attributes.disabled = 1;
  attributes.inherit = 1;
  attributes.exclude_kernel = 1;
  attributes.exclude_hv = 1;
  attributes.read_format = PERF_FORMAT_TOTAL_TIME_ENABLED | PERF_FORMAT_TOTAL_TIME_RUNNING;
  return int(syscall(SYS_perf_event_open, &attributes, 0, -1, -1, PERF_FLAG_FD_CLOEXEC));
}

// The count, scaled up where the counter had to share its register with others.
std::optional<double> count_of(int file) {
  struct {
    std::uint64_t value, enabled, running;
  } count{};
  if (read(file, &count, sizeof count) != sizeof count || count.running == 0) return {};
  return double(count.value) * (double(count.enabled) / double(count.running));
}

}  // namespace

HardwareCounters::HardwareCounters() {
  constexpr std::uint64_t events[kEvents] = {PERF_COUNT_HW_CPU_CYCLES, PERF_COUNT_HW_INSTRUCTIONS,
                                             PERF_COUNT_HW_CACHE_MISSES};
  for (int i = 0; i < kEvents && unavailable_.empty(); ++i) {
    files_[i] = open_counter(events[i]);
    if (files_[i] < 0) {
      unavailable_ = fmt::format(
          "no hardware counters ({}); this needs a processor that shows them, and "
          "kernel.perf_event_paranoid at 2 or less",
          std::strerror(errno));
    }
  }
}

HardwareCounters::~HardwareCounters() {
  for (int file : files_) {
    if (file >= 0) close(file);
  }
}

void HardwareCounters::start() {
  if (!unavailable_.empty()) return;
  for (int file : files_) {
    ioctl(file, PERF_EVENT_IOC_RESET, 0);
    ioctl(file, PERF_EVENT_IOC_ENABLE, 0);
  }
}

std::optional<HardwareCounts> HardwareCounters::stop() {
  if (!unavailable_.empty()) return {};
  for (int file : files_) ioctl(file, PERF_EVENT_IOC_DISABLE, 0);
  const auto cycles = count_of(files_[0]), instructions = count_of(files_[1]),
             misses = count_of(files_[2]);
  if (!cycles || !instructions || !misses) return {};
  return HardwareCounts{*cycles, *instructions, *misses};
}

}  // namespace lockstep
