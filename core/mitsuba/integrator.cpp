#include "core/mitsuba/integrator.h"

#include <algorithm>

namespace lockstep::mitsuba {

void read_integrator(State& state, const Element& element) {
  const Nesting nesting(state, element);
  const Properties set = state.properties(element);
  // Some wrap another one, such as "aov" and "adaptive".
  const std::vector<const Property*> inside = set.objects("integrator");
  if (!inside.empty()) return read_integrator(state, inside.front()->element);

  constexpr int unlimited = 64;
  int& depth = state.scene.defaults.depth;
  if (set.type() == "direct") {
    depth = 1;
  } else {
    const int edges = set.get_int("max_depth", -1);
    depth = edges < 0 ? unlimited : std::max(edges - 1, 0);
  }
  if (set.type() != "path" && set.type() != "direct" && set.type() != "volpath") {
    state.warnings.add(set.where(), "<integrator type=\"" + element.attribute("type") +
                                        "\">: the scene is rendered with the path tracer");
  }
  if (set.has("hide_emitters") && set.get_bool("hide_emitters", false)) {
    state.warnings.add(set.where(), "hide_emitters is not supported; lights are visible");
  }
}

}  // namespace lockstep::mitsuba
