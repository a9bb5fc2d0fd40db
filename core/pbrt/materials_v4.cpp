// Materials as pbrt-v4 names them.
#include "core/pbrt/material_types.h"
#include "core/pbrt/materials.h"
#include "core/pbrt/roughness.h"
#include "core/pbrt/textures.h"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/exponential.hpp>

#include <algorithm>
#include <utility>

namespace lockstep::pbrt {

namespace {

// The index in the scene of the material that `in` refers to by `name`.
int component(const Inputs& in, const std::string& name) {
  Library& library = in.library();
  const int* index = library.named_materials.find(name, in.order());
  if (index == nullptr) {
    fail(in.set().where(),
         in.set().owner() + " refers to the material \"" + name + "\", which has not been defined");
  }
  MaterialDeclaration& declaration = library.materials[static_cast<size_t>(*index)];
  const std::optional<Material>& material = made_material(library, declaration);
  if (!material) {
    fail(in.set().where(), in.set().owner() + " refers to the interface \"" + name +
                               "\"; only materials with a surface can be mixed");
  }
  if (declaration.scene_index < 0) declaration.scene_index = add_material(library, *material);
  return declaration.scene_index;
}

// v3's amount is a colour: its mean.
FloatInput mean(const Inputs& in, const ColorInput& color) {
  const glm::vec3 c = color.value;
  if (c.x != c.y || c.y != c.z) in.warn("a coloured amount is not supported; its mean is used");
  FloatInput number((c.x + c.y + c.z) / 3.0f);
  number.texture = color.texture;
  return number;
}

// The layers' walk where a stand-in has none: what is between them is taken to be empty.
void ignore_layers(const Inputs& in) {
  in.set().ignore({"thickness", "maxdepth", "nsamples", "g"});
}

// What is between the layers absorbs; with "albedo" it would scatter, too. Of each two steps of a
// walk one is a reflection by the base.
void read_layers(const Inputs& in, CoatedMaterial& m) {
  m.thickness = std::clamp(in.constant("thickness", 0.01f), 0.0f, 100.0f);
  m.reflections = std::clamp(in.set().get_int("maxdepth", 10), 1, 1000) / 2;
  m.reflections = std::max(m.reflections, 1);
  in.set().ignore({"nsamples", "g"});
}

}  // namespace

float dielectric_index(const Inputs& in, const char* name, float fallback) {
  if (in.set().find(name, {"texture"}) != nullptr) return in.constant(name, fallback);
  const float eta = in.color(name, glm::vec3(fallback)).value.y;
  if (eta > 0.01f && eta < 100.0f) return eta;
  in.warn(fmt::format("\"{}\" must be between 0.01 and 100; the default is used", name));
  return fallback;
}

MetalIndex metal_of_reflectance(const ColorInput& reflectance) {
  // A texture scales what a perfect mirror reflects.
  if (reflectance.texture >= 0) return {glm::vec3(0.0f), glm::vec3(1.0f), reflectance};
  const glm::vec3 r = glm::min(reflectance.value, 0.9999f);
  return {glm::vec3(1.0f), 2.0f * glm::sqrt(r) / glm::sqrt(1.0f - r)};
}

MetalIndex metal_index(const Inputs& in, const char* eta_name, const char* k_name) {
  if (in.set().any("reflectance") != nullptr) {
    return metal_of_reflectance(in.reflectance("reflectance", 0.5f));
  }
  const ConductorMaterial copper{glm::vec3(0.200438f, 0.924033f, 1.102212f),
                                 glm::vec3(3.912949f, 2.452847f, 2.142188f)};
  return {in.color(eta_name, copper.eta.value), in.color(k_name, copper.k.value)};
}

MadeMaterial diffuse(const Inputs& in) {
  return DiffuseMaterial{in.reflectance("reflectance", 0.5f)};
}

MadeMaterial coated_diffuse(const Inputs& in) {
  CoatedMaterial m;
  m.diffuse = in.reflectance("reflectance", 0.5f);
  const Roughness roughness = get_roughness(in, 0.0f, Remap::V4);
  m.alpha = isotropic(in, roughness);
  m.alpha_scale = roughness.scale;
  m.eta = dielectric_index(in, "eta", 1.5f);
  if (!(m.eta > 1.0f)) {
    in.warn("eta must be above 1; 1.5 is used");
    m.eta = 1.5f;
  }
  read_layers(in, m);
  return m;
}

MadeMaterial conductor(const Inputs& in) {
  const MetalIndex index = metal_index(in, "eta", "k");
  const Roughness roughness = get_roughness(in, 0.0f, Remap::V4);
  return ConductorMaterial{index.eta, index.k, roughness.alpha, roughness.scale, index.specular};
}

// Metal under a clear coat, from which the metal's index is relative to the coat's.
MadeMaterial coated_conductor(const Inputs& in) {
  in.warn("the nearest model is used, metal of one roughness under a coat of index 1.5");
  const MetalIndex index = metal_index(in, "conductor.eta", "conductor.k");
  const float coat_eta = dielectric_index(in, "interface.eta", 1.5f);
  const Roughness metal = get_roughness(in, 0.0f, Remap::V4, "conductor.");
  const Roughness coat = get_roughness(in, 0.0f, Remap::V4, "interface.");
  PrincipledMaterial m;
  const glm::vec3 eta = index.eta.value / coat_eta, k = index.k.value / coat_eta;
  const glm::vec3 k2 = k * k, less = eta - 1.0f, more = eta + 1.0f;
  m.base_color = index.specular.texture >= 0 ? index.specular
                                             : ColorInput((less * less + k2) / (more * more + k2));
  m.metallic = FloatInput(1.0f);
  m.alpha = metal.scale;
  m.alpha.value *= isotropic(in, metal);
  m.coat = FloatInput(1.0f);
  m.coat_alpha = coat.scale;
  m.coat_alpha.value *= isotropic(in, coat);
  ignore_layers(in);
  return m;
}

MadeMaterial dielectric(const Inputs& in) {
  const Roughness roughness = get_roughness(in, 0.0f, Remap::V4);
  DielectricMaterial m;
  m.eta = dielectric_index(in, "eta", 1.5f);
  m.alpha = roughness.alpha;
  m.alpha_scale = roughness.scale;
  return m;
}

MadeMaterial thin_dielectric(const Inputs& in) {
  DielectricMaterial m;
  m.eta = dielectric_index(in, "eta", 1.5f);
  m.thin = true;
  return m;
}

MadeMaterial diffuse_transmission(const Inputs& in) {
  const float scale = in.set().get_float("scale", 1.0f);
  DiffuseTransmissionMaterial m;
  m.reflectance = in.reflectance("reflectance", 0.25f);
  m.transmittance = in.reflectance("transmittance", 0.25f);
  m.reflectance.value *= scale;
  m.transmittance.value *= scale;
  return m;
}

// v4 lists two "materials" and the share of the second; v3 names them one by one and gives the
// share of the first.
MadeMaterial mixed(const Inputs& in) {
  const ParameterSet& set = in.set();
  MixMaterial m;
  if (const Parameter* names = set.find("materials", {"string"})) {
    if (names->strings.size() != 2) {
      fail(set.where(*names), set.owner() + " needs two names in \"string materials\"");
    }
    m.first = component(in, names->strings[0]);
    m.second = component(in, names->strings[1]);
    m.amount = in.number("amount", 0.5f);
    return m;
  }
  const std::string first = set.get_string("namedmaterial1", "");
  const std::string second = set.get_string("namedmaterial2", "");
  if (first.empty() || second.empty()) {
    fail(set.where(), set.owner() + " needs \"string materials\" with two names");
  }
  m.first = component(in, second);
  m.second = component(in, first);
  m.amount = mean(in, in.color("amount", glm::vec3(0.5f)));
  return m;
}

}  // namespace lockstep::pbrt
