// Objects and their instances.
#include "core/pbrt/call.h"

#include <utility>

namespace lockstep::pbrt {

void object_begin(State& state, const Call& call) {
  const std::string name = call.read_name("the object's name");
  if (state.open_object != nullptr) fail(call.where, "ObjectBegin inside another object");
  push_scope(state, call);
  state.open_object = &state.objects.declare(name, state.library.order, {});
}

void object_end(State& state, const Call& call) {
  state.attributes = pop_scope(state, call, "ObjectBegin");
  state.open_object = nullptr;
}

void object_instance(State& state, const Call& call) {
  const std::string name = call.read_name("the object's name");
  if (state.open_object != nullptr) {
    fail(call.where, "ObjectInstance inside an object; instances cannot be nested");
  }
  state.instances.push_back(
      {name, state.library.order, call.where, glm::mat4(state.attributes.ctm)});
}

}  // namespace lockstep::pbrt
