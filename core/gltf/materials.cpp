#include "core/gltf/materials.h"

#include "core/gltf/principled.h"

#include <glm/common.hpp>
#include <glm/exponential.hpp>

#include <algorithm>
#include <string>
#include <utility>

namespace lockstep::gltf {

namespace {

// The inside of a transparent material. Without KHR_materials_volume its walls are thin; the
// thickness itself is for rasterisers, as here the geometry has it.
struct Volume {
  bool thin = true;
  glm::vec3 absorption{0.0f};
};

Volume volume_of(const MaterialReader& reader) {
  Volume volume;
  const tinygltf::Value* extension = reader.extension("KHR_materials_volume");
  if (extension == nullptr || !(get_number(*extension, "thicknessFactor", 0.0f) > 0.0f)) {
    return volume;
  }
  volume.thin = false;
  // Of white light, attenuationColor is left after attenuationDistance.
  const float distance = get_number(*extension, "attenuationDistance", 0.0f);
  const glm::vec3 color = get_vec3(*extension, "attenuationColor", glm::vec3(1.0f));
  if (distance > 0.0f) {
    volume.absorption = -glm::log(glm::clamp(color, 1e-6f, 1.0f)) / std::max(distance, 1e-12f);
  }
  return volume;
}

DielectricMaterial dielectric(const PrincipledMaterial& m, const Volume& volume) {
  DielectricMaterial glass;
  glass.eta = m.eta;
  glass.thin = volume.thin;
  glass.absorption = volume.absorption;
  glass.transmittance = m.base_color;
  glass.reflectance = ColorInput(glm::vec3(m.specular.value));
  const bool textured = m.alpha.texture >= 0;
  glass.alpha = glm::vec2(textured ? 1.0f : m.alpha.value);
  if (textured) glass.alpha_scale = m.alpha;
  return glass;
}

bool is_constant(const FloatInput& input, float value) {
  return input.texture < 0 && input.value == value;
}

void set_normal_map(MaterialReader& reader, Material& material) {
  const tinygltf::NormalTextureInfo& info = reader.source.normalTexture;
  material.normal_map = texture_index(reader, texture_use(info), TextureEncoding::Linear);
  material.normal_scale = to_float(info.scale);
}

int append(MaterialReader& reader, Material material) {
  set_normal_map(reader, material);
  reader.scene.materials.push_back(std::move(material));
  return static_cast<int>(reader.scene.materials.size()) - 1;
}

// Wholly transparent materials are dielectrics, which may be thin and absorb. Partly transparent
// ones share their surface with one; only where the walls are a plain solid's, or partly metal, do
// they stay in the principled model.
Material with_transmission(MaterialReader& reader, PrincipledMaterial m) {
  if (is_constant(m.transmission, 0.0f)) return m;
  const Volume volume = volume_of(reader);
  const bool plain = !volume.thin && volume.absorption == glm::vec3(0.0f);
  if (!is_constant(m.metallic, 0.0f)) {
    if (!plain) {
      reader.warn("thin walls and absorption of partly metallic materials are not supported");
    }
    return m;
  }
  const bool whole = is_constant(m.transmission, 1.0f);
  if (!whole && plain) return m;
  if (!is_constant(m.coat, 0.0f)) {
    reader.warn("coats of transparent materials are not supported; they are left out");
  }
  const DielectricMaterial glass = dielectric(m, volume);
  if (whole) return glass;
  MixMaterial mix;
  mix.amount = std::exchange(m.transmission, FloatInput(0.0f));
  mix.first = append(reader, m);
  mix.second = append(reader, glass);
  return mix;
}

// The base colour's alpha: a share of the surface, or a cutoff.
void set_opacity(MaterialReader& reader, Material& material) {
  const tinygltf::Material& source = reader.source;
  const bool mask = source.alphaMode == "MASK";
  if (!mask && source.alphaMode != "BLEND") return;
  if (mask && !(source.alphaCutoff > 0.0)) return;
  const Base base = base_of(reader);
  material.opacity = FloatInput(base.factor.w);
  material.opacity.texture = texture_index(reader, base.texture, TextureEncoding::Srgb);
  if (material.opacity.texture >= 0) material.opacity.channel = 3;
  if (mask) material.opacity_cutoff = to_float(source.alphaCutoff);
}

std::optional<Emission> emission_of(MaterialReader& reader) {
  const tinygltf::Value* strength = reader.extension("KHR_materials_emissive_strength");
  const float scale = strength != nullptr ? get_number(*strength, "emissiveStrength", 1.0f) : 1.0f;
  Emission emission;
  for (int c = 0; c < 3; ++c) {
    const float factor = to_float(reader.source.emissiveFactor[size_t(c)]);
    emission.radiance.value[c] = std::max(factor * scale, 0.0f);
  }
  if (emission.radiance.value == glm::vec3(0.0f)) return std::nullopt;
  emission.radiance.texture =
      texture_index(reader, texture_use(reader.source.emissiveTexture), TextureEncoding::Srgb);
  emission.two_sided = reader.source.doubleSided;
  return emission;
}

Surface make_surface(MaterialReader& reader) {
  Surface surface;
  Material material;
  if (reader.extension("KHR_materials_unlit") != nullptr) {
    // Its colour reaches the camera as it is; here it also lights what is around.
    const ColorInput color = base_color(reader);
    if (color.value != glm::vec3(0.0f)) {
      surface.emission = Emission{color, reader.source.doubleSided};
    }
    material.model = DiffuseMaterial{glm::vec3(0.0f), 0.0f};
  } else {
    material = with_transmission(reader, principled(reader));
    surface.emission = emission_of(reader);
  }
  set_opacity(reader, material);
  surface.material = append(reader, std::move(material));
  surface.uv_set = reader.uv_set.value_or(0);
  return surface;
}

// The specification's default material; it has no name to warn of.
tinygltf::Material default_material() {
  tinygltf::Material material;
  material.emissiveFactor = {0.0, 0.0, 0.0};
  return material;
}

}  // namespace

const Surface& surface_of(Document& document, int index, MaterialTable& table,
                          SceneDescription& scene) {
  const auto& materials = document.model.materials;
  const std::string name = "material " + std::to_string(index);
  if (index < -1 || (index >= 0 && size_t(index) >= materials.size())) {
    fail(document.path, name + " does not exist");
  }
  table.surfaces.resize(materials.size() + 1);
  std::optional<Surface>& known = table.surfaces[index < 0 ? materials.size() : size_t(index)];
  if (known) return *known;
  static const tinygltf::Material fallback = default_material();
  MaterialReader reader{document, index < 0 ? fallback : materials[size_t(index)],
                        name,     table.textures,
                        scene,    std::nullopt};
  known = make_surface(reader);
  return *known;
}

}  // namespace lockstep::gltf
