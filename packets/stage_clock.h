// Where a thread's time goes, by the processor's own counter: about twenty cycles a reading, cheap
// enough to stay on.
#pragma once

#include "core/cpu_clock.h"

#include <cstdint>

namespace lockstep {

enum class Stage { Sampling, Traversal, Shading, Film };
inline constexpr int stages = 4;

// Ticks of constant length.
[[gnu::always_inline]] inline std::uint64_t read_ticks() {
#if defined(__x86_64__)
  return __builtin_ia32_rdtsc();  // <x86intrin.h> takes a second to compile
#elif defined(__aarch64__)
  std::uint64_t ticks;
  asm volatile("mrs %0, cntvct_el0" : "=r"(ticks));
  return ticks;
#else
  return std::uint64_t(1e9 * wall_seconds());
#endif
}

struct StageTicks {
  std::uint64_t of[stages] = {};
};

// Charges the time since the last call to the stage that was entered then.
class StageClock {
 public:
  [[gnu::always_inline]] explicit StageClock(StageTicks& ticks, Stage stage)
      : ticks_(ticks), stage_(stage), since_(read_ticks()) {}
  [[gnu::always_inline]] ~StageClock() { enter(stage_); }
  StageClock(const StageClock&) = delete;
  StageClock& operator=(const StageClock&) = delete;

  [[gnu::always_inline]] void enter(Stage stage) {
    const std::uint64_t now = read_ticks();
    ticks_.of[int(stage_)] += now - since_;
    since_ = now;
    stage_ = stage;
  }

 private:
  StageTicks& ticks_;
  Stage stage_;
  std::uint64_t since_;
};

}  // namespace lockstep
