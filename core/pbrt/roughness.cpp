#include "core/pbrt/roughness.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>

namespace lockstep::pbrt {

namespace {

// pbrt-v3's fit of a slope width to a perceived roughness in [0, 1].
float v3_alpha(float roughness) {
  const float x = std::log(std::max(roughness, 1e-3f));
  return 1.62142f + x * (0.819955f + x * (0.1734f + x * (0.0171201f + x * 0.000640711f)));
}

float remapped(float roughness, Remap remap) {
  return remap == Remap::V3 ? v3_alpha(roughness) : std::sqrt(std::max(roughness, 0.0f));
}

// alpha = factor * roughness^power. For v3 the power law that is closest to the fit between 0.01
// and 1; they differ by less than 15 % there.
FloatInput remapped_texture(const Inputs& in, FloatInput roughness, Remap remap) {
  const bool exact = remap == Remap::V4;
  if (!exact) in.warn("textured roughness follows a power law close to pbrt-v3's remapping");
  roughness.power = exact ? 0.5f : 0.53f;
  roughness.value =
      (exact ? 1.0f : 1.6f) * std::pow(std::max(roughness.value, 0.0f), roughness.power);
  return roughness;
}

}  // namespace

Roughness get_roughness(const Inputs& in, float fallback, Remap remap, const std::string& prefix) {
  const FloatInput both = in.number(prefix + "roughness", fallback);
  const FloatInput u = in.find_number(prefix + "uroughness").value_or(both);
  const FloatInput v = in.find_number(prefix + "vroughness").value_or(both);
  const bool remaps = in.set().get_bool("remaproughness", true);
  Roughness roughness;
  if (u.texture >= 0 || v.texture >= 0) {
    if (u != v) in.warn("roughness that differs along u and v with a texture is made the same");
    const FloatInput& textured = u.texture >= 0 ? u : v;
    roughness.alpha = glm::vec2(1.0f);
    roughness.scale = remaps ? remapped_texture(in, textured, remap) : textured;
    return roughness;
  }
  roughness.alpha = {u.value, v.value};
  if (remaps) roughness.alpha = {remapped(u.value, remap), remapped(v.value, remap)};
  roughness.alpha = glm::clamp(roughness.alpha, 0.0f, 1.0f);
  return roughness;
}

Roughness get_glass_roughness(const Inputs& in) {
  const FloatInput both = in.number("roughness", 0.0f);
  const bool smooth = in.find_number("uroughness").value_or(both) == FloatInput(0.0f) &&
                      in.find_number("vroughness").value_or(both) == FloatInput(0.0f);
  if (!smooth) return get_roughness(in, 0.0f, Remap::V3);
  in.set().ignore({"remaproughness"});
  return {};
}

float isotropic(const Inputs& in, const Roughness& roughness) {
  const glm::vec2 alpha = roughness.alpha;
  if (alpha.x == alpha.y) return alpha.x;
  in.warn("roughness that differs along u and v is not supported; the geometric mean is used");
  return std::sqrt(alpha.x * alpha.y);
}

}  // namespace lockstep::pbrt
