// Roughness parameters as GGX alpha.
#pragma once

#include "core/pbrt/inputs.h"

#include <glm/vec2.hpp>

#include <string>

namespace lockstep::pbrt {

// How a perceived roughness in [0, 1] becomes alpha: a polynomial of its logarithm until v3 (v2's
// exponents of Blinn's model are close to it), the square root in v4.
enum class Remap { V3, V4 };

struct Roughness {
  glm::vec2 alpha{0.0f};  // along u and v, in [0, 1]
  FloatInput scale{};     // times both
};

// From PREFIXroughness, PREFIXuroughness, PREFIXvroughness and "remaproughness".
Roughness get_roughness(const Inputs& in, float fallback, Remap remap,
                        const std::string& prefix = "");

// v3's "glass" and its kin, which are smooth where neither direction is rough.
Roughness get_glass_roughness(const Inputs& in);

// For models without a direction: the geometric mean, with a warning where the two differ.
float isotropic(const Inputs& in, const Roughness& roughness);

}  // namespace lockstep::pbrt
