// Mitsuba's scattering models as materials of the scene. Opaque ones are black from behind unless
// "twosided" is around them (Material::two_sided).
#pragma once

#include "core/mitsuba/state.h"

#include <optional>

namespace lockstep::mitsuba {

// How the functions behind the models are called.
struct BsdfCall {
  State& state;
  const Properties& set;
  bool two_sided = false;  // "twosided" is around it
};

// The index in SceneDescription::materials of a <bsdf>, added the first time; nothing for "null".
// A model that is not supported gives a warning and the nearest one, or a diffuse grey.
std::optional<int> material_index(State& state, const Element& element, bool two_sided = false);

// The same as a value, to be altered by the model around it.
std::optional<Material> make_material(State& state, const Element& element, bool two_sided);

int add_material(State& state, Material material);

// Models that stand alone (bsdf_models.cpp).
Material make_conductor(const BsdfCall&);
Material make_dielectric(const BsdfCall&);
Material make_diffuse(const BsdfCall&);
Material make_diffuse_transmitter(const BsdfCall&);
Material make_phong(const BsdfCall&);
Material make_plastic(const BsdfCall&);
Material make_principled(const BsdfCall&);
Material make_rough_conductor(const BsdfCall&);
Material make_rough_dielectric(const BsdfCall&);
Material make_rough_diffuse(const BsdfCall&);
Material make_rough_plastic(const BsdfCall&);
Material make_thin_dielectric(const BsdfCall&);
Material make_ward(const BsdfCall&);

// Their shared parameters: int_ior / ext_ior, numbers or names; and GGX's roughness.
float relative_index(const BsdfCall& call, const char* inside);
struct Roughness {
  glm::vec2 alpha{0.0f};
  FloatInput scale{};
};
Roughness get_roughness(const BsdfCall& call, float fallback);

}  // namespace lockstep::mitsuba
