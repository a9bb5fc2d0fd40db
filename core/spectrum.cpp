#include "core/spectrum.h"

#include <glm/common.hpp>

#include <cmath>

namespace lockstep {
namespace {

// Wyman, Sloan and Shirley 2013, "Simple Analytic Approximations to the CIE XYZ Color Matching
// Functions", the multi-lobe fit.
glm::dvec3 color_matching(double wavelength) {
  const auto lobe = [&](double height, double center, double below, double above) {
    const double t = (wavelength - center) / (wavelength < center ? below : above);
    return height * std::exp(-0.5 * t * t);
  };
  return {lobe(1.056, 599.8, 37.9, 31.0) + lobe(0.362, 442.0, 16.0, 26.7) +
              lobe(-0.065, 501.1, 20.4, 26.2),
          lobe(0.821, 568.8, 46.9, 40.5) + lobe(0.286, 530.9, 16.3, 31.1),
          lobe(1.217, 437.0, 11.8, 36.0) + lobe(0.681, 459.0, 26.0, 13.8)};
}

// XYZ up to a constant factor.
glm::dvec3 integrate_xyz(const Spectrum& spectrum) {
  constexpr double first = 380.0, last = 780.0, step = 5.0;
  glm::dvec3 xyz(0.0);
  for (double w = first; w <= last; w += step) xyz += spectrum(w) * color_matching(w);
  return xyz;
}

glm::vec3 clipped(glm::dvec3 rgb) { return glm::vec3(glm::max(rgb, glm::dvec3(0.0))); }

}  // namespace

glm::vec3 spectrum_to_rgb(const Spectrum& spectrum, ColorUse use) {
  const glm::dvec3 xyz = integrate_xyz(spectrum);
  const glm::dvec3 xyz_of_one = integrate_xyz([](double) { return 1.0; });
  return clipped(use == ColorUse::Light ? xyz_to_rgb(xyz / xyz_of_one.y)
                                        : xyz_to_rgb(xyz) / xyz_to_rgb(xyz_of_one));
}

glm::vec3 chromaticity_to_rgb(const Spectrum& spectrum) {
  const glm::dvec3 xyz = integrate_xyz(spectrum);
  return xyz.y > 0.0 ? clipped(xyz_to_rgb(xyz / xyz.y)) : glm::vec3(0.0f);
}

glm::dvec3 xyz_to_rgb(glm::dvec3 xyz) {
  return {3.2404542 * xyz.x - 1.5371385 * xyz.y - 0.4985314 * xyz.z,
          -0.9692660 * xyz.x + 1.8760108 * xyz.y + 0.0415560 * xyz.z,
          0.0556434 * xyz.x - 0.2040259 * xyz.y + 1.0572252 * xyz.z};
}

double interpolate(const std::vector<glm::dvec2>& samples, double wavelength) {
  if (wavelength <= samples.front().x) return samples.front().y;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const glm::dvec2 a = samples[i - 1], b = samples[i];
    if (wavelength <= b.x) return a.y + (wavelength - a.x) / (b.x - a.x) * (b.y - a.y);
  }
  return samples.back().y;
}

double black_body_radiance(double wavelength, double kelvin) {
  constexpr double first_radiation_constant = 1.191042972e-16;  // W m^2/sr
  constexpr double second_radiation_constant = 1.438776877e-2;  // m K
  const double w = wavelength * 1e-9;
  const double per_metre = first_radiation_constant / std::pow(w, 5.0) /
                           std::expm1(second_radiation_constant / (w * kelvin));
  return 1e-9 * per_metre;
}

}  // namespace lockstep
