#include "core/memory.h"

#include "core/error.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <limits>

namespace lockstep {
namespace {

constexpr std::uint64_t unlimited = std::numeric_limits<std::uint64_t>::max();

// Of all memory, by what the kernel thinks that it could free: see proc(5).
std::uint64_t left_in_system() {
  std::ifstream file("/proc/meminfo");
  std::uint64_t left = 0;
  bool found = false;
  for (std::string key, rest; file >> key; std::getline(file, rest)) {
    std::uint64_t kib = 0;
    if ((key == "MemAvailable:" || key == "SwapFree:") && file >> kib) {
      left += kib * 1024;
      found = true;
    }
  }
  return found ? left : unlimited;
}

// As a container sees it, version 2 and 1; what it has used of that may be caches, and counts as
// left.
std::uint64_t control_group_limit() {
  std::uint64_t least = unlimited;
  for (const char* path :
       {"/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory/memory.limit_in_bytes"}) {
    std::uint64_t bytes = 0;
    if (std::ifstream(path) >> bytes) least = std::min(least, bytes);  // "max" is no number
  }
  return least;
}

}  // namespace

std::uint64_t used_address_space() {
  std::uint64_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  return pages * std::uint64_t(sysconf(_SC_PAGESIZE));
}

std::uint64_t left_address_space() {
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return unlimited;
  return limit.rlim_cur - std::min<std::uint64_t>(used_address_space(), limit.rlim_cur);
}

std::uint64_t available_memory() {
  return std::min({left_in_system(), left_address_space(), control_group_limit()});
}

void require_memory(double bytes, const std::string& what, const std::string& advice) {
  const auto left = double(available_memory());
  if (bytes <= left) return;
  constexpr double gib = 1024.0 * 1024.0 * 1024.0;
  throw Error(fmt::format("{} needs {:.3g} GiB of memory, and {:.3g} GiB are left; {}", what,
                          bytes / gib, left / gib, advice));
}

}  // namespace lockstep
