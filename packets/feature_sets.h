// Sets of features that kernels are compiled for besides the general one: what scenes often have.
// A scene runs on the smallest set that holds all its features.
#pragma once

#include "core/features.h"

namespace lockstep {

// Diffuse meshes under quad lights: boxes, scans, throughput scenes.
inline constexpr FeatureMask quad_lit = feature_set(Feature::SmoothNormals, Feature::Diffuse,
                                                    Feature::QuadLights, Feature::FilterTable);

// Diffuse meshes under a sky.
inline constexpr FeatureMask sky_lit = feature_set(Feature::SmoothNormals, Feature::Diffuse,
                                                   Feature::Environment, Feature::FilterTable);

// Rooms: all materials on meshes, some quad lights.
inline constexpr FeatureMask interior =
    quad_lit | feature_set(Feature::Conductor, Feature::Coated, Feature::LightChoice);

}  // namespace lockstep
