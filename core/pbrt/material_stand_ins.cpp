// Materials that the scene description cannot say: the nearest that it can.
#include "core/pbrt/material_types.h"
#include "core/pbrt/roughness.h"

#include <glm/common.hpp>
#include <glm/exponential.hpp>

#include <algorithm>

namespace lockstep::pbrt {

namespace {

// Diffuse reflectance of a half-space of a scattering medium with a matched boundary
// (Jensen et al. 2001, section 2.4, with A = 1).
glm::vec3 albedo_of_medium(glm::vec3 absorption, glm::vec3 scattering) {
  const glm::vec3 a = scattering / glm::max(absorption + scattering, 1e-12f);
  const glm::vec3 s = glm::sqrt(3.0f * (1.0f - a));
  return 0.5f * a * (1.0f + glm::exp(-4.0f / 3.0f * s)) * glm::exp(-s);
}

// The surface's own colour, or that of the medium inside.
ColorInput subsurface_color(const Inputs& in) {
  for (const char* name : {"reflectance", "Kd"}) {
    if (in.set().any(name) != nullptr) return in.reflectance(name, 0.5f);
  }
  const bool named = !in.set().get_string("name", "").empty();
  if (named && in.set().any("sigma_s") == nullptr) return glm::vec3(0.5f);
  const ColorInput absorption = in.color("sigma_a", glm::vec3(0.0011f, 0.0024f, 0.014f));
  const ColorInput scattering = in.color("sigma_s", glm::vec3(2.55f, 3.21f, 3.77f));
  if (absorption.texture >= 0 || scattering.texture >= 0) return glm::vec3(0.5f);
  const float forward = glm::clamp(in.set().get_float("g", 0.0f), -1.0f, 1.0f);
  return albedo_of_medium(absorption.value, scattering.value * (1.0f - forward));
}

}  // namespace

MadeMaterial subsurface(const Inputs& in) {
  in.warn("light does not travel below the surface; a diffuse base under a coat is used");
  CoatedMaterial m;
  m.diffuse = subsurface_color(in);
  m.eta = std::max(dielectric_index(in, "eta", 1.33f), 1.001f);
  const Roughness roughness = in.library().version == Version::v4
                                  ? get_roughness(in, 0.0f, Remap::V4)
                                  : get_glass_roughness(in);
  m.alpha = isotropic(in, roughness);
  m.alpha_scale = roughness.scale;
  m.specular = in.reflectance("Kr", 1.0f);
  in.set().ignore({"Kt", "mfp", "scale", "g", "name", "sigma_a", "sigma_s"});
  return m;
}

MadeMaterial hair(const Inputs& in) {
  in.warn("fibres are not supported; the surface is diffuse");
  in.set().ignore({"sigma_a", "eumelanin", "pheomelanin", "eta", "beta_m", "beta_n", "alpha"});
  return DiffuseMaterial{
      in.reflectance(in.set().any("color") != nullptr ? "color" : "reflectance", 0.5f)};
}

MadeMaterial fourier(const Inputs& in) {
  in.warn("reflectance as a Fourier series is not supported; a diffuse grey is used");
  in.set().ignore({"bsdffile"});
  return DiffuseMaterial{};
}

}  // namespace lockstep::pbrt
