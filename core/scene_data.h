// A scene as the kernels see it: plain arrays, indices instead of pointers between objects. Owned
// by Scene; the same for every instruction set and width. Kernels read rows four values at a time:
// every array has three values more than it needs.
#pragma once

#include "core/environment_map_data.h"
#include "core/features.h"
#include "core/texture_data.h"

#include <glm/vec3.hpp>

#include <cstdint>

namespace lockstep {

// Rows of MaterialTable::parameters, `material_stride` floats each, by kind; core/bsdf/ says more:
//   Diffuse              0 reflectance
//   Conductor            0 eta, 3 k, 6 alpha x, 7 alpha y, 8 specular
//   Coated               0 diffuse, 3 specular, 6 alpha, 7 eta, 8 layered, 9 inner reflectance,
//                        10 thickness, 11 reflections
//   RoughDiffuse         0 reflectance, 3 sigma
//   DiffuseTransmission  0 reflectance, 3 transmittance
//   Dielectric           0 reflectance, 3 transmittance, 6 alpha x, 7 alpha y, 8 eta, 9 thin,
//                        10 absorption
//   Principled           0 base colour, 3 metallic, 4 alpha, 5 eta, 6 specular, 7 transmission,
//                        8 coat, 9 coat alpha, 10 thin
//   Measured             0 number of its table
//   Mix                  0 first material, 1 second, 2 share of the second
// In each, column boundary_column is the number of its table of MaterialTable::boundary_albedo; 0
// where it has none.
// Mixes never reach shading: each path goes on with one of their parts.
enum class MaterialKind : std::int32_t {
  Diffuse,
  Conductor,
  Coated,
  RoughDiffuse,
  DiffuseTransmission,
  Dielectric,
  Principled,
  Measured,
  Mix
};
inline constexpr int material_kinds = 9;
inline constexpr int material_stride = 16;
inline constexpr int boundary_column = 15;

constexpr Feature material_feature(MaterialKind kind) {
  return Feature(unsigned(Feature::Diffuse) + unsigned(kind));
}

// Columns [column, column + columns) of a row that come from a texture: `scale` times its colour,
// or times a number taken from it.
struct TextureBinding {
  std::int32_t texture = -1;
  std::int32_t column = 0, columns = 3;
  bool is_color = true;
  std::int32_t channel = -1;  // as FloatInput has them
  float power = 1.0f;
  glm::vec3 scale{1.0f};
};

// Rows of MaterialTable::maps, `map_stride` integers each: 0 first binding, 1 their number,
// 2 binding of the normal map (scale.x: of the map's x and y), 3 of the bump map; -1: none.
inline constexpr int map_stride = 4;

struct MaterialTable {
  const float* parameters = nullptr;
  const std::int32_t* kinds = nullptr;  // MaterialKind
  const std::int32_t* maps = nullptr;
  const TextureBinding* bindings = nullptr;
  const float* ggx_albedo = nullptr;       // core/ggx_albedo.h; none: single scattering only
  const float* boundary_albedo = nullptr;  // tables of core/boundary_albedo.h; as above
  const float* measured = nullptr;         // measured_count tables of core/measured_table.h
  std::int32_t measured_count = 0;
};

// Rows of LightTable::rows, `light_stride` floats each:
//   0 corner (centre of a sphere), 3 area (radius of a sphere)
//   4 edge 1, 7 probability of choosing this light
//   8 edge 2, 11 side: +1 emits along the normal (outwards), -1 against it, 0 on both sides
//   12 unit normal, 15 LightKind as a number
//   16 radiance, 19 of a parallelogram: 1 if it is a rectangle; of a disk: its corners
// A disk is the regular polygon that stands for it, or that polygon stretched: 0 its centre, 4 and
// 8 the half axes, the first to a corner.
// Point and spot lights: 0 position, 16 intensity; spot lights: 4 cosines of the inner and outer
// cone and SpotLight::Falloff as a number, 8 those cones' angles, 12 axis. Distant lights:
// 12 direction in which light travels, 16 irradiance. Environment maps have no more than their
// row's number and probability. Triangles with textured emission: 19 the number of their row of
// `glows`, counted from 1. Glow, textured emission of spheres and of surfaces with holes, is never
// chosen, only found: 4 the number of its radiance's TextureBinding; else like the flat light, of
// area 0, or the sphere that it is on.
enum class LightKind : std::int32_t {
  Parallelogram,
  Triangle,
  Disk,
  Sphere,
  Environment,
  EnvironmentMap,
  Point,
  Spot,
  Distant,
  Glow
};
inline constexpr int light_stride = 20;

// Rows of LightTable::glows, `glow_stride` floats each: 0, 2 and 4 the triangle's corners on the
// texture, 6 the number of its radiance's TextureBinding. The last one is padding.
inline constexpr int glow_stride = 8;

constexpr Feature light_feature(LightKind kind) {
  return Feature(unsigned(Feature::QuadLights) + unsigned(kind));
}

struct LightTable {
  int count = 0;
  const float* rows = nullptr;
  const float* cdf = nullptr;  // cdf[i] = probability of choosing a light below i; count + 1 values
  const float* glows = nullptr;
};

// Rows per Embree geometry id, `geometry_stride` integers each:
//   0 first triangle in the global array; 0 for spheres
//   1 material
//   2 first entry in light_of_primitive; -1: does not emit
//   3 GeometryFlag bits, and the MaterialKind above them
inline constexpr int geometry_stride = 4;

enum GeometryFlag : std::int32_t {
  geometry_is_sphere = 1,
  geometry_is_smooth = 2,
  geometry_has_uvs = 4,       // else each triangle has (0, 0), (1, 0) and (1, 1)
  geometry_is_one_sided = 8,  // its back absorbs
};
inline constexpr int geometry_kind_shift = 8;

struct GeometryTable {
  const std::int32_t* rows = nullptr;
  const float* spheres = nullptr;  // centre and radius, 4 floats per geometry; zero for meshes
};

// Inverse distribution function of the pixel filter's magnitude along x and y: offsets in pixels at
// u = i / filter_cells, to be interpolated linearly. None for a box over the pixel. Where the
// filter has negative lobes a sample of a cell counts by the cell's weight: the filter's integral
// over it, relative to the share of samples that it gets. The weights of all cells have mean 1.
inline constexpr int filter_cells = 256;

// Of the distance between pixels, what textures are filtered over: see core/texture_footprint.h.
inline constexpr float footprint_scale = 0.125f;

// Orthographic: rays start at `corner` plus steps and go along `origin`, a unit vector.
struct CameraData {
  glm::vec3 origin{0.0f};
  glm::vec3 right{0.0f}, down{0.0f};  // world-space step per pixel
  glm::vec3 corner{0.0f};             // direction (not unit) of the top left corner of pixel (0, 0)
  glm::vec3 lens_x{0.0f}, lens_y{0.0f};  // half axes of the lens
  float focal_distance = 1.0f;           // where it is sharp, in lengths of `corner`'s direction
  float footprint = 0.0f;  // footprint_scale pixels, at distance 1 where it grows with distance
  int width = 0, height = 0;
  const float* filter_x = nullptr;
  const float* filter_y = nullptr;
  const float* filter_weight_x = nullptr;
  const float* filter_weight_y = nullptr;
};

// Rows per instance, `instance_stride` floats each, after the identity for what is no instance:
// 0 three rows of the matrix to the world, each with its translation last; 12 three rows of its
// inverse transpose, for normals, the first with the sign of its determinant last.
inline constexpr int instance_stride = 24;

struct InstanceTable {
  std::int32_t first_id = 0;  // Embree's number of the first one
  const float* rows = nullptr;
};

struct SceneData {
  void* embree_scene = nullptr;             // RTCScene
  const std::int32_t* triangles = nullptr;  // three vertex indices each
  const float* positions = nullptr;         // per vertex
  const float* normals = nullptr;           // per vertex
  const float* uvs = nullptr;               // two per vertex
  const std::int32_t* light_of_primitive = nullptr;
  const std::uint8_t* coincident = nullptr;  // per triangle, 1: overlaps another; or no array
  GeometryTable geometry;
  InstanceTable instances;
  MaterialTable materials;
  TextureTable textures;
  LightTable lights;
  EnvironmentMapData environment_map;
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
    feature_set(Feature::QuadLights, Feature::TriangleLights, Feature::DiskLights,
                Feature::SphereLights, Feature::TexturedLights);
inline constexpr FeatureMask material_features = feature_set(
    Feature::Diffuse, Feature::Conductor, Feature::Coated, Feature::RoughDiffuse,
    Feature::DiffuseTransmission, Feature::Dielectric, Feature::Principled, Feature::Measured);

// Lights that no ray can hit.
inline constexpr FeatureMask delta_light_features =
    feature_set(Feature::PointLights, Feature::SpotLights, Feature::DistantLights);

// What makes a hit's texture coordinates worth knowing.
inline constexpr FeatureMask uv_features =
    feature_set(Feature::Textures, Feature::Tangents, Feature::SurfaceMaps);

// Any of the features in `set`.
template <FeatureMask F>
constexpr bool needs_any(const SceneData& scene, FeatureMask set) {
  return (F & scene.features & set) != 0u;
}

}  // namespace lockstep
