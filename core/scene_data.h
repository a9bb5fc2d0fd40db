// A scene as the kernels see it: plain arrays, indices instead of pointers between objects. Owned
// by Scene; the same for every instruction set and width.
#pragma once

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

struct MaterialTable {
  const std::int32_t* kinds = nullptr;
  const float* parameters = nullptr;
};

// Rows of LightTable::rows, `light_stride` floats each:
//   0 corner (centre of a sphere), 3 edge 1, 6 edge 2, 9 unit normal, 12 radiance,
//   15 area (radius of a sphere), 16 probability of choosing this light,
//   17 side: +1 emits along the normal (outwards), -1 against it, 0 on both sides.
enum class LightKind : std::int32_t { Parallelogram, Triangle, Sphere, Environment };
inline constexpr int light_stride = 20;

struct LightTable {
  int count = 0;
  const std::int32_t* kinds = nullptr;
  const float* rows = nullptr;
  const float* cdf = nullptr;  // cdf[i] = probability of choosing a light below i; count + 1 values
};

// Per Embree geometry id.
struct GeometryTable {
  const std::int32_t* first_triangle = nullptr;  // of the global triangle array; 0 for spheres
  const std::int32_t* material = nullptr;
  const std::int32_t* first_light = nullptr;  // into light_of_primitive; -1: does not emit
  const std::int32_t* is_sphere = nullptr;
  const std::int32_t* is_smooth = nullptr;  // has vertex normals
  const float* spheres = nullptr;           // centre and radius, 4 floats; zero for meshes
};

// Inverse distribution function of the pixel filter along x and y: offsets in pixels at
// u = i / filter_cells, to be interpolated linearly.
inline constexpr int filter_cells = 256;

struct CameraData {
  glm::vec3 origin{0.0f};
  glm::vec3 right{0.0f}, down{0.0f};  // world-space step per pixel
  glm::vec3 corner{0.0f};             // direction (not unit) of the top left corner of pixel (0, 0)
  int width = 0, height = 0;
  bool box_filter = true;  // of radius 1/2: no table needed
  const float* filter_x = nullptr;
  const float* filter_y = nullptr;
};

struct SceneData {
  void* embree_scene = nullptr;             // RTCScene
  const std::int32_t* triangles = nullptr;  // three vertex indices each
  const float* positions = nullptr;         // per vertex
  const float* normals = nullptr;           // per vertex
  const std::int32_t* light_of_primitive = nullptr;
  GeometryTable geometry;
  MaterialTable materials;
  LightTable lights;
  CameraData camera;
  std::int32_t environment = -1;  // its index in lights; -1: none
  // Which stages the scene needs at all (see Features).
  bool smooth_normals = false;
  bool spheres = false;
  bool area_lights = false;
  bool has_material[material_kinds] = {};
};

}  // namespace lockstep
