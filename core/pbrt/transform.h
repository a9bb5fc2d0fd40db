// The transform directives. Matrices are double, column vectors on the right, and map from the
// space of what follows in the file to the world (or, before the camera, from world to camera).
#pragma once

#include "core/pbrt/lexer.h"

#include <glm/mat4x4.hpp>

#include <string_view>

namespace lockstep::pbrt {

// Whether `directive` is Translate, Scale, Rotate, LookAt, ConcatTransform, Identity or Transform.
bool is_transform_directive(std::string_view directive);

// Reads the numbers after such a directive and applies it to `ctm`. Throws where the result cannot
// be inverted or is projective.
void apply_transform_directive(const Token& directive, Lexer& lexer, glm::dmat4& ctm);

// Whether `m` turns right-handed frames into left-handed ones.
bool swaps_handedness(const glm::dmat4& m);

}  // namespace lockstep::pbrt
