// Parameters that are colours, or numbers that a texture may vary.
#pragma once

#include "core/mitsuba/state.h"
#include "core/spectrum.h"

#include <string_view>

namespace lockstep::mitsuba {

// The colour that a tag states: <rgb> linear, <srgb> and #rrggbb sRGB-encoded, <spectrum> with one
// value or pairs wavelength:value, <blackbody>, <float>. Throws where it is none of these.
glm::vec3 read_color(State& state, const Element& element, ColorUse use);

// The parameter `name` as a colour or texture; `fallback` where absent.
ColorInput get_color(State& state, const Properties& set, std::string_view name, glm::vec3 fallback,
                     ColorUse use);

// The same for reflectances: constants and factors are kept in [0, 1], with a warning.
ColorInput get_reflectance(State& state, const Properties& set, std::string_view name,
                           float fallback);

// The same for lights: a texture gives a warning and half of what it is multiplied with.
glm::vec3 get_light(State& state, const Properties& set, std::string_view name);

// The parameter `name` as a number or texture; `fallback` where absent.
FloatInput get_number(State& state, const Properties& set, std::string_view name, float fallback);

}  // namespace lockstep::mitsuba
