#include "core/features.h"

namespace lockstep {

std::vector<std::string> feature_names(FeatureMask set) {
  constexpr const char* names[feature_count] = {
      "smooth-normals", "spheres",         "diffuse",       "conductor",   "coated",
      "quad-lights",    "triangle-lights", "sphere-lights", "environment", "point-lights",
      "spot-lights",    "distant-lights",  "light-choice",  "filter-table"};
  std::vector<std::string> result;
  for (unsigned f = 0; f < feature_count; ++f) {
    if (set >> f & 1u) result.emplace_back(names[f]);
  }
  return result;
}

}  // namespace lockstep
