// Surface materials as scene files state them. To add a model: a struct here, its row in
// core/flatten_materials.cpp, its kernel in core/bsdf/, and its lines in packets/bsdf_models.h and
// packets/path.h.
//
// Reflectances are linear RGB in [0, 1]; alpha is GGX's roughness parameter, 0 for a smooth
// surface; eta is relative to the outside.
#pragma once

#include "core/texture_description.h"

#include <concepts>
#include <optional>
#include <utility>

namespace lockstep {

// Lambert's, or with sigma > 0 Oren and Nayar's: sigma is the standard deviation of the facets'
// slope angle in degrees.
struct DiffuseMaterial {
  ColorInput reflectance{glm::vec3(0.5f)};
  FloatInput sigma{0.0f};
};

// Light passing through, spread by the cosine: what Diffuse is to reflection.
struct DiffuseTransmissionMaterial {
  ColorInput reflectance{glm::vec3(0.25f)}, transmittance{glm::vec3(0.25f)};
};

// Metal with GGX roughness; eta and k are the real and imaginary index of refraction per channel.
struct ConductorMaterial {
  ColorInput eta{glm::vec3(0.2f, 0.92f, 1.1f)};
  ColorInput k{glm::vec3(3.9f, 2.45f, 2.14f)};
  glm::vec2 alpha{0.1f};     // along the surface's u and v
  FloatInput alpha_scale{};  // times both
  ColorInput specular{};     // scales the reflection
};

// A diffuse base under a rough dielectric coat.
// `layered`: light pays the coat's Fresnel transmittance on its way in and out, and what the coat
// reflects back inside is summed (pbrt-v4 coateddiffuse, in closed form). Otherwise coat and base
// are simply added (pbrt-v3 plastic).
struct CoatedMaterial {
  ColorInput diffuse{glm::vec3(0.5f)};
  ColorInput specular{};  // scales the coat's reflection
  float alpha = 0.1f;
  float eta = 1.5f;
  bool layered = true;
  FloatInput alpha_scale{};
  // Of layered coats: what crosses one under an angle is dimmed by exp(-thickness / cos), and of
  // light between base and coat this many reflections by the base count; 0: all.
  float thickness = 0.0f;
  int reflections = 0;
};

// A boundary between two transparent media, or a thin sheet of one.
struct DielectricMaterial {
  float eta = 1.5f;
  glm::vec2 alpha{0.0f};
  FloatInput alpha_scale{};
  bool thin = false;                          // both faces at once: light goes on in its direction
  ColorInput reflectance{}, transmittance{};  // scale what is reflected, what passes
  glm::vec3 absorption{0.0f};                 // inside, per unit of length: Beer and Lambert's law
};

// glTF 2.0's metallic-roughness model with its extensions for transmission, ior, specular and coat;
// also what readers map other "principled" models to.
struct PrincipledMaterial {
  ColorInput base_color{};
  FloatInput metallic{0.0f};
  FloatInput alpha{0.25f};  // roughness squared
  float eta = 1.5f;
  FloatInput specular{1.0f};      // scales the dielectric reflection
  FloatInput transmission{0.0f};  // share of the diffuse base that is a transparent one instead
  FloatInput coat{0.0f};          // share covered by a clear coat of index 1.5
  FloatInput coat_alpha{0.01f};
};

// Reflectance as a file tabulates it for all pairs of directions.
struct MeasuredMaterial {
  int table = 0;  // index of SceneDescription::measured
};

// Material `first` or `second` (indices of SceneDescription::materials): second for a share
// `amount` of the light. Never refers to itself, not even through others.
struct MixMaterial {
  int first = 0, second = 0;
  FloatInput amount{0.5f};
};

using MaterialModel =
    std::variant<DiffuseMaterial, DiffuseTransmissionMaterial, ConductorMaterial, CoatedMaterial,
                 DielectricMaterial, PrincipledMaterial, MeasuredMaterial, MixMaterial>;

// A model and what alters the surface that it is on.
struct Material {
  MaterialModel model = DiffuseMaterial{};
  FloatInput opacity{1.0f};        // share of the surface that is there at all
  float opacity_cutoff = 0.0f;     // where > 0: wholly there from this opacity on, else not at all
  int normal_map = -1;             // a texture: tangent-space normals as 2 rgb - 1, y along -v
  float normal_scale = 1.0f;       // of the map's x and y
  std::optional<FloatInput> bump;  // height in the scene's unit
  bool two_sided = true;  // false: the back absorbs (Mitsuba's opaque models without "twosided")

  Material() = default;
  template <class M>
  requires std::constructible_from<MaterialModel, M> Material(M m) : model(std::move(m)) {}
};

}  // namespace lockstep
