// The Cornell box at 70 x 50 pixels: the last tiles are cut on both sides, to sizes that no lane
// layout divides.
#pragma once

#include "tests/t_scenes.h"

namespace lockstep {

inline Scene small_cornell() { return build(resized(builtin::make_cornell(), 70, 50)); }

inline RenderSettings small_render(int spp, int depth = 4) {
  RenderSettings s;
  s.seed = 11;
  s.spp = spp;
  s.depth = depth;
  s.roulette_depth = 2;
  s.threads = 2;
  return s;
}

// Samplers that between them share nothing, everything and some, with and without a pilot.
inline constexpr const char* all_kinds_of_samplers[] = {"random", "owen", "cpt", "rcs",
                                                        "rcs:offset=fresh"};

}  // namespace lockstep
