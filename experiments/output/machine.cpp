#include "experiments/output/machine.h"

#include "core/embree.h"
#include "packets/traversal_mode.h"

#include <fmt/format.h>
#include <sched.h>
#include <sys/resource.h>
#include <sys/utsname.h>

#include <ctime>
#include <fstream>

namespace lockstep {

std::string_view version() { return LOCKSTEP_VERSION; }

std::string embree_version() {
  return RTC_VERSION_STRING + std::string(has_streams ? "" : " (no ray streams)");
}

std::string cpu_name() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const std::size_t colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown CPU";
}

int cpu_count() {
  cpu_set_t set;
  CPU_ZERO(&set);
  return sched_getaffinity(0, sizeof(set), &set) == 0 ? CPU_COUNT(&set) : 1;
}

std::string system_name() {
  utsname system{};
  if (uname(&system) != 0) return "unknown system";
  return fmt::format("{} {} {}", system.sysname, system.release, system.machine);
}

std::string date_and_time() {
  const std::time_t now = std::time(nullptr);
  std::tm local{};
  localtime_r(&now, &local);
  char text[40];
  std::strftime(text, sizeof(text), "%Y-%m-%dT%H:%M:%S%z", &local);
  return text;
}

std::uint64_t peak_memory_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return std::uint64_t(usage.ru_maxrss) * 1024;  // Linux counts in KiB
}

std::vector<std::pair<std::string, std::string>> component_versions() {
#if defined(__clang__)
  const std::string compiler = __VERSION__;  // names itself
#else
  const std::string compiler = "GCC " __VERSION__;
#endif
  return {{"compiler", compiler},
          {"Embree", embree_version()},
          {"fmt", fmt::format("{}.{}.{}", FMT_VERSION / 10000, FMT_VERSION / 100 % 100,
                              FMT_VERSION % 100)}};
}

}  // namespace lockstep
