// Spectra as linear Rec. 709 RGB, and the metals that Mitsuba names.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <optional>
#include <string_view>
#include <vector>

namespace lockstep::mitsuba {

// What a colour stands for decides what a spectrum's RGB is relative to.
enum class ColorUse {
  Reflectance,  // also indices of refraction: a constant spectrum is grey
  Light,        // colour under the eye; a constant spectrum of 1 has luminance 1
};

// A spectrum through `samples` (wavelength in nm, value), increasing, linear between them and zero
// beyond them.
glm::vec3 spectrum_to_rgb(const std::vector<glm::dvec2>& samples, ColorUse use);

// Radiance of a black body per nm, in W/(m^2 sr nm), as Mitsuba has it.
glm::vec3 black_body_to_rgb(double kelvin);

struct MetalIndices {
  glm::vec3 eta, k;
};

// The metal `name`, such as "Cu", or "none", which reflects everything.
std::optional<MetalIndices> metal_indices(std::string_view name);

// The index of refraction of a dielectric by name, such as "bk7", in lower case (Mitsuba 0.5
// documentation, table 8.2; after Hecht, Optics).
std::optional<float> dielectric_index(std::string_view name);

}  // namespace lockstep::mitsuba
