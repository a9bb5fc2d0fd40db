#include "experiments/output/activity.h"

#include "core/memory.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <atomic>
#include <cstring>
#include <exception>
#include <utility>

namespace lockstep {
namespace {

std::atomic<const char*> innermost = nullptr;
char ended_by_exception[256] = "";  // fixed: kept where there may be no memory

constexpr double kMiB = 1024.0 * 1024.0;

}  // namespace

Activity::Activity(std::string what) : what_(std::move(what)), outer_(innermost) {
  ended_by_exception[0] = '\0';
  innermost = what_.c_str();
}

Activity::~Activity() {
  if (std::uncaught_exceptions() > 0 && ended_by_exception[0] == '\0') {
    std::strncpy(ended_by_exception, what_.c_str(), sizeof ended_by_exception - 1);
  }
  innermost = outer_;
}

const char* current_activity() {
  const char* what = innermost;
  return what ? what : ended_by_exception;
}

std::string out_of_memory_text() {
  const char* what = ended_by_exception[0] != '\0' ? ended_by_exception : current_activity();
  rlimit limit{};
  getrlimit(RLIMIT_AS, &limit);
  const std::string may =
      limit.rlim_cur == RLIM_INFINITY
          ? ""
          : fmt::format(" of the {:.0f} MiB that ulimit -v allows", double(limit.rlim_cur) / kMiB);
  return fmt::format(
      "not enough memory{}{}: this process has {:.0f} MiB of address space{}; give it more, or "
      "choose a smaller scene or image or fewer threads; what was written before is unchanged",
      *what ? " for " : "", what, double(used_address_space()) / kMiB, may);
}

}  // namespace lockstep
