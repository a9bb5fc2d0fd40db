// Models that contain no others. Names and defaults: Mitsuba 0.5 documentation, section 8.2, and
// Mitsuba 3's plugin reference.
#include "core/fresnel.h"
#include "core/mitsuba/bsdfs.h"
#include "core/mitsuba/colors.h"
#include "core/mitsuba/named_indices.h"

#include <glm/common.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cctype>
#include <cmath>

namespace lockstep::mitsuba {
namespace {

float index_of_refraction(const Properties& set, std::string_view name, std::string given) {
  const Property* p = set.find(name);
  if (p != nullptr && p->tag != "string") return set.get_float(name, 1.0f);
  if (p != nullptr) given = p->element.attribute("value");
  for (char& c : given) c = char(std::tolower(static_cast<unsigned char>(c)));
  const std::optional<float> index = dielectric_index(given);
  if (!index) {
    fail(p != nullptr ? p->element.where() : set.where(),
         "the index of refraction of \"" + given + "\" is not known; give a number");
  }
  return *index;
}

Material opaque(const BsdfCall& call, MaterialModel model) {
  Material material(std::move(model));
  material.two_sided = call.two_sided;
  return material;
}

// Unless "nonlinear", Mitsuba divides the base's albedo a by 1 - r where the layered coat here
// divides it by 1 - a r, r being the inner reflectance: another albedo gives the same.
void linearise(const BsdfCall& call, CoatedMaterial& m) {
  if (call.set.get_bool("nonlinear", false)) return;
  if (m.diffuse.texture >= 0) {
    call.state.warnings.add(call.set.where(),
                            "plastic over a texture is rendered as \"nonlinear\", darker");
    return;
  }
  const float r = inner_reflectance(m.eta);
  m.diffuse.value /= glm::vec3(1.0f - r) + r * m.diffuse.value;
}

Material plastic(const BsdfCall& call, float fallback_alpha) {
  CoatedMaterial m;
  m.diffuse = get_reflectance(call.state, call.set, "diffuse_reflectance", 0.5f);
  m.specular = get_reflectance(call.state, call.set, "specular_reflectance", 1.0f);
  m.eta = relative_index(call, "polypropylene");
  if (!(m.eta > 1.0f)) {
    call.state.warnings.add(call.set.where(), "plastic needs an index above 1; 1.5 is used");
    m.eta = 1.5f;
  }
  if (fallback_alpha > 0.0f) {
    const Roughness roughness = get_roughness(call, fallback_alpha);
    m.alpha = std::sqrt(roughness.alpha.x * roughness.alpha.y);
    m.alpha_scale = roughness.scale;
  } else {
    m.alpha = 0.0f;
  }
  linearise(call, m);
  return opaque(call, m);
}

// Mitsuba 0.x has copper where nothing is said, 2 and 3 have a perfect mirror.
MetalIndices default_metal(const BsdfCall& call) {
  const std::string name =
      call.set.get_string("material", call.state.sources.modern ? "none" : "Cu");
  const std::string wanted = plain(name) == "none" ? "none" : name.substr(0, name.find('_'));
  if (const std::optional<MetalIndices> known = metal_indices(wanted)) return *known;
  call.state.warnings.add(call.set.where(), "the metal \"" + name + "\" is not known; Cr is used");
  return *metal_indices("Cr");
}

Material conductor(const BsdfCall& call, float fallback_alpha) {
  const MetalIndices metal = default_metal(call);
  ConductorMaterial m;
  m.eta = get_color(call.state, call.set, "eta", metal.eta, ColorUse::Reflectance);
  m.k = get_color(call.state, call.set, "k", metal.k, ColorUse::Reflectance);
  if (!call.state.sources.modern) {
    const float outside = index_of_refraction(call.set, "ext_eta", "air");
    m.eta.value /= outside;
    m.k.value /= outside;
  }
  m.specular = get_reflectance(call.state, call.set, "specular_reflectance", 1.0f);
  m.alpha = glm::vec2(0.0f);
  if (fallback_alpha > 0.0f) {
    const Roughness roughness = get_roughness(call, fallback_alpha);
    m.alpha = roughness.alpha;
    m.alpha_scale = roughness.scale;
  }
  return opaque(call, m);
}

DielectricMaterial dielectric(const BsdfCall& call) {
  DielectricMaterial m;
  m.eta = relative_index(call, "bk7");
  m.reflectance = get_reflectance(call.state, call.set, "specular_reflectance", 1.0f);
  m.transmittance = get_reflectance(call.state, call.set, "specular_transmittance", 1.0f);
  return m;
}

float largest(glm::vec3 v) { return std::max({v.x, v.y, v.z}); }

// A diffuse and a glossy part that add up, without Fresnel's formula: a mix of Lambert's model and
// a metal that reflects alike at all angles, each scaled up by what the mix takes from it.
Material diffuse_and_glossy(const BsdfCall& call, const Roughness& roughness) {
  ColorInput diffuse = get_reflectance(call.state, call.set, "diffuse_reflectance", 0.5f);
  ColorInput specular = get_reflectance(call.state, call.set, "specular_reflectance", 0.2f);
  const float d = largest(diffuse.value), s = largest(specular.value);
  if (!(s > 0.0f)) return opaque(call, DiffuseMaterial{diffuse, 0.0f});
  // More than all light would be reflected: both are scaled down, as Mitsuba does.
  const float sum = std::max(1.0f, d + s);
  const float share = s / (d + s);
  diffuse.value /= sum * std::max(1.0f - share, 1e-6f);
  specular.value /= sum * share;

  ConductorMaterial metal;
  metal.eta = glm::vec3(0.0f);
  metal.k = glm::vec3(1.0f);
  metal.specular = specular;
  metal.alpha = roughness.alpha;
  metal.alpha_scale = roughness.scale;
  MixMaterial mix;
  mix.first = add_material(call.state, opaque(call, DiffuseMaterial{diffuse, 0.0f}));
  mix.second = add_material(call.state, opaque(call, metal));
  mix.amount = share;
  return opaque(call, mix);
}

void warn_of_lobes(const BsdfCall& call) {
  for (const char* name : {"sheen", "flatness", "spec_tint", "anisotropic"}) {
    if (get_number(call.state, call.set, name, 0.0f) == FloatInput(0.0f)) continue;
    call.state.warnings.add(call.set.where(), std::string("principled: \"") + name +
                                                  "\" is not supported; it is left out");
  }
}

}  // namespace

float relative_index(const BsdfCall& call, const char* inside) {
  const float in = index_of_refraction(call.set, "int_ior", inside);
  const float out = index_of_refraction(call.set, "ext_ior", "air");
  const float eta = in / out;
  if (!(in > 0.0f && out > 0.0f && eta > 1e-3f && eta < 1e3f)) {
    fail(call.set.where(), call.set.shown() + " needs indices of refraction above 0");
  }
  return eta;
}

Roughness get_roughness(const BsdfCall& call, float fallback) {
  const std::string distribution = plain(call.set.get_string("distribution", "beckmann"));
  if (distribution != "ggx") {
    call.state.warnings.add(call.set.where(), "microfacets are GGX's instead of " + distribution +
                                                  "'s, with the same alpha");
  }
  call.set.ignore({"sample_visible"});
  const FloatInput both = get_number(call.state, call.set, "alpha", fallback);
  FloatInput u = both, v = both;
  if (call.set.has("alpha_u")) u = get_number(call.state, call.set, "alpha_u", fallback);
  if (call.set.has("alpha_v")) v = get_number(call.state, call.set, "alpha_v", fallback);
  Roughness roughness;
  roughness.alpha = glm::clamp(glm::vec2(u.value, v.value), 0.0f, 1.0f);
  if (u.texture != v.texture) {
    call.state.warnings.add(call.set.where(), "of two roughness textures only one is used");
  }
  const FloatInput& textured = u.texture >= 0 ? u : v;
  if (textured.texture >= 0) {
    roughness.scale = textured;
    roughness.scale.value = 1.0f;
  }
  return roughness;
}

Material make_diffuse(const BsdfCall& call) {
  const char* name = call.set.has("diffuse_reflectance") ? "diffuse_reflectance" : "reflectance";
  return opaque(call, DiffuseMaterial{get_reflectance(call.state, call.set, name, 0.5f), 0.0f});
}

// sigma = alpha / sqrt(2), in radians (Mitsuba 0.5, roughdiffuse.cpp).
Material make_rough_diffuse(const BsdfCall& call) {
  DiffuseMaterial m;
  const char* name = call.set.has("diffuse_reflectance") ? "diffuse_reflectance" : "reflectance";
  m.reflectance = get_reflectance(call.state, call.set, name, 0.5f);
  m.sigma = get_number(call.state, call.set, "alpha", 0.2f);
  m.sigma.value = glm::degrees(m.sigma.value / std::sqrt(2.0f));
  call.set.ignore({"use_fast_approx"});
  return opaque(call, m);
}

Material make_diffuse_transmitter(const BsdfCall& call) {
  DiffuseTransmissionMaterial m;
  m.reflectance = glm::vec3(0.0f);
  m.transmittance = get_reflectance(call.state, call.set, "transmittance", 0.5f);
  return m;
}

Material make_dielectric(const BsdfCall& call) { return dielectric(call); }

Material make_thin_dielectric(const BsdfCall& call) {
  DielectricMaterial m = dielectric(call);
  m.thin = true;
  return m;
}

Material make_rough_dielectric(const BsdfCall& call) {
  DielectricMaterial m = dielectric(call);
  const Roughness roughness = get_roughness(call, 0.1f);
  m.alpha = roughness.alpha;
  m.alpha_scale = roughness.scale;
  return m;
}

Material make_conductor(const BsdfCall& call) { return conductor(call, 0.0f); }
Material make_rough_conductor(const BsdfCall& call) { return conductor(call, 0.1f); }
Material make_plastic(const BsdfCall& call) { return plastic(call, 0.0f); }
Material make_rough_plastic(const BsdfCall& call) { return plastic(call, 0.1f); }

// alpha = sqrt(2 / (exponent + 2)) (Walter et al. 2007, section 5.2).
Material make_phong(const BsdfCall& call) {
  call.state.warnings.add(call.set.where(), "phong is rendered with GGX's microfacets");
  const FloatInput exponent = get_number(call.state, call.set, "exponent", 30.0f);
  if (exponent.texture >= 0) {
    call.state.warnings.add(call.set.where(), "phong: textures of the exponent are not supported");
  }
  Roughness roughness;
  roughness.alpha =
      glm::vec2(std::min(1.0f, std::sqrt(2.0f / (std::max(exponent.value, 0.0f) + 2.0f))));
  return diffuse_and_glossy(call, roughness);
}

Material make_ward(const BsdfCall& call) {
  call.state.warnings.add(call.set.where(), "ward is rendered with GGX's microfacets");
  call.set.ignore({"variant", "distribution"});
  return diffuse_and_glossy(call, get_roughness(call, 0.1f));
}

// Burley 2012 and 2015: alpha = roughness^2; specular 0.5 is index 1.5; the clear coat has a
// quarter of a dielectric's reflection and alpha from 0.1 to 0.001.
Material make_principled(const BsdfCall& call) {
  PrincipledMaterial m;
  m.base_color = get_reflectance(call.state, call.set, "base_color", 0.5f);
  m.metallic = get_number(call.state, call.set, "metallic", 0.0f);
  m.alpha = get_number(call.state, call.set, "roughness", 0.5f);
  m.alpha.value *= m.alpha.value;
  m.alpha.power = 2.0f;
  if (call.set.has("eta")) {
    m.eta = call.set.get_float("eta", 1.5f);
  } else {
    const float specular = std::clamp(call.set.get_float("specular", 0.5f), 0.0f, 1.0f);
    m.eta = 2.0f / (1.0f - std::sqrt(0.08f * specular)) - 1.0f;
  }
  if (!(m.eta > 0.1f && m.eta < 100.0f)) fail(call.set.where(), "principled needs a positive eta");
  m.transmission = get_number(call.state, call.set, "spec_trans", 0.0f);
  m.coat = get_number(call.state, call.set, "clearcoat", 0.0f);
  m.coat.value *= 0.25f;
  const FloatInput gloss = get_number(call.state, call.set, "clearcoat_gloss", 0.0f);
  m.coat_alpha = 0.1f + (0.001f - 0.1f) * std::clamp(gloss.value, 0.0f, 1.0f);
  warn_of_lobes(call);
  call.set.ignore({"sheen_tint", "diffuse_reflectance_sampling_rate", "main_specular_sampling_rate",
                   "clearcoat_sampling_rate"});
  Material material = opaque(call, m);
  material.two_sided = material.two_sided || m.transmission != FloatInput(0.0f);
  return material;
}

}  // namespace lockstep::mitsuba
