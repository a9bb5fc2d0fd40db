// Spectra as linear Rec. 709 RGB, for readers of scene files. Wavelengths are in nm.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <functional>
#include <vector>

namespace lockstep {

// What a colour stands for decides what a spectrum's RGB is relative to.
enum class ColorUse {
  Reflectance,  // also indices of refraction: a constant spectrum is grey
  Light,        // colour under the eye; a constant spectrum of 1 has luminance 1
};

using Spectrum = std::function<double(double wavelength)>;

// The RGB of a spectrum by the CIE 1931 observer; what lies outside Rec. 709 is cut off at 0.
glm::vec3 spectrum_to_rgb(const Spectrum& spectrum, ColorUse use);

// A light of the spectrum's chromaticity, with luminance 1; black if nothing of it is visible.
glm::vec3 chromaticity_to_rgb(const Spectrum& spectrum);

// For the primaries and the white (D65) of Rec. 709; may be negative.
glm::dvec3 xyz_to_rgb(glm::dvec3 xyz);

// Linear between `samples` (wavelength, value), at least one, which increase; constant beyond them.
double interpolate(const std::vector<glm::dvec2>& samples, double wavelength);

// Planck's law: radiance of a black body per nm, in W/(m^2 sr nm). The temperature is above 0 K.
double black_body_radiance(double wavelength, double kelvin);

}  // namespace lockstep
