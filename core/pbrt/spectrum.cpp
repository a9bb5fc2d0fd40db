#include "core/pbrt/spectrum.h"

#include "core/pbrt/named_spectra.h"

#include <glm/common.hpp>
#include <glm/mat3x3.hpp>

#include <cmath>
#include <filesystem>

namespace lockstep::pbrt {

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
glm::dvec3 integrate_xyz(const Spectrum& spectrum) {
  glm::dvec3 xyz(0.0);
  for (double w = first_wavelength; w <= last_wavelength; w += step) {
    xyz += spectrum(w) * color_matching(w);
  }
  return xyz;
}

template <class Spectrum>
glm::vec3 to_rgb(const Spectrum& spectrum, ColorUse use) {
  const glm::dvec3 xyz = integrate_xyz(spectrum);
  glm::dvec3 rgb(0.0);
  if (use == ColorUse::Light) {
    if (xyz.y > 0.0) rgb = xyz_to_rgb(xyz / xyz.y);
  } else {
    rgb = xyz_to_rgb(xyz) / xyz_to_rgb(integrate_xyz([](double) { return 1.0; }));
  }
  return glm::vec3(glm::max(rgb, glm::dvec3(0.0)));
}

// Planck's law, up to a constant factor.
double black_body(double wavelength_nm, double kelvin) {
  const double w = wavelength_nm * 1e-9;
  constexpr double second_radiation_constant = 1.438776877e-2;  // m K
  return 1e-30 / (std::pow(w, 5.0) * std::expm1(second_radiation_constant / (w * kelvin)));
}

// Linear between the samples (wavelength, value), constant beyond them.
double interpolate(const std::vector<double>& samples, double wavelength) {
  if (wavelength <= samples[0]) return samples[1];
  for (size_t i = 2; i + 1 < samples.size(); i += 2) {
    if (wavelength > samples[i]) continue;
    const double t = (wavelength - samples[i - 2]) / (samples[i] - samples[i - 2]);
    return samples[i - 1] + t * (samples[i + 1] - samples[i - 1]);
  }
  return samples.back();
}

glm::vec3 from_samples(const ParameterSet& set, const Parameter& p, ColorUse use) {
  if (p.numbers.empty() || p.numbers.size() % 2 != 0) {
    fail(set.where(p), "\"spectrum " + p.name + "\" needs pairs of wavelength and value");
  }
  for (size_t i = 2; i < p.numbers.size(); i += 2) {
    if (p.numbers[i] <= p.numbers[i - 2]) {
      fail(set.where(p), "the wavelengths of \"spectrum " + p.name + "\" do not increase");
    }
  }
  return to_rgb([&](double w) { return interpolate(p.numbers, w); }, use);
}

glm::vec3 from_black_body(const ParameterSet& set, const Parameter& p) {
  const double kelvin = p.numbers[0];
  if (p.numbers.size() > 2 || kelvin <= 0.0) {
    fail(set.where(p), "\"blackbody " + p.name + "\" needs a temperature above 0 K");
  }
  // pbrt-v3 gives a scale after the temperature.
  const float scale = p.numbers.size() == 2 ? static_cast<float>(p.numbers[1]) : 1.0f;
  return scale * to_rgb([&](double w) { return black_body(w, kelvin); }, ColorUse::Light);
}

// Pairs of wavelength and value in a file; '#' starts a comment.
std::vector<double> read_samples(const std::string& path, const Location& from) {
  Lexer lexer(path, read_text(path, from));
  std::vector<double> samples;
  while (lexer.peek().kind != Token::Kind::End) samples.push_back(lexer.expect_number("a number"));
  return samples;
}

std::optional<glm::vec3> from_spectrum(const ParameterSet& set, const Parameter& p, ColorUse use,
                                       Library& library) {
  if (p.strings.empty()) return from_samples(set, p, use);
  if (const auto known = named_spectrum(p.strings[0])) return known;
  const std::string path = resolve(library, set.where().file, p.strings[0]);
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) {
    library.warnings.add(set.where(p), "the spectrum \"" + p.strings[0] +
                                           "\" is not known; the default of " + set.owner() +
                                           " is used");
    return std::nullopt;
  }
  Parameter read = p;
  read.numbers = read_samples(path, set.where(p));
  return from_samples(set, read, use);
}

}  // namespace

std::optional<glm::vec3> find_color(const ParameterSet& set, std::string_view name, ColorUse use,
                                    Library& library) {
  const Parameter* p = set.find(name, {"rgb", "color", "xyz", "float", "spectrum", "blackbody"});
  if (p == nullptr) return std::nullopt;
  if (p->type == "spectrum") return from_spectrum(set, *p, use, library);
  if (p->type == "blackbody") return from_black_body(set, *p);
  if (p->type == "float") return glm::vec3(set.get_float(name, 0.0f));
  if (p->numbers.size() != 3) {
    fail(set.where(*p), "\"" + p->type + " " + p->name + "\" must have three values");
  }
  const glm::dvec3 value(p->numbers[0], p->numbers[1], p->numbers[2]);
  return glm::vec3(p->type == "xyz" ? xyz_to_rgb(value) : value);
}

glm::vec3 get_color(const ParameterSet& set, std::string_view name, ColorUse use,
                    glm::vec3 fallback, Library& library) {
  return find_color(set, name, use, library).value_or(fallback);
}

}  // namespace lockstep::pbrt
