// Mitsuba's sensors: camera, film, pixel filter and sample count.
#pragma once

#include "core/mitsuba/state.h"

namespace lockstep::mitsuba {

// Sets the scene's camera, film and sample count from a <sensor>. Mitsuba's camera looks along +z
// of its own frame, with y up and +x to the left of the image. Without a film the image has
// 768 x 576 pixels and a Gaussian filter; without a sampler there are 4 samples per pixel.
void read_sensor(State& state, const Element& element);

}  // namespace lockstep::mitsuba
