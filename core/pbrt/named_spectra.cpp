#include "core/pbrt/named_spectra.h"

namespace lockstep::pbrt {

namespace {

struct Metal {
  std::string_view symbol;
  glm::vec3 eta, k;
};

// RGB indices of measured metals: the elements as published with the renderer Tungsten
// (ComplexIorData), the compounds from the tables of refractiveindex.info weighted as other
// spectra.
constexpr Metal metals[] = {
    {"Ag", {0.155265f, 0.116723f, 0.138381f}, {4.828343f, 3.122246f, 2.146950f}},
    {"Al", {1.657460f, 0.880369f, 0.521229f}, {9.223869f, 6.269523f, 4.837001f}},
    {"Au", {0.143119f, 0.374957f, 1.442479f}, {3.983160f, 2.385721f, 1.603215f}},
    {"Cu", {0.200438f, 0.924033f, 1.102212f}, {3.912949f, 2.452847f, 2.142188f}},
    {"CuZn", {0.4327f, 0.5139f, 1.1459f}, {3.5843f, 2.6947f, 1.7494f}},
    {"MgO", {1.7344f, 1.7408f, 1.7540f}, {0.0f, 0.0f, 0.0f}},
    {"TiO2", {2.8695f, 2.9546f, 3.1949f}, {0.0f, 0.0f, 0.0f}},
};

struct Spectrum {
  std::string_view name;
  glm::vec3 rgb;
};

constexpr Spectrum spectra[] = {
    // Indices from Schott's catalogue; pbrt's names of three leave out the S of the flints.
    {"glass-BK7", {1.5149f, 1.5187f, 1.5263f}},
    {"glass-BAF10", {1.6668f, 1.6733f, 1.6871f}},
    {"glass-FK51A", {1.4852f, 1.4879f, 1.4933f}},
    {"glass-LASF9", {1.8443f, 1.8563f, 1.8828f}},
    {"glass-F5", {1.6681f, 1.6775f, 1.6985f}},
    {"glass-F10", {1.7226f, 1.7341f, 1.7600f}},
    {"glass-F11", {1.7780f, 1.7917f, 1.8230f}},
    // CIE 15: chromaticities of the standard illuminants.
    {"stdillum-A", {1.8272f, 0.8316f, 0.2323f}},
    {"stdillum-D50", {1.0842f, 1.0003f, 0.7494f}},
    {"stdillum-D65", {1.0f, 1.0f, 1.0f}},
    {"stdillum-F1", {0.9612f, 1.0168f, 0.9477f}},
    {"stdillum-F2", {1.3471f, 0.9407f, 0.5656f}},
    {"stdillum-F3", {1.5834f, 0.8889f, 0.3832f}},
    {"stdillum-F4", {1.8131f, 0.8321f, 0.2692f}},
    {"stdillum-F5", {0.9223f, 1.0338f, 0.8940f}},
    {"stdillum-F6", {1.3232f, 0.9555f, 0.4890f}},
    {"stdillum-F7", {1.0038f, 0.9987f, 1.0013f}},
    {"stdillum-F8", {1.1766f, 0.9755f, 0.7228f}},
    {"stdillum-F9", {1.3774f, 0.9311f, 0.5718f}},
    {"stdillum-F10", {1.1763f, 0.9756f, 0.7224f}},
    {"stdillum-F11", {1.4109f, 0.9248f, 0.5352f}},
    {"stdillum-F12", {1.7683f, 0.8450f, 0.2734f}},
    {"illum-acesD60", {1.0456f, 0.9950f, 0.9152f}},
};

// "metal-Cu-eta" or "spds/Cu.eta.spd".
std::optional<glm::vec3> metal_index(std::string_view name) {
  if (const size_t slash = name.rfind('/'); slash != name.npos) name.remove_prefix(slash + 1);
  if (name.starts_with("metal-")) name.remove_prefix(6);
  if (name.ends_with(".spd")) name.remove_suffix(4);
  const size_t symbol = name.find_first_of("-.");
  if (symbol == name.npos) return std::nullopt;
  const std::string_view quantity = name.substr(symbol + 1);
  for (const Metal& metal : metals) {
    if (metal.symbol != name.substr(0, symbol)) continue;
    if (quantity == "eta") return metal.eta;
    if (quantity == "k") return metal.k;
  }
  return std::nullopt;
}

}  // namespace

std::optional<glm::vec3> named_spectrum(std::string_view name) {
  for (const Spectrum& known : spectra) {
    if (known.name == name) return known.rgb;
  }
  return metal_index(name);
}

}  // namespace lockstep::pbrt
