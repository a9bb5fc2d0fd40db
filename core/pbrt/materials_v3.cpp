// Materials as pbrt-v2 and v3 name them.
#include "core/pbrt/material_types.h"
#include "core/pbrt/materials.h"
#include "core/pbrt/roughness.h"
#include "core/pbrt/textures.h"

#include <fmt/format.h>
#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace lockstep::pbrt {

namespace {

float largest(const ColorInput& color) {
  return std::max({color.value.x, color.value.y, color.value.z});
}

// v3 has "eta" or "index", v2 "index" only.
float glass_index(const Inputs& in) {
  return dielectric_index(in, in.set().any("eta") != nullptr ? "eta" : "index", 1.5f);
}

CoatedMaterial added_coat(const Inputs& in, const Roughness& roughness) {
  CoatedMaterial m;
  m.diffuse = in.reflectance("Kd", 0.25f);
  m.specular = in.reflectance("Ks", 0.25f);
  m.alpha = isotropic(in, roughness);
  m.alpha_scale = roughness.scale;
  m.layered = false;
  return m;
}

// Makes up for being seen by a share of the light only; no factor exceeds 1.
void divide(const Inputs& in, ColorInput& color, float share) {
  color.value /= share;
  if (largest(color) <= 1.0f + 1e-4f) return;
  in.warn("the parts add up to more than all light; some of it is left out");
  color.value = glm::min(color.value, 1.0f);
}

void divide(const Inputs& in, Material& material, float share) {
  if (auto* coated = std::get_if<CoatedMaterial>(&material.model)) {
    divide(in, coated->diffuse, share);
    divide(in, coated->specular, share);
  } else if (auto* sheet = std::get_if<DiffuseTransmissionMaterial>(&material.model)) {
    divide(in, sheet->reflectance, share);
    divide(in, sheet->transmittance, share);
  } else if (auto* glass = std::get_if<DielectricMaterial>(&material.model)) {
    divide(in, glass->reflectance, share);
    divide(in, glass->transmittance, share);
  }
}

}  // namespace

Material sum(const Inputs& in, Material base, Material over, float share) {
  if (!(share > 0.0f)) return base;
  if (!(share < 1.0f)) return over;
  divide(in, base, 1.0f - share);
  divide(in, over, share);
  MixMaterial mix;
  mix.first = add_material(in.library(), std::move(base));
  mix.second = add_material(in.library(), std::move(over));
  mix.amount = FloatInput(share);
  return mix;
}

MadeMaterial matte(const Inputs& in) {
  return DiffuseMaterial{in.reflectance("Kd", 0.5f), in.number("sigma", 0.0f)};
}

MadeMaterial plastic(const Inputs& in) {
  return added_coat(in, get_roughness(in, 0.1f, Remap::V3));
}

MadeMaterial metal(const Inputs& in) {
  const MetalIndex index = metal_index(in, "eta", "k");
  const Roughness roughness = get_roughness(in, 0.01f, Remap::V3);
  return ConductorMaterial{index.eta, index.k, roughness.alpha, roughness.scale, index.specular};
}

// v2: a glossy and a mirror's reflection at once.
MadeMaterial shiny_metal(const Inputs& in) {
  in.warn("half of the light is reflected by Ks, half by Kr");
  const MetalIndex glossy = metal_of_reflectance(in.reflectance("Ks", 1.0f));
  const MetalIndex mirrored = metal_of_reflectance(in.reflectance("Kr", 1.0f));
  const Roughness roughness = get_roughness(in, 0.1f, Remap::V3);
  MixMaterial mix;
  mix.first = add_material(in.library(), ConductorMaterial{glossy.eta, glossy.k, roughness.alpha,
                                                           roughness.scale, glossy.specular});
  mix.second = add_material(
      in.library(),
      ConductorMaterial{mirrored.eta, mirrored.k, glm::vec2(0.0f), {}, mirrored.specular});
  return mix;
}

MadeMaterial glass(const Inputs& in) {
  const Roughness roughness = get_glass_roughness(in);
  DielectricMaterial m;
  m.eta = glass_index(in);
  m.alpha = roughness.alpha;
  m.alpha_scale = roughness.scale;
  m.reflectance = in.reflectance("Kr", 1.0f);
  m.transmittance = in.reflectance("Kt", 1.0f);
  return m;
}

// An index without real part reflects all light at all angles.
MadeMaterial mirror(const Inputs& in) {
  const ColorInput reflectance = in.reflectance("Kr", 0.9f);
  return ConductorMaterial{glm::vec3(0.0f), glm::vec3(1.0f), glm::vec2(0.0f), {}, reflectance};
}

