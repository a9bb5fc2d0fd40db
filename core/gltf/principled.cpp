#include "core/gltf/principled.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>

namespace lockstep::gltf {

namespace {

float share(double value) { return static_cast<float>(std::clamp(value, 0.0, 1.0)); }

// A factor in [0, 1] times a channel of a texture with data.
FloatInput scaled(MaterialReader& reader, double factor, const TextureUse& use, int channel) {
  FloatInput input(share(factor));
  if (input.value == 0.0f) return input;
  input.texture = texture_index(reader, use, TextureEncoding::Linear);
  if (input.texture >= 0) input.channel = channel;
  return input;
}

FloatInput scaled(MaterialReader& reader, const tinygltf::Value& extension, const std::string& stem,
                  float fallback, int channel) {
  return scaled(reader, double(get_number(extension, stem + "Factor", fallback)),
                texture_use(extension, stem + "Texture"), channel);
}

// GGX's alpha is the square of glTF's roughness (appendix B.2.3), texture and all.
FloatInput alpha_of(FloatInput roughness) {
  roughness.value *= roughness.value;
  if (roughness.texture >= 0) roughness.power = 2.0f;
  return roughness;
}

// KHR_materials_ior. An index of 0 stands for full reflection everywhere; 100 has 96 % and more.
float index_of_refraction(const MaterialReader& reader) {
  const tinygltf::Value* extension = reader.extension("KHR_materials_ior");
  const float ior = extension != nullptr ? get_number(*extension, "ior", 1.5f) : 1.5f;
  if (ior == 0.0f) return 100.0f;
  if (ior >= 1.0f) return std::min(ior, 100.0f);
  reader.warn("an ior below 1 is not valid; 1 is used");
  return 1.0f;
}

void set_specular(MaterialReader& reader, PrincipledMaterial& m) {
  const tinygltf::Value* extension = reader.extension("KHR_materials_specular");
  if (extension == nullptr) return;
  m.specular = scaled(reader, *extension, "specular", 1.0f, 3);
  const glm::vec3 color = get_vec3(*extension, "specularColorFactor", glm::vec3(1.0f));
  if (color == glm::vec3(1.0f) && texture_use(*extension, "specularColorTexture").texture < 0)
    return;
  reader.warn("specular colours are not supported; the luminance of the factor is used");
  m.specular.value *= share(double(glm::dot(color, glm::vec3(0.2126f, 0.7152f, 0.0722f))));
}

void set_coat(MaterialReader& reader, PrincipledMaterial& m) {
  const tinygltf::Value* extension = reader.extension("KHR_materials_clearcoat");
  if (extension == nullptr) return;
  m.coat = scaled(reader, *extension, "clearcoat", 0.0f, 0);
  m.coat_alpha = alpha_of(scaled(reader, *extension, "clearcoatRoughness", 0.0f, 1));
  if (texture_use(*extension, "clearcoatNormalTexture").texture >= 0) {
    reader.warn("normal maps of coats are not supported; coats follow the surface");
  }
}

void set_transmission(MaterialReader& reader, PrincipledMaterial& m) {
  const tinygltf::Value* extension = reader.extension("KHR_materials_transmission");
  if (extension != nullptr) m.transmission = scaled(reader, *extension, "transmission", 0.0f, 0);
}

PrincipledMaterial metallic_roughness(MaterialReader& reader) {
  const tinygltf::PbrMetallicRoughness& pbr = reader.source.pbrMetallicRoughness;
  const TextureUse data = texture_use(pbr.metallicRoughnessTexture);
  PrincipledMaterial m;
  m.base_color = base_color(reader);
  m.metallic = scaled(reader, pbr.metallicFactor, data, 2);
  m.alpha = alpha_of(scaled(reader, pbr.roughnessFactor, data, 1));
  return m;
}

// KHR_materials_pbrSpecularGlossiness without its coloured reflection.
PrincipledMaterial specular_glossiness(MaterialReader& reader, const tinygltf::Value& extension) {
  reader.warn("specular-glossiness materials are approximated by dielectric ones");
  PrincipledMaterial m;
  m.base_color = base_color(reader);
  m.metallic = FloatInput(0.0f);
  m.alpha =
      alpha_of(FloatInput(1.0f - share(double(get_number(extension, "glossinessFactor", 1.0f)))));
  return m;
}

}  // namespace

int texture_index(MaterialReader& reader, const TextureUse& use, TextureEncoding encoding) {
  const int index = scene_texture(reader.document, use, encoding, reader.textures, reader.scene);
  if (index < 0) return index;
  if (!reader.uv_set) reader.uv_set = use.uv_set;
  if (*reader.uv_set != use.uv_set) {
    reader.warn(
        "textures of one material with different texture coordinates are not supported; "
        "those of the first are used");
  }
  return index;
}

Base base_of(const MaterialReader& reader) {
  Base base;
  if (const tinygltf::Value* glossy = reader.extension("KHR_materials_pbrSpecularGlossiness")) {
    base.factor = get_vec4(*glossy, "diffuseFactor", base.factor);
    base.texture = texture_use(*glossy, "diffuseTexture");
  } else {
    const tinygltf::PbrMetallicRoughness& pbr = reader.source.pbrMetallicRoughness;
    for (int c = 0; c < 4; ++c) base.factor[c] = to_float(pbr.baseColorFactor[size_t(c)]);
    base.texture = texture_use(pbr.baseColorTexture);
  }
  base.factor = glm::clamp(base.factor, 0.0f, 1.0f);
  return base;
}

ColorInput base_color(MaterialReader& reader) {
  const Base base = base_of(reader);
  return {glm::vec3(base.factor), texture_index(reader, base.texture, TextureEncoding::Srgb)};
}

PrincipledMaterial principled(MaterialReader& reader) {
  const tinygltf::Value* glossy = reader.extension("KHR_materials_pbrSpecularGlossiness");
  PrincipledMaterial m =
      glossy != nullptr ? specular_glossiness(reader, *glossy) : metallic_roughness(reader);
  m.eta = index_of_refraction(reader);
  set_specular(reader, m);
  set_coat(reader, m);
  set_transmission(reader, m);
  return m;
}

}  // namespace lockstep::gltf
