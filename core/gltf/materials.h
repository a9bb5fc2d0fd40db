// Materials of glTF with what surrounds the reflection model: emission, opacity, normal maps,
// transparency (specification, section 3.9).
#pragma once

#include "core/gltf/textures.h"
#include "core/scene_description.h"

#include <optional>
#include <vector>

namespace lockstep::gltf {

// What a primitive's material comes to. All surfaces are seen from both sides: `doubleSided: false`
// only asks rasterisers to cull, and a culled wall would let light in. It does make emission
// one-sided.
struct Surface {
  int material = 0;  // index of SceneDescription::materials
  std::optional<Emission> emission;
  int uv_set = 0;  // the texture coordinates that its textures use
};

// Materials enter the scene when the first primitive uses them.
struct MaterialTable {
  std::vector<std::optional<Surface>> surfaces;  // by index of Model::materials, the default's last
  TextureTable textures;
};

// The surface of material `index`, or of the default material for -1: white rough metal. Throws
// Error where the material or a texture of it does not exist.
const Surface& surface_of(Document& document, int index, MaterialTable& table,
                          SceneDescription& scene);

}  // namespace lockstep::gltf
