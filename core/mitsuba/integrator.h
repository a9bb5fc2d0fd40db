// Mitsuba's integrators: how long paths are.
#pragma once

#include "core/mitsuba/state.h"

namespace lockstep::mitsuba {

// Sets the scene's default depth. Mitsuba's max_depth counts the edges of a path, 2 being direct
// light; -1, the default, is no limit, here 64. Other integrators than path tracers give a warning.
void read_integrator(State& state, const Element& element);

}  // namespace lockstep::mitsuba
