// The closed set of surface materials. To add one: a struct here, its kernel in core/bsdf/, and a
// line in core/bsdf.h. Reflectances are linear RGB in [0, 1]; alpha is GGX's roughness parameter.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <variant>

namespace lockstep {

struct DiffuseMaterial {
  glm::vec3 reflectance{0.5f};
};

// Metal with GGX roughness; eta and k are the real and imaginary index of refraction per channel.
struct ConductorMaterial {
  glm::vec3 eta{0.2f, 0.92f, 1.1f};
  glm::vec3 k{3.9f, 2.45f, 2.14f};
  glm::vec2 alpha{0.1f};
};

// A diffuse base under a rough dielectric coat.
// `layered`: light pays the coat's Fresnel transmittance on its way in and out, and what the coat
// reflects back inside is summed (pbrt-v4 coateddiffuse, in closed form). Otherwise coat and base
// are simply added (pbrt-v3 plastic).
struct CoatedMaterial {
  glm::vec3 diffuse{0.5f};
  glm::vec3 specular{1.0f};  // scales the coat's reflection
  float alpha = 0.1f;
  float eta = 1.5f;
  bool layered = true;
};

using Material = std::variant<DiffuseMaterial, ConductorMaterial, CoatedMaterial>;

}  // namespace lockstep
