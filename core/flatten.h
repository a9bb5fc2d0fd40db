// From a scene description to the flat arrays that Embree and the kernels read.
#pragma once

#include "core/scene.h"

#include <vector>

namespace lockstep {

struct FlatGeometry {
  std::int32_t first_triangle = 0;
  std::int32_t triangle_count = 0;
  bool is_sphere = false;
};

// Which share of a surface is there (see Material::opacity).
struct Opacity {
  float value = 1.0f;      // where the binding has no texture
  TextureBinding binding;  // column unused
  float cutoff = 0.0f;

  bool has_holes() const { return value < 1.0f || binding.texture >= 0; }
};

// Geometries [first_geometry, first_geometry + geometry_count), in a space of their own.
struct FlatObject {
  std::uint32_t first_geometry = 0, geometry_count = 0;
};

struct FlatInstance {
  int object = 0;  // index of FlatScene::objects
  glm::mat4 to_world{1.0f};
};

struct FlatScene {
  std::vector<float> positions;          // xyz per vertex, and one vertex of padding for Embree
  std::vector<float> normals;            // xyz per vertex; empty where no mesh is smooth
  std::vector<float> uvs;                // two per vertex; empty where nothing reads them
  std::vector<std::int32_t> triangles;   // three indices each, over all meshes, and one of padding
  std::vector<FlatGeometry> geometries;  // of the scene, then of each object
  std::vector<FlatObject> objects;
  std::vector<FlatInstance> instances;
  std::vector<float> instance_rows;
  std::vector<std::int32_t> geometry_rows;
  std::vector<std::uint8_t> coincident;  // see core/coincidence.h
  std::vector<float> spheres;            // centre and radius per geometry
  std::vector<std::int32_t> material_kinds;
  std::vector<float> material_parameters;
  std::vector<std::int32_t> material_maps;
  std::vector<float> boundary_etas;  // of the tables that the materials refer to
  std::vector<float> measured;       // the materials' tables, one after the other
  std::vector<TextureBinding> texture_bindings;
  std::vector<FeatureMask>
      material_features;           // that hits on each material need, mixes' parts aside
  std::vector<Opacity> opacities;  // per material
  std::vector<std::int32_t> light_of_primitive;
  std::vector<std::int32_t> light_kinds;
  std::vector<float> light_rows;
  std::vector<float> glow_rows;  // of LightTable::glows
  std::vector<float> light_cdf;
  std::int32_t environment_light = -1;
  FeatureMask features = 0;
  CameraData camera;
  std::vector<float> filter_x, filter_y;
  std::vector<float> filter_weight_x, filter_weight_y;
};

// All but `coincident`, which the caller may search for beside other work.
// `environment_radiance`: mean over the sphere where the environment is a map. `textures`: those of
// the description; without them, textured emission counts as white where lights are weighed.
FlatScene flatten(const SceneDescription& description, glm::vec3 environment_radiance = {},
                  const TextureTable& textures = {});

// Of all arrays.
std::size_t memory_bytes(const FlatScene& flat);

// Of every number in `flat`: scenes that differ anywhere have different fingerprints.
std::uint64_t fingerprint(const FlatScene& flat);

// Pointers into `flat`, which must outlive them. The Embree scene, textures and the environment map
// are left for the caller to set.
SceneData view(const FlatScene& flat);

// core/flatten_materials.cpp: fills the material tables, one row per material.
// Throws Error where a mix contains itself or a material, or another refers to a table, that does
// not exist.
void flatten_materials(const SceneDescription& description, FlatScene& flat);

// The binding of an input to its texture.
TextureBinding binding_of(const ColorInput& input, int column);
TextureBinding binding_of(const FloatInput& input, int column);

// core/flatten_lights.cpp: fills the light tables from the emitting shapes and the environment.
// Call once the geometry tables are filled.
void flatten_lights(const SceneDescription& description, glm::vec3 environment_radiance,
                    const TextureTable& textures, FlatScene& flat);

// core/flatten_camera.cpp. Throws Error for pixel filters whose negative lobes nearly outweigh
// them.
void flatten_camera(const CameraDescription& camera, const FilmDescription& film, FlatScene& flat);

}  // namespace lockstep
