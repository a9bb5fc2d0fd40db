// Mitsuba's textures. Its (u, v) has v downwards in images, as textures have it here: the first row
// of pixels is at v = 0 (Mitsuba 0.5, mipmap.h), and the readers of OBJ files, whose v goes up,
// turn it when they load ("flipTexCoords").
#pragma once

#include "core/mitsuba/state.h"

namespace lockstep::mitsuba {

// The texture of a tag, added to the scene the first time. One that is not supported gives a
// warning and a constant grey.
TextureInput read_texture(State& state, const Element& element);

}  // namespace lockstep::mitsuba
