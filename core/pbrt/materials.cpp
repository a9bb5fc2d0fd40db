#include "core/pbrt/materials.h"

#include "core/pbrt/spectrum.h"

#include <glm/common.hpp>
#include <glm/exponential.hpp>

#include <algorithm>
#include <cmath>
#include <string_view>

namespace lockstep::pbrt {

namespace {

glm::vec3 reflectance(const ParameterSet& set, std::string_view name, float fallback,
                      Warnings& warnings) {
  const glm::vec3 given =
      get_color(set, name, ColorUse::Reflectance, glm::vec3(fallback), warnings);
  const glm::vec3 clamped = glm::clamp(given, 0.0f, 1.0f);
  if (given != clamped) {
    warnings.add(set.where(), set.owner() + ": \"" + std::string(name) +
                                  "\" is clamped to the range from 0 to 1");
  }
  return clamped;
}

// pbrt-v3's fit of a slope width to a perceived roughness in [0, 1].
float v3_alpha(float roughness) {
  const float x = std::log(std::max(roughness, 1e-3f));
  return 1.62142f + x * (0.819955f + x * (0.1734f + x * (0.0171201f + x * 0.000640711f)));
}

float v4_alpha(float roughness) { return std::sqrt(std::max(roughness, 0.0f)); }

// GGX alpha along u and v, from the three roughness parameters that the versions share.
glm::vec2 get_alpha(const ParameterSet& set, float fallback, float (*remap)(float),
                    Warnings& warnings) {
  for (const std::string_view name : {"roughness", "uroughness", "vroughness"}) {
    const Parameter* texture = set.find(name, {"texture"});
    if (texture == nullptr) continue;
    warnings.add(set.where(*texture),
                 "roughness textures are not supported yet; the default roughness is used");
  }
  const float both = set.get_float("roughness", fallback);
  glm::vec2 alpha(set.get_float("uroughness", both), set.get_float("vroughness", both));
  if (set.get_bool("remaproughness", true)) alpha = {remap(alpha.x), remap(alpha.y)};

  constexpr float smoothest = 1e-3f;
  if (alpha.x < smoothest || alpha.y < smoothest) {
    warnings.add(set.where(),
                 "perfectly smooth surfaces are not supported yet; roughness alpha "
                 "is kept at 0.001 or more");
    alpha = glm::max(alpha, smoothest);
  }
  return glm::min(alpha, 1.0f);
}

float isotropic(glm::vec2 alpha, const ParameterSet& set, Warnings& warnings) {
  if (alpha.x != alpha.y) {
    warnings.add(set.where(), set.owner() +
                                  ": roughness that differs along u and v is not "
                                  "supported; the geometric mean is used");
  }
  return alpha.x == alpha.y ? alpha.x : std::sqrt(alpha.x * alpha.y);
}

std::optional<Material> matte(const ParameterSet& set, Warnings& warnings) {
  if (set.get_float("sigma", 0.0f) > 0.0f || set.find("sigma", {"texture"}) != nullptr) {
    warnings.add(set.where(), "matte: sigma is not supported; the surface is Lambertian");
  }
  return DiffuseMaterial{reflectance(set, "Kd", 0.5f, warnings)};
}

std::optional<Material> diffuse(const ParameterSet& set, Warnings& warnings) {
  return DiffuseMaterial{reflectance(set, "reflectance", 0.5f, warnings)};
}

std::optional<Material> plastic(const ParameterSet& set, Warnings& warnings) {
  CoatedMaterial m;
  m.diffuse = reflectance(set, "Kd", 0.25f, warnings);
  m.specular = reflectance(set, "Ks", 0.25f, warnings);
  m.alpha = isotropic(get_alpha(set, 0.1f, v3_alpha, warnings), set, warnings);
  m.eta = 1.5f;
  m.layered = false;
  return m;
}

std::optional<Material> coated_diffuse(const ParameterSet& set, Warnings& warnings) {
  CoatedMaterial m;
  m.diffuse = reflectance(set, "reflectance", 0.5f, warnings);
  m.alpha = isotropic(get_alpha(set, 0.0f, v4_alpha, warnings), set, warnings);
  m.eta = get_color(set, "eta", ColorUse::Reflectance, glm::vec3(1.5f), warnings).y;
  if (!(m.eta > 1.0f)) {
    warnings.add(set.where(), set.owner() + ": eta must be above 1; 1.5 is used");
    m.eta = 1.5f;
  }
  set.ignore({"thickness", "maxdepth", "nsamples"});
  return m;
}

// Without parameters both versions have copper.
ConductorMaterial conductor_indices(const ParameterSet& set, Warnings& warnings) {
  ConductorMaterial m;
  m.eta = glm::vec3(0.200438f, 0.924033f, 1.102212f);
  m.k = glm::vec3(3.912949f, 2.452847f, 2.142188f);
  if (set.any("reflectance") != nullptr) {
    // The index that has this reflectance at normal incidence, with eta = 1.
    const glm::vec3 r = glm::min(reflectance(set, "reflectance", 0.5f, warnings), 0.9999f);
    m.eta = glm::vec3(1.0f);
    m.k = 2.0f * glm::sqrt(r) / glm::sqrt(1.0f - r);
    return m;
  }
  m.eta = get_color(set, "eta", ColorUse::Reflectance, m.eta.value, warnings);
  m.k = get_color(set, "k", ColorUse::Reflectance, m.k.value, warnings);
  return m;
}

std::optional<Material> metal(const ParameterSet& set, Warnings& warnings) {
  ConductorMaterial m = conductor_indices(set, warnings);
  m.alpha = get_alpha(set, 0.01f, v3_alpha, warnings);
  return m;
}

std::optional<Material> conductor(const ParameterSet& set, Warnings& warnings) {
  ConductorMaterial m = conductor_indices(set, warnings);
  m.alpha = get_alpha(set, 0.0f, v4_alpha, warnings);
  return m;
}

std::optional<Material> interface(const ParameterSet&, Warnings&) { return std::nullopt; }

struct MaterialType {
  std::string_view name;
  std::optional<Material> (*make)(const ParameterSet&, Warnings&);
};

// To support another material, write its function and add it here.
constexpr MaterialType material_types[] = {
    {"matte", matte},
    {"plastic", plastic},
    {"metal", metal},
    {"diffuse", diffuse},
    {"coateddiffuse", coated_diffuse},
    {"conductor", conductor},
    {"interface", interface},
    {"none", interface},
    {"", interface},
};

}  // namespace

std::optional<Material> make_material(const std::string& type, const ParameterSet& set,
                                      Warnings& warnings) {
  set.ignore({"type"});
  for (const MaterialType& known : material_types) {
    if (known.name != type) continue;
    std::optional<Material> material = known.make(set, warnings);
    set.warn_unused(warnings);
    return material;
  }
  warnings.add(set.where(), "Material \"" + type + "\" is not supported; a diffuse grey is used");
  return DiffuseMaterial{};
}

}  // namespace lockstep::pbrt
