// What a scene contains, as a set of bits: kernels skip what a scene lacks, and those compiled for
// a smaller set do not contain the code at all.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace lockstep {

// In the order of MaterialKind and of LightKind where they name those.
enum class Feature : unsigned {
  SmoothNormals,
  Spheres,
  Instances,
  Diffuse,
  Conductor,
  Coated,
  RoughDiffuse,
  DiffuseTransmission,
  Dielectric,
  Principled,
  Measured,
  Mix,
  QuadLights,
  TriangleLights,
  DiskLights,
  SphereLights,
  Environment,  // constant
  EnvironmentMap,
  PointLights,
  SpotLights,
  DistantLights,
  TexturedLights,
  LightChoice,  // more than one light: one has to be chosen
  Textures,     // of materials
  Tangents,     // frames along the texture coordinates: for anisotropic materials
  SurfaceMaps,  // normal and bump maps
  Trilinear,    // images that are looked up by the footprint of a pixel
  Opacity,      // surfaces with holes; traversal alone sees them
  OneSided,     // materials whose back absorbs
  Absorption,   // inside dielectrics
  FilterTable,  // a pixel filter other than a box over the pixel
  FilterSigns,  // one with negative lobes
  Lens,
  Orthographic,
  Compensation,  // of what rough materials lose between their facets
};
inline constexpr unsigned feature_count = 35;

using FeatureMask = std::uint64_t;
static_assert(feature_count < 64);
inline constexpr FeatureMask all_features = (FeatureMask(1) << feature_count) - 1;

constexpr FeatureMask bit(Feature f) { return FeatureMask(1) << unsigned(f); }

template <class... F>
constexpr FeatureMask feature_set(F... f) {
  return (FeatureMask(0) | ... | bit(f));
}

// Names of the features in the set, in the order above.
std::vector<std::string> feature_names(FeatureMask set);

}  // namespace lockstep
