#include "core/pbrt/media.h"

#include "core/pbrt/call.h"
#include "core/pbrt/colors.h"

#include <glm/common.hpp>

namespace lockstep::pbrt {

glm::vec3 medium_absorption(Library& library, const std::string& name, int order,
                            const Location& where) {
  const MediumDeclaration* medium = library.media.find(name, order);
  if (medium == nullptr) fail(where, "the medium \"" + name + "\" has not been defined");
  const ParameterSet& set = medium->set;
  Warnings& warnings = library.warnings;
  if (medium->type != "homogeneous") {
    warnings.add(set.where(),
                 "media of the type \"" + medium->type + "\" are not supported; they are left out");
    return glm::vec3(0.0f);
  }
  if (!set.get_string("preset", "").empty()) {
    warnings.add(set.where(), "named presets of media are not supported; they are left out");
    return glm::vec3(0.0f);
  }
  // Without parameters both versions have the same medium, per millimetre.
  const auto get = [&](const char* quantity, glm::vec3 fallback) {
    return get_color(set, quantity, ColorUse::Reflectance, fallback, library);
  };
  const glm::vec3 absorption = get("sigma_a", glm::vec3(0.0011f, 0.0024f, 0.014f));
  const glm::vec3 scattering = get("sigma_s", glm::vec3(2.55f, 3.21f, 3.77f));
  const float scale = set.get_float("scale", 1.0f);
  if (scattering != glm::vec3(0.0f)) {
    warnings.add(set.where(), "scattering inside of media is not supported; they only absorb");
  }
  set.ignore({"type", "g", "Lescale"});
  set.warn_unused(warnings);
  return glm::max(absorption * scale, 0.0f);
}

void make_named_medium(State& state, const Call& call) {
  const std::string name = call.read_name("the medium's name");
  const ParameterSet set = with_defaults(state, call, name, "medium");
  const std::string type = set.get_string("type", "");
  if (set.any("type") == nullptr) fail(call.where, set.owner() + " needs \"string type\"");
  Library& library = state.library;
  library.media.declare(name, library.order, {type, set});
}

void medium_interface(State& state, const Call& call) {
  state.attributes.inside = call.read_name("the name of the medium inside");
  const bool two = call.lexer.peek().kind == Token::Kind::String;
  const std::string outside =
      two ? call.read_name("the name of the medium outside") : state.attributes.inside;
  if (outside.empty()) return;
  state.library.warnings.add(call.where,
                             "media outside of dielectrics are not supported; they are left out");
}

// v2
void volume(State& state, const Call& call) {
  call.read_parameters(call.read_name("the volume's type"));
  state.v2_directive = true;
  state.library.warnings.add(call.where, "volumes are not supported; they are left out");
}

}  // namespace lockstep::pbrt