// Plastic and smooth glass added up, behind a mask.
MadeMaterial uber(const Inputs& in) {
  CoatedMaterial coated = added_coat(in, get_roughness(in, 0.1f, Remap::V3));
  DielectricMaterial glass;
  glass.eta = glass_index(in);
  glass.reflectance = in.reflectance("Kr", 0.0f);
  glass.transmittance = in.reflectance("Kt", 0.0f);
  coated.eta = std::max(glass.eta, 1.001f);
  float share = std::max(largest(glass.reflectance), largest(glass.transmittance));
  if (share >= 1.0f && std::max(largest(coated.diffuse), largest(coated.specular)) > 0.0f) {
    share = 0.5f;
  }
  Material m = sum(in, coated, glass, share);
  const ColorInput opacity = in.reflectance("opacity", 1.0f);
  const glm::vec3 c = opacity.value;
  if (c.x != c.y || c.y != c.z) in.warn("coloured opacity is not supported; its mean is used");
  FloatInput grey((c.x + c.y + c.z) / 3.0f);
  grey.texture = opacity.texture;
  multiply_opacity(in.library(), m, grey);
  return m;
}

// Ashikhmin and Shirley's model, whose coat reflects Ks at normal incidence.
MadeMaterial substrate(const Inputs& in) {
  in.warn("the nearest model is used, a diffuse base under a dielectric coat");
  const Roughness roughness = get_roughness(in, 0.1f, Remap::V3);
  CoatedMaterial m;
  m.diffuse = in.reflectance("Kd", 0.5f);
  m.alpha = isotropic(in, roughness);
  m.alpha_scale = roughness.scale;
  const ColorInput coat = in.reflectance("Ks", 0.5f);
  const float normal = std::min(largest(coat) * (coat.texture >= 0 ? 0.5f : 1.0f), 0.9f);
  m.eta = (1.0f + std::sqrt(normal)) / (1.0f - std::sqrt(normal));
  m.specular = {coat.value / std::max(normal, 1e-6f), coat.texture};
  if (!(m.eta > 1.001f)) {
    m.eta = 1.001f;
    m.specular = glm::vec3(0.0f);
  }
  return m;
}

// A diffuse sheet and rough glass added up, each split into "reflect" and "transmit".
MadeMaterial translucent(const Inputs& in) {
  Library& library = in.library();
  const ColorInput kd = in.reflectance("Kd", 0.25f), ks = in.reflectance("Ks", 0.25f);
  const ColorInput back = in.reflectance("reflect", 0.5f), on = in.reflectance("transmit", 0.5f);
  const Roughness roughness = get_roughness(in, 0.1f, Remap::V3);
  const DiffuseTransmissionMaterial sheet{multiply(library, kd, back), multiply(library, kd, on)};
  DielectricMaterial glass;
  glass.alpha = roughness.alpha;
  glass.alpha_scale = roughness.scale;
  glass.reflectance = multiply(library, ks, back);
  glass.transmittance = multiply(library, ks, on);
  const float share = std::max(largest(glass.reflectance), largest(glass.transmittance));
  return sum(in, sheet, glass, share < 1.0f ? share : 0.5f);
}

MadeMaterial disney(const Inputs& in) {
  PrincipledMaterial m;
  m.base_color = in.reflectance("color", 0.5f);
  m.metallic = in.number("metallic", 0.0f);
  m.alpha = in.number("roughness", 0.5f);
  m.alpha.value *= std::clamp(m.alpha.value, 0.0f, 100.0f);
  m.alpha.power = 2.0f;
  m.eta = dielectric_index(in, "eta", 1.5f);
  m.transmission = in.number("spectrans", 0.0f);
  // Disney's coat has a quarter of the strength of one of index 1.5.
  m.coat = in.number("clearcoat", 0.0f);
  m.coat.value *= 0.25f;
  m.coat_alpha = FloatInput(glm::mix(0.1f, 0.001f, in.constant("clearcoatgloss", 1.0f)));
  for (const char* name : {"speculartint", "anisotropic", "sheen", "flatness"}) {
    const FloatInput given = in.number(name, 0.0f);
    if (given != FloatInput(0.0f)) in.warn(fmt::format("\"{}\" is not supported", name));
  }
  in.set().ignore({"sheentint", "difftrans"});
  return m;
}

}  // namespace lockstep::pbrt
