// Textures of glTF materials: images, samplers and KHR_texture_transform.
#pragma once

#include "core/gltf/document.h"
#include "core/scene_description.h"

#include <glm/vec2.hpp>

#include <array>
#include <map>
#include <string>
#include <tuple>

namespace lockstep::gltf {

// A material's reference to a texture.
struct TextureUse {
  int texture = -1;  // index of Model::textures; -1: none
  int uv_set = 0;    // the mesh's TEXCOORD_n
  UvTransform uv;
};

TextureUse texture_use(const tinygltf::TextureInfo& info);
TextureUse texture_use(const tinygltf::NormalTextureInfo& info);

// A reference in an extension's object.
TextureUse texture_use(const tinygltf::Value& object, const std::string& name);

// Entries of SceneDescription::textures by texture, encoding and transform.
using TextureTable = std::map<std::tuple<int, TextureEncoding, std::array<float, 6>>, int>;

// The index of the texture in `scene`, where it is added at its first use; -1 for none, and with a
// warning for images of a kind that is not supported. Throws Error where the file refers to what it
// does not have. External images are not opened.
int scene_texture(Document& document, const TextureUse& use, TextureEncoding encoding,
                  TextureTable& table, SceneDescription& scene);

}  // namespace lockstep::gltf
