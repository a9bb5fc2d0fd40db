// The indices of refraction that Mitsuba names.
#pragma once

#include <glm/vec3.hpp>

#include <optional>
#include <string_view>

namespace lockstep::mitsuba {

// Complex, eta + i k, as linear Rec. 709 RGB.
struct MetalIndices {
  glm::vec3 eta, k;
};

// The metal `name`, such as "Cu", or "none", which reflects everything.
std::optional<MetalIndices> metal_indices(std::string_view name);

// The index of refraction of a dielectric by name, such as "bk7", in lower case (Mitsuba 0.5
// documentation, table 8.2; after Hecht, Optics).
std::optional<float> dielectric_index(std::string_view name);

}  // namespace lockstep::mitsuba
