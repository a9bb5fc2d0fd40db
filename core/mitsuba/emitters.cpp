#include "core/mitsuba/emitters.h"

#include "core/mitsuba/colors.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <string_view>

namespace lockstep::mitsuba {
namespace {

void set_environment(State& state, const Properties& set, Environment environment) {
  if (state.scene.environment) {
    state.warnings.add(set.where(), "of several environments the first is used");
    return;
  }
  environment.where = set.where().file + ":" + std::to_string(set.where().line);
  state.scene.environment = std::move(environment);
}

void constant(State& state, const Properties& set) {
  set_environment(state, set, Environment(get_light(state, set, "radiance")));
}

// Mitsuba's u = atan2(x, -z) / 2 pi puts -z at the left edge of the map, where Environment has +z:
// half a turn around y lies between them.
void environment_map(State& state, const Properties& set) {
  const std::string name = set.get_string("filename", "");
  if (name.empty()) fail(set.where(), set.shown() + " needs a filename");
  const glm::dmat4 m = set.get_transform("to_world", state.warnings);
  Environment environment(glm::vec3(std::max(0.0f, set.get_float("scale", 1.0f))));
  environment.mapping = Environment::Mapping::LatLong;
  environment.file = resolve(state.sources, set.element(), name);
  environment.to_world =
      glm::mat3(glm::normalize(glm::vec3(-m[0])), glm::normalize(glm::vec3(m[1])),
                glm::normalize(glm::vec3(-m[2])));
  set.ignore({"cache", "mis_compensation"});
  set_environment(state, set, std::move(environment));
}

void sky(State& state, const Properties& set) {
  state.warnings.add(set.where(),
                     "skies and suns are not supported; an environment of constant "
                     "radiance is used, whose brightness is not theirs");
  const float scale = std::max(0.0f, set.get_float("scale", 1.0f));
  for (const char* tag :
       {"float", "vector", "rgb", "spectrum", "transform", "integer", "boolean"}) {
    set.objects(tag);
  }
  if (set.type() == "sun" && state.scene.environment) return;
  set_environment(state, set, Environment(glm::vec3(scale)));
}

glm::dmat4 to_world(State& state, const Properties& set) {
  return set.get_transform("to_world", state.warnings);
}

void point(State& state, const Properties& set) {
  PointLight light;
  const glm::dvec3 position = set.get_vector("position", glm::dvec3(0.0));
  light.position = glm::vec3(to_world(state, set) * glm::dvec4(position, 1.0));
  light.intensity = get_light(state, set, "intensity");
  if (!(glm::length(glm::dvec3(light.position)) < 1e38)) {
    fail(set.where(), set.shown() + " lies beyond the range of float");
  }
  state.scene.lights.emplace_back(light);
}

// Along +z of its own frame; the intensity falls linearly in the angle from beam_width to
// cutoff_angle, both from the axis.
void spot(State& state, const Properties& set) {
  const glm::dmat4 m = to_world(state, set);
  SpotLight light;
  light.position = glm::vec3(m[3]);
  light.direction = glm::vec3(glm::normalize(glm::dvec3(m[2])));
  light.intensity = get_light(state, set, "intensity");
  if (set.has("texture")) light.intensity *= get_light(state, set, "texture");
  const float cutoff = set.get_float("cutoff_angle", 20.0f);
  const float beam = set.get_float("beam_width", 0.75f * cutoff);
  if (!(cutoff > 0.0f && cutoff < 180.0f && beam >= 0.0f && beam <= cutoff)) {
    fail(set.where(), set.shown() + " needs 0 <= beam_width <= cutoff_angle < 180");
  }
  light.cos_inner = std::cos(glm::radians(beam));
  light.cos_outer = std::cos(glm::radians(cutoff));
  light.falloff = SpotLight::Falloff::LinearAngle;
  state.scene.lights.emplace_back(light);
}

void directional(State& state, const Properties& set) {
  const glm::dvec3 own = set.get_vector("direction", glm::dvec3(0.0, 0.0, 1.0));
  const glm::dvec3 direction = glm::dmat3(to_world(state, set)) * own;
  if (!(glm::length(direction) > 0.0)) fail(set.where(), set.shown() + " needs a direction");
  DistantLight light;
  light.direction = glm::vec3(glm::normalize(direction));
  light.irradiance = get_light(state, set, "irradiance");
  state.scene.lights.emplace_back(light);
}

struct Type {
  std::string_view name;
  void (*add)(State&, const Properties&);
};

constexpr Type types[] = {
    {"constant", constant},
    {"envmap", environment_map},
    {"point", point},
    {"spot", spot},
    {"directional", directional},
    {"sky", sky},
    {"sunsky", sky},
    {"sun", sky},
};

}  // namespace

void add_emitter(State& state, const Element& element) {
  const Properties set = state.properties(element);
  set.ignore({"sampling_weight"});
  for (const Type& type : types) {
    if (type.name != set.type()) continue;
    type.add(state, set);
    set.warn_unused(state.warnings);
    return;
  }
  state.warnings.add(set.where(), "<emitter type=\"" + element.attribute("type") +
                                      "\"> is not supported; it is left out");
}

}  // namespace lockstep::mitsuba
