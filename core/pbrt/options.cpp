// Directives that describe how the world is looked at.
#include "core/pbrt/call.h"
#include "core/pbrt/view.h"

#include <glm/matrix.hpp>

namespace lockstep::pbrt {

void camera(State& state, const Call& call) {
  const std::string type = call.read_name("the camera's type");
  const ParameterSet set = call.read_parameters(type);
  state.scene.camera = make_camera(type, state.attributes.ctm, set, state.warnings);
  state.coordinate_systems["camera"] = glm::inverse(state.attributes.ctm);
}

void film(State& state, const Call& call) {
  state.film_type = call.read_name("the film's type");
  state.film = call.read_parameters(state.film_type);
}

void pixel_filter(State& state, const Call& call) {
  state.filter.first = call.read_name("the filter's type");
  state.filter.second = call.read_parameters(state.filter.first);
}

void sampler(State& state, const Call& call) {
  // The command line chooses the sampler; only the file's sample count matters.
  const ParameterSet set = call.read_parameters(call.read_name("the sampler's type"));
  state.scene.defaults.spp = set.get_int("pixelsamples", state.scene.defaults.spp);
  if (state.scene.defaults.spp < 1) fail(call.where, "Sampler needs pixelsamples above 0");
}

void integrator(State& state, const Call& call) {
  const std::string type = call.read_name("the integrator's type");
  const ParameterSet set = call.read_parameters(type);
  state.scene.defaults.depth = set.get_int("maxdepth", state.scene.defaults.depth);
  if (state.scene.defaults.depth < 0) fail(call.where, "Integrator needs maxdepth of 0 or more");
  if (type != "path" && type != "volpath") {
    state.warnings.add(call.where,
                       "Integrator \"" + type + "\": the scene is rendered with the path tracer");
  }
}

void color_space(State& state, const Call& call) {
  const std::string name = call.read_name("the colour space's name");
  if (name == "srgb") return;
  state.warnings.add(call.where, "ColorSpace \"" + name + "\" is not supported; srgb is used");
}

void accelerator(State&, const Call& call) {
  call.read_parameters(call.read_name("the accelerator's type"));
}

void option(State&, const Call& call) { ParameterSet(call.lexer, call.name, call.where); }

void world_begin(State& state, const Call& call) {
  if (!state.scopes.empty()) fail(call.where, "WorldBegin inside " + state.scopes.back().begin);
  state.in_world = true;
  state.attributes.ctm = glm::dmat4(1.0);
  state.attributes.at_shutter_open = true;
  state.coordinate_systems["world"] = glm::dmat4(1.0);
}

void world_end(State& state, const Call&) { state.world_ended = true; }

}  // namespace lockstep::pbrt
