#include "core/pbrt/colors.h"

#include "core/pbrt/named_spectra.h"

#include <filesystem>
#include <vector>

namespace lockstep::pbrt {

namespace {

// Lights have luminance 1, as in pbrt-v4.
glm::vec3 to_rgb(const Spectrum& spectrum, ColorUse use) {
  return use == ColorUse::Light ? chromaticity_to_rgb(spectrum) : spectrum_to_rgb(spectrum, use);
}

glm::vec3 from_samples(const ParameterSet& set, const Parameter& p, ColorUse use) {
  if (p.numbers.empty() || p.numbers.size() % 2 != 0) {
    fail(set.where(p), "\"spectrum " + p.name + "\" needs pairs of wavelength and value");
  }
  std::vector<glm::dvec2> samples;
  for (size_t i = 0; i < p.numbers.size(); i += 2) {
    if (i > 0 && p.numbers[i] <= samples.back().x) {
      fail(set.where(p), "the wavelengths of \"spectrum " + p.name + "\" do not increase");
    }
    samples.emplace_back(p.numbers[i], p.numbers[i + 1]);
  }
  return to_rgb([&](double w) { return interpolate(samples, w); }, use);
}

glm::vec3 from_black_body(const ParameterSet& set, const Parameter& p) {
  const double kelvin = p.numbers[0];
  if (p.numbers.size() > 2 || kelvin <= 0.0) {
    fail(set.where(p), "\"blackbody " + p.name + "\" needs a temperature above 0 K");
  }
  // pbrt-v3 gives a scale after the temperature.
  const float scale = p.numbers.size() == 2 ? static_cast<float>(p.numbers[1]) : 1.0f;
  return scale * chromaticity_to_rgb([&](double w) { return black_body_radiance(w, kelvin); });
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
