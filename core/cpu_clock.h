// Clocks that figures are taken with.
#pragma once

#include <time.h>

namespace lockstep {

inline double clock_seconds(clockid_t clock) {
  timespec t{};
  clock_gettime(clock, &t);
  return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

// CPU time of the calling thread, seconds: waiting and other processes do not count.
inline double thread_cpu_seconds() { return clock_seconds(CLOCK_THREAD_CPUTIME_ID); }

inline double wall_seconds() { return clock_seconds(CLOCK_MONOTONIC); }

}  // namespace lockstep
