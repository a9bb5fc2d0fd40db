// Where a thread is in an image: what can be said of it when the program crashes there.
#pragma once

#include <cstdint>

namespace lockstep {

// Samples [first_sample, first_sample + samples) of the pixels [x0, x1) x [y0, y1), at an
// interaction of their paths, of a render. Plain values and texts that outlive it, so that a signal
// handler of the same thread can read it.
struct RenderSite {
  const char* render = nullptr;   // scene, sampler and seed; null where nothing is rendered
  const char* command = nullptr;  // that renders it again; "" where nobody gave it
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  std::uint32_t first_sample = 0;
  std::uint32_t samples = 0;
  int bounce = 0;
};

// The calling thread's. Async-signal-safe.
RenderSite& render_site() noexcept;

}  // namespace lockstep
