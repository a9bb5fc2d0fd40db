#include "core/features.h"

namespace lockstep {

std::vector<std::string> feature_names(FeatureMask set) {
  constexpr const char* names[feature_count] = {
      "smooth-normals", "spheres",         "instances",     "diffuse",
      "conductor",      "coated",          "rough-diffuse", "diffuse-transmission",
      "dielectric",     "principled",      "measured",      "mix",
      "quad-lights",    "triangle-lights", "disk-lights",   "sphere-lights",
      "environment",    "environment-map", "point-lights",  "spot-lights",
      "distant-lights", "textured-lights", "light-choice",  "textures",
      "tangents",       "surface-maps",    "trilinear",     "opacity",
      "one-sided",      "absorption",      "filter-table",  "filter-signs",
      "lens",           "orthographic",    "compensation"};
  std::vector<std::string> result;
  for (unsigned f = 0; f < feature_count; ++f) {
    if (set >> f & 1u) result.emplace_back(names[f]);
  }
  return result;
}

}  // namespace lockstep
