// glTF's metallic-roughness model and the extensions of it as PrincipledMaterial (specification,
// section 3.9 and appendix B).
#pragma once

#include "core/gltf/extensions.h"
#include "core/gltf/textures.h"
#include "core/scene_description.h"

#include <glm/vec4.hpp>

#include <optional>
#include <string>

namespace lockstep::gltf {

// One material on its way into the scene.
struct MaterialReader {
  Document& document;
  const tinygltf::Material& source;
  std::string name;
  TextureTable& textures;
  SceneDescription& scene;
  std::optional<int> uv_set;  // of the textures so far

  void warn(const std::string& what) const { document.warnings.add(name, what); }
  // nullptr where the material does not have the extension.
  const tinygltf::Value* extension(const char* extension_name) const {
    return find_extension(source.extensions, extension_name);
  }
};

// The texture's index in the scene, or -1 for none; warns where its texture coordinates are not
// those of the material's others.
int texture_index(MaterialReader& reader, const TextureUse& use, TextureEncoding encoding);

// Colour and alpha, which the archived model KHR_materials_pbrSpecularGlossiness calls diffuse.
struct Base {
  glm::vec4 factor{1.0f};
  TextureUse texture;
};

Base base_of(const MaterialReader& reader);
ColorInput base_color(MaterialReader& reader);

PrincipledMaterial principled(MaterialReader& reader);

}  // namespace lockstep::gltf
