// Mitsuba's <transform>: matrices in double precision, column vectors on the right. Each operation
// in the tag acts on the result of those before it.
#pragma once

#include "core/mitsuba/document.h"
#include "core/texture_description.h"

#include <glm/mat4x4.hpp>

namespace lockstep::mitsuba {

// Throws where an operation is malformed or the whole is projective or cannot be inverted. Of an
// <animation> the first transform counts.
glm::dmat4 read_transform(const Element& element, Warnings& warnings);

// The transform of texture coordinates that to_uv stands for. A 3x3 matrix acts on (u, v, 1), which
// is why its third column moves; so does the fourth one of other operations.
UvTransform to_uv_transform(const glm::dmat4& m);

}  // namespace lockstep::mitsuba
