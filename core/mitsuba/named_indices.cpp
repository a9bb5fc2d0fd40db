#include "core/mitsuba/named_indices.h"

#include "core/pbrt/named_spectra.h"

#include <array>
#include <string>
#include <utility>

namespace lockstep::mitsuba {
namespace {

struct Metal {
  std::string_view name;
  MetalIndices indices;
};

// Beside those that pbrt names: the tables of Palik's Handbook of Optical Constants of Solids that
// Mitsuba ships, as spectrum_to_rgb() gives them.
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
