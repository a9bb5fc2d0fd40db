// A scene as the kernels see it: plain arrays, indices instead of pointers between objects. Owned
// by Scene; the same for every instruction set and width. Kernels read rows four values at a time:
// every array has three values more than it needs.
#pragma once

#include "core/features.h"

#include <glm/vec3.hpp>

#include <cstdint>

namespace lockstep {

// Rows of MaterialTable::parameters, `material_stride` floats each, by kind:
//   diffuse    0 reflectance
//   conductor  0 eta, 3 k, 6 alpha x, 7 alpha y
//   coated     0 diffuse, 3 specular, 6 alpha, 7 eta, 8 layered (0 or 1), 9 inner reflectance
enum class MaterialKind : std::int32_t { Diffuse, Conductor, Coated };
inline constexpr int material_kinds = 3;
inline constexpr int material_stride = 12;

constexpr Feature material_feature(MaterialKind kind) {
  return Feature(unsigned(Feature::Diffuse) + unsigned(kind));
}

struct MaterialTable {
  const float* parameters = nullptr;
};

// Rows of LightTable::rows, `light_stride` floats each:
//   0 corner (centre of a sphere), 3 area (radius of a sphere)
//   4 edge 1, 7 probability of choosing this light
//   8 edge 2, 11 side: +1 emits along the normal (outwards), -1 against it, 0 on both sides
//   12 unit normal, 15 LightKind as a number
//   16 radiance
// Point and spot lights: 0 position, 16 intensity; spot lights: 4 cosines of the inner and outer
// cone and SpotLight::Falloff as a number, 8 those cones' angles, 12 axis. Distant lights: 12 direction in which light
// travels, 16 irradiance.
enum class LightKind : std::int32_t {
  Parallelogram,
  Triangle,
  Sphere,
  Environment,
  Point,
  Spot,
  Distant
};
inline constexpr int light_stride = 20;

constexpr Feature light_feature(LightKind kind) {
  return Feature(unsigned(Feature::QuadLights) + unsigned(kind));
}

struct LightTable {
  int count = 0;
  const float* rows = nullptr;
  const float* cdf = nullptr;  // cdf[i] = probability of choosing a light below i; count + 1 values
};

// Rows per Embree geometry id, `geometry_stride` integers each:
//   0 first triangle in the global array; 0 for spheres
//   1 material
//   2 first entry in light_of_primitive; -1: does not emit
//   3 GeometryFlag bits, and the MaterialKind above them
inline constexpr int geometry_stride = 4;

enum GeometryFlag : std::int32_t { geometry_is_sphere = 1, geometry_is_smooth = 2 };
inline constexpr int geometry_kind_shift = 8;

struct GeometryTable {
  const std::int32_t* rows = nullptr;
  const float* spheres = nullptr;  // centre and radius, 4 floats per geometry; zero for meshes
};

// Inverse distribution function of the pixel filter along x and y: offsets in pixels at
// u = i / filter_cells, to be interpolated linearly. None for a box over the pixel.
inline constexpr int filter_cells = 256;

struct CameraData {
  glm::vec3 origin{0.0f};
  glm::vec3 right{0.0f}, down{0.0f};  // world-space step per pixel
  glm::vec3 corner{0.0f};             // direction (not unit) of the top left corner of pixel (0, 0)
  int width = 0, height = 0;
  const float* filter_x = nullptr;
  const float* filter_y = nullptr;
};

struct SceneData {
  void* embree_scene = nullptr;             // RTCScene
  const std::int32_t* triangles = nullptr;  // three vertex indices each
  const float* positions = nullptr;         // per vertex
  const float* normals = nullptr;           // per vertex
  const std::int32_t* light_of_primitive = nullptr;
  const std::uint8_t* coincident = nullptr;  // per triangle, 1: overlaps another; or no array
  GeometryTable geometry;
  MaterialTable materials;
  LightTable lights;
  CameraData camera;
  std::int32_t environment = -1;  // its index in lights; -1: none
  FeatureMask features = all_features;
};

// True where the scene has the feature; false at compile time in kernels for F, a set without it.
template <FeatureMask F>
constexpr bool needs(const SceneData& scene, Feature feature) {
  return (F & bit(feature)) != 0u && (scene.features & bit(feature)) != 0u;
}

inline constexpr FeatureMask area_light_features =
    feature_set(Feature::QuadLights, Feature::TriangleLights, Feature::SphereLights);
inline constexpr FeatureMask material_features =
    feature_set(Feature::Diffuse, Feature::Conductor, Feature::Coated);

// Lights that no ray can hit.
inline constexpr FeatureMask delta_light_features =
    feature_set(Feature::PointLights, Feature::SpotLights, Feature::DistantLights);

template <FeatureMask F>
constexpr bool has_delta_lights(const SceneData& scene) {
  return (F & scene.features & delta_light_features) != 0u;
}

template <FeatureMask F>
constexpr bool has_area_lights(const SceneData& scene) {
  return (F & scene.features & area_light_features) != 0u;
}

}  // namespace lockstep
