#include "core/pbrt/lights.h"

#include "core/pbrt/spectrum.h"

#include <glm/common.hpp>

#include <algorithm>
#include <numbers>

namespace lockstep::pbrt {

namespace {

// "L" times "scale", which is a number in v4 and a colour in v3.
glm::vec3 get_radiance(const ParameterSet& set, Warnings& warnings) {
  const glm::vec3 radiance = get_color(set, "L", ColorUse::Light, glm::vec3(1.0f), warnings) *
                             get_color(set, "scale", ColorUse::Light, glm::vec3(1.0f), warnings);
  if (std::min({radiance.x, radiance.y, radiance.z}) < 0.0f) {
    fail(set.where(), set.owner() + " has negative radiance");
  }
  return radiance;
}

}  // namespace

std::optional<Emission> make_area_light(const std::string& type, const ParameterSet& set,
                                        Warnings& warnings) {
  if (type != "diffuse" && type != "area") {
    warnings.add(set.where(), "AreaLightSource \"" + type + "\" is not supported; it is left out");
    return std::nullopt;
  }
  Emission emission;
  emission.radiance = get_radiance(set, warnings);
  emission.two_sided = set.get_bool("twosided", false);
  set.ignore({"nsamples", "samples"});
  set.warn_unused(warnings);
  if (emission.radiance.value == glm::vec3(0.0f)) return std::nullopt;
  return emission;
}

std::optional<glm::vec3> make_environment(const std::string& type, const ParameterSet& set,
                                          Warnings& warnings) {
  if (type != "infinite") {
    warnings.add(set.where(), "LightSource \"" + type + "\" is not supported; it is left out");
    return std::nullopt;
  }
  glm::vec3 radiance = get_radiance(set, warnings);
  const float illuminance = set.get_float("illuminance", -1.0f);
  if (illuminance > 0.0f) {
    radiance *= illuminance * std::numbers::inv_pi_v<float>;  // of a surface under half the sky
  }
  for (const char* map : {"mapname", "filename"}) {
    if (set.get_string(map, "").empty()) continue;
    warnings.add(set.where(),
                 "environment maps are not supported yet; constant radiance is used instead");
  }
  set.ignore({"nsamples", "samples"});
  set.warn_unused(warnings);
  return radiance;
}

}  // namespace lockstep::pbrt
