#include "core/mitsuba/spectrum.h"

#include "core/pbrt/named_spectra.h"

#include <glm/common.hpp>

#include <array>
#include <cmath>
#include <string>
#include <utility>

namespace lockstep::mitsuba {
namespace {

constexpr double first_wavelength = 380.0, last_wavelength = 780.0, step = 5.0;  // nm

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

glm::dvec3 xyz_to_rgb(glm::dvec3 xyz) {
  return {3.2404542 * xyz.x - 1.5371385 * xyz.y - 0.4985314 * xyz.z,
          -0.9692660 * xyz.x + 1.8760108 * xyz.y + 0.0415560 * xyz.z,
          0.0556434 * xyz.x - 0.2040259 * xyz.y + 1.0572252 * xyz.z};
}

template <class Spectrum>
glm::dvec3 integrate_rgb(const Spectrum& spectrum) {
  glm::dvec3 xyz(0.0);
  double luminance_of_one = 0.0;
  for (double w = first_wavelength; w <= last_wavelength; w += step) {
    xyz += spectrum(w) * color_matching(w);
    luminance_of_one += color_matching(w).y;
  }
  return xyz_to_rgb(xyz / luminance_of_one);
}

double interpolate(const std::vector<glm::dvec2>& samples, double wavelength) {
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const glm::dvec2 a = samples[i - 1], b = samples[i];
    if (wavelength < a.x || wavelength > b.x) continue;
    return a.y + (wavelength - a.x) / (b.x - a.x) * (b.y - a.y);
  }
  return 0.0;
}

struct Metal {
  std::string_view name;
  MetalIndices indices;
};

// Beside those that pbrt names: the tables of Palik's Handbook of Optical Constants of Solids that
// Mitsuba ships, integrated as above.
constexpr std::array<Metal, 15> metals{{
    {"Be", {{4.168692f, 3.190650f, 2.780358f}, {3.820497f, 3.015017f, 2.865107f}}},
    {"Cr", {{4.345994f, 2.925910f, 1.652079f}, {5.186901f, 4.237704f, 3.750385f}}},
    {"Hg", {{2.382938f, 1.446173f, 0.908021f}, {6.295415f, 4.383721f, 3.416875f}}},
    {"Ir", {{3.071567f, 2.087705f, 1.615465f}, {5.566350f, 4.076449f, 3.262738f}}},
    {"Li", {{0.264514f, 0.196050f, 0.220529f}, {3.520242f, 2.318713f, 1.666025f}}},
    {"Mo", {{4.464573f, 3.532203f, 2.772202f}, {4.094718f, 3.426322f, 3.146690f}}},
    {"Nb", {{3.410342f, 2.793396f, 2.392484f}, {3.427663f, 2.742018f, 2.576710f}}},
    {"Rh", {{2.573001f, 1.864648f, 1.552432f}, {6.747762f, 4.715381f, 3.970284f}}},
    {"Ta", {{2.064077f, 2.391236f, 2.625277f}, {2.391113f, 1.747123f, 1.944067f}}},
    {"TiN", {{1.640466f, 1.153050f, 1.377488f}, {3.347192f, 1.951824f, 1.099993f}}},
    {"VC", {{3.641988f, 2.758035f, 2.529174f}, {3.054471f, 2.203542f, 1.960328f}}},
    {"VN", {{2.852750f, 2.123618f, 1.937291f}, {3.017372f, 2.061611f, 1.613894f}}},
    {"W", {{4.350964f, 3.307196f, 2.993968f}, {3.486412f, 2.609936f, 2.269991f}}},
    {"a-C", {{2.932756f, 2.231036f, 1.965489f}, {0.885150f, 0.799898f, 0.814254f}}},
    {"none", {{0.0f, 0.0f, 0.0f}, {1.0f, 1.0f, 1.0f}}},
}};

constexpr std::array<std::pair<std::string_view, float>, 24> dielectrics{{
    {"vacuum", 1.0f},
    {"helium", 1.000036f},
    {"hydrogen", 1.000132f},
    {"air", 1.000277f},
    {"carbon dioxide", 1.00045f},
    {"water", 1.3330f},
    {"acetone", 1.36f},
    {"ethanol", 1.361f},
    {"carbon tetrachloride", 1.461f},
    {"glycerol", 1.4729f},
    {"benzene", 1.501f},
    {"silicone oil", 1.52045f},
    {"bromine", 1.661f},
    {"water ice", 1.31f},
    {"fused quartz", 1.458f},
    {"pyrex", 1.470f},
    {"acrylic glass", 1.49f},
    {"polypropylene", 1.49f},
    {"bk7", 1.5046f},
    {"sodium chloride", 1.544f},
    {"amber", 1.55f},
    {"pet", 1.5750f},
    {"diamond", 2.419f},
    {"glass", 1.5046f},  // not a name of Mitsuba's
}};

}  // namespace

glm::vec3 spectrum_to_rgb(const std::vector<glm::dvec2>& samples, ColorUse use) {
  glm::dvec3 rgb = integrate_rgb([&](double w) { return interpolate(samples, w); });
  if (use == ColorUse::Reflectance) rgb /= integrate_rgb([](double) { return 1.0; });
  return glm::vec3(glm::max(rgb, glm::dvec3(0.0)));
}

glm::vec3 black_body_to_rgb(double kelvin) {
  constexpr double first_radiation_constant = 1.191042972e-16;  // W m^2/sr
  constexpr double second_radiation_constant = 1.438776877e-2;  // m K
  const auto planck = [&](double nm) {
    const double w = nm * 1e-9;
    const double per_metre = first_radiation_constant / std::pow(w, 5.0) /
                             std::expm1(second_radiation_constant / (w * kelvin));
    return 1e-9 * per_metre;
  };
  return glm::vec3(glm::max(integrate_rgb(planck), glm::dvec3(0.0)));
}

std::optional<MetalIndices> metal_indices(std::string_view name) {
  for (const Metal& metal : metals) {
    if (metal.name == name) return metal.indices;
  }
  const std::string pbrt_name = "metal-" + std::string(name);
  const std::optional<glm::vec3> eta = pbrt::named_spectrum(pbrt_name + "-eta");
  const std::optional<glm::vec3> k = pbrt::named_spectrum(pbrt_name + "-k");
  if (eta && k) return MetalIndices{*eta, *k};
  return std::nullopt;
}

std::optional<float> dielectric_index(std::string_view name) {
  for (const auto& [known, index] : dielectrics) {
    if (known == name) return index;
  }
  return std::nullopt;
}

}  // namespace lockstep::mitsuba
