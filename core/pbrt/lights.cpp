#include "core/pbrt/lights.h"

#include "core/pbrt/colors.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lockstep::pbrt {

namespace {

constexpr float pi = std::numbers::pi_v<float>;

// The intensity, scaled so that a light of intensity 1, which emits `unit_power`, would emit
// "power" (v4).
glm::vec3 get_intensity(const ParameterSet& set, float unit_power, Library& library) {
  const glm::vec3 intensity = get_light_color(set, "I", library);
  const float power = set.get_float("power", -1.0f);
  return power > 0.0f && unit_power > 0.0f ? intensity * (power / unit_power) : intensity;
}

glm::vec3 get_position(const ParameterSet& set, const glm::dmat4& light_to_world) {
  const glm::dvec4 from(glm::dvec3(set.get_point("from", glm::vec3(0.0f))), 1.0);
  return glm::vec3(light_to_world * from);
}

// The unit vector along which the light goes.
glm::vec3 get_direction(const ParameterSet& set, const glm::dmat4& light_to_world) {
  const glm::dvec3 from = set.get_point("from", glm::vec3(0.0f));
  const glm::dvec3 to = set.get_point("to", glm::vec3(0.0f, 0.0f, 1.0f));
  const glm::dvec3 d = glm::dmat3(light_to_world) * (to - from);
  const double length = glm::length(d);
  if (!(length > 0.0)) fail(set.where(), set.owner() + " needs two distinct points");
  return glm::vec3(d / length);
}

PointLight point_light(const ParameterSet& set, const glm::dmat4& m, Library& library) {
  return {get_position(set, m), get_intensity(set, 4.0f * pi, library)};
}

// The light of an image or a table of angles, without them.
PointLight shaped_light(const ParameterSet& set, const glm::dmat4& m, Library& library) {
  library.warnings.add(set.where(),
                       set.owner() + " is not supported; it shines evenly in all directions");
  set.ignore({"filename", "mapname", "fov"});
  return point_light(set, m, library);
}

SpotLight spot_light(const ParameterSet& set, const glm::dmat4& m, Library& library) {
  const float outer = set.get_float("coneangle", 30.0f);
  const float inner = outer - set.get_float("conedeltaangle", 5.0f);
  SpotLight light;
  light.position = get_position(set, m);
  light.direction = get_direction(set, m);
  light.cos_outer = std::cos(glm::radians(std::clamp(outer, 0.0f, 180.0f)));
  light.cos_inner = std::cos(glm::radians(std::clamp(inner, 0.0f, 180.0f)));
  light.cos_inner = std::max(light.cos_inner, light.cos_outer);
  const float unit_power =
      2.0f * pi * ((1.0f - light.cos_inner) + 0.5f * (light.cos_inner - light.cos_outer));
  light.intensity = get_intensity(set, unit_power, library);
  return light;
}

DistantLight distant_light(const ParameterSet& set, const glm::dmat4& m, Library& library) {
  DistantLight light;
  light.direction = get_direction(set, m);
  light.irradiance = get_light_color(set, "L", library);
  const float illuminance = set.get_float("illuminance", -1.0f);
  if (illuminance > 0.0f) light.irradiance *= illuminance;
  return light;
}

std::optional<LightSource> make(const std::string& type, const ParameterSet& set,
                                const glm::dmat4& m, Library& library) {
  if (type == "point") return point_light(set, m, library);
  if (type == "spot") return spot_light(set, m, library);
  if (type == "distant") return distant_light(set, m, library);
  if (type == "goniometric" || type == "projection") return shaped_light(set, m, library);
  return std::nullopt;
}

}  // namespace

glm::vec3 get_light_color(const ParameterSet& set, const char* name, Library& library) {
  const glm::vec3 color = get_color(set, name, ColorUse::Light, glm::vec3(1.0f), library) *
                          get_color(set, "scale", ColorUse::Light, glm::vec3(1.0f), library);
  if (std::min({color.x, color.y, color.z}) < 0.0f) {
    fail(set.where(), set.owner() + " has negative radiance");
  }
  if (!std::isfinite(color.x + color.y + color.z)) {
    fail(set.where(), set.owner() + " is brighter than a float can say");
  }
  return color;
}

std::optional<LightSource> make_light(const std::string& type, const ParameterSet& set,
                                      const glm::dmat4& light_to_world, Library& library) {
  std::optional<LightSource> light = make(type, set, light_to_world, library);
  if (!light) {
    library.warnings.add(set.where(),
                         "LightSource \"" + type + "\" is not supported; it is left out");
    return std::nullopt;
  }
  set.ignore({"nsamples", "samples"});
  set.warn_unused(library.warnings);
  return light;
}

}  // namespace lockstep::pbrt
