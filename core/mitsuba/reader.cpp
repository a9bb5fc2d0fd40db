#include "core/mitsuba/reader.h"

#include "core/default_view.h"
#include "core/mitsuba/emitters.h"
#include "core/mitsuba/integrator.h"
#include "core/mitsuba/sensor.h"
#include "core/mitsuba/shapes.h"

#include <filesystem>
#include <utility>

namespace lockstep {

namespace mitsuba {
namespace {

constexpr int unlimited_depth = 64;

bool is_passive(const std::string& tag) {
  for (const char* known : {"bsdf", "texture", "film", "sampler", "rfilter", "spectrum", "rgb"}) {
    if (tag == known) return true;  // seen through references
  }
  return false;
}

void read_object(State& state, const Element& element, bool& has_sensor) {
  const std::string tag = element.tag();
  if (tag == "shape") {
    add_shape(state, element);
  } else if (tag == "emitter" || tag == "luminaire") {
    add_emitter(state, element);
  } else if (tag == "integrator") {
    read_integrator(state, element);
  } else if (tag == "sensor" || tag == "camera") {
    if (has_sensor) {
      state.warnings.add(element.where(), "of several sensors the first is used");
    } else {
      read_sensor(state, element);
    }
    has_sensor = true;
  } else if (!is_passive(tag)) {
    state.warnings.add(element.where(), std::string("<") + element.node.name() +
                                            "> of the scene is not understood; it is left out");
  }
}

}  // namespace
}  // namespace mitsuba

SceneDescription read_mitsuba(const std::string& path) {
  mitsuba::State state;
  state.scene.name = std::filesystem::path(path).stem().string();
  state.scene.defaults.depth = mitsuba::unlimited_depth;
  state.sources = mitsuba::read_sources(path, state.warnings);
  bool has_sensor = false;
  const std::vector<mitsuba::Element> top_level = state.sources.top_level;
  mitsuba::read_shapes_ahead(state, top_level);
  for (const mitsuba::Element& element : top_level) {
    mitsuba::read_object(state, element, has_sensor);
  }
  const std::vector<std::string>& lines = state.warnings.lines();
  state.scene.warnings.insert(state.scene.warnings.end(), lines.begin(), lines.end());
  if (!has_sensor) add_default_camera(state.scene);
  add_default_light(state.scene);
  return std::move(state.scene);
}

}  // namespace lockstep
