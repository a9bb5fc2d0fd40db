// Numbers and words in the attributes of Mitsuba's XML.
#pragma once

#include "core/mitsuba/document.h"

#include <glm/vec3.hpp>

#include <string>
#include <string_view>
#include <vector>

namespace lockstep::mitsuba {

// `text` cut at blanks, commas and semicolons.
std::vector<std::string> words_of(const std::string& text);

// The numbers in `text`, finite and in the range of float; throws, blaming `element`, where it
// holds something else.
std::vector<double> numbers_of(const Element& element, const std::string& text);

// The one number of an attribute; `fallback` where that is absent.
double number(const Element& element, const char* attribute, double fallback);
double number(const Element& element, const char* attribute);  // throws where absent

// The attributes x, y and z, or value with one (for all axes) or three numbers; `fallback` for axes
// that are not given.
glm::dvec3 vector(const Element& element, double fallback);

}  // namespace lockstep::mitsuba
