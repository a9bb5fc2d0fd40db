// Mitsuba's lights that are not shapes.
#pragma once

#include "core/mitsuba/state.h"

namespace lockstep::mitsuba {

// Adds an <emitter> of the scene. Of several environments the first counts. Skies and suns become
// a constant environment; what is not supported gives a warning.
void add_emitter(State& state, const Element& element);

}  // namespace lockstep::mitsuba
