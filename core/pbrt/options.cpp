// Directives that describe how the world is looked at.
#include "core/pbrt/call.h"
#include "core/pbrt/view.h"

#include <glm/matrix.hpp>

namespace lockstep::pbrt {

void camera(State& state, const Call& call) {
  const std::string type = call.read_name("the camera's type");
  const ParameterSet set = call.read_parameters(type);
  state.scene.camera = make_camera(type, state.attributes.ctm, set, state.library.warnings);
  state.window = make_window(set);
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
  int& spp = state.scene.defaults.spp;
  if (set.any("xsamples") != nullptr || set.any("ysamples") != nullptr) {
    const int x = set.get_int("xsamples", 4), y = set.get_int("ysamples", 4);
    constexpr int most = 1 << 15;
    if (x < 1 || y < 1 || x > most || y > most) {
      fail(call.where, "Sampler needs xsamples and ysamples above 0");
    }
    spp = x * y;
  }
  spp = set.get_int("pixelsamples", spp);
  if (spp < 1) fail(call.where, "Sampler needs pixelsamples above 0");
}

void integrator(State& state, const Call& call) {
  const std::string type = call.read_name("the integrator's type");
  const ParameterSet set = call.read_parameters(type);
  state.scene.defaults.depth = set.get_int("maxdepth", state.scene.defaults.depth);
  if (state.scene.defaults.depth < 0) fail(call.where, call.name + " needs maxdepth of 0 or more");
  if (type != "path" && type != "volpath") {
    state.library.warnings.add(
        call.where, call.name + " \"" + type + "\": the scene is rendered with the path tracer");
  }
}

void surface_integrator(State& state, const Call& call) {
  state.v2_directive = true;
  integrator(state, call);
}

// v2's Renderer and VolumeIntegrator; most name what is used anyway.
void renderer(State& state, const Call& call) {
  state.v2_directive = true;
  call.read_parameters(call.read_name("its type"));
}

void color_space(State& state, const Call& call) {
  const std::string name = call.read_name("the colour space's name");
  if (name == "srgb") return;
  state.library.warnings.add(call.where,
                             "ColorSpace \"" + name + "\" is not supported; srgb is used");
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
