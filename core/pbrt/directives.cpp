#include "core/pbrt/directives.h"

#include "core/pbrt/call.h"
#include "core/pbrt/transform.h"

#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>

namespace lockstep::pbrt {

namespace {

// --- Scopes and coordinate systems

void attribute_begin(State& state, const Call& call) { push_scope(state, call); }

void attribute_end(State& state, const Call& call) {
  state.attributes = pop_scope(state, call, "AttributeBegin");
}

void transform_begin(State& state, const Call& call) { push_scope(state, call); }

void transform_end(State& state, const Call& call) {
  state.attributes.ctm = pop_scope(state, call, "TransformBegin").ctm;
}

void reverse_orientation(State& state, const Call&) {
  state.attributes.reverse_orientation = !state.attributes.reverse_orientation;
}

void coordinate_system(State& state, const Call& call) {
  state.coordinate_systems[call.read_name("the coordinate system's name")] = state.attributes.ctm;
}

void coord_sys_transform(State& state, const Call& call) {
  const std::string name = call.read_name("the coordinate system's name");
  const auto found = state.coordinate_systems.find(name);
  if (found == state.coordinate_systems.end()) {
    fail(call.where, "the coordinate system \"" + name + "\" has not been defined");
  }
  state.attributes.ctm = found->second;
}

void active_transform(State& state, const Call& call) {
  const Token which = call.lexer.next();
  if (which.text != "StartTime" && which.text != "EndTime" && which.text != "All") {
    fail(call.where, "ActiveTransform needs StartTime, EndTime or All, found " + shown(which));
  }
  state.attributes.at_shutter_open = which.text != "EndTime";
  state.library.warnings.add(call.where,
                             "motion is not supported; the transforms at the start are used");
}

void transform_times(State&, const Call& call) {
  for (int i = 0; i < 2; ++i) call.lexer.expect_number("two times after TransformTimes");
}

void include(State& state, const Call& call) {
  const std::string name = call.read_name("a file name");
  read_file(state, resolve(state.library, call.where.file, name), call.where);
}

// --- The table

enum class Block { Anywhere, Options, World };

struct Directive {
  void (*carry_out)(State&, const Call&);
  Block block = Block::Anywhere;
};

const std::unordered_map<std::string_view, Directive>& directives() {
  static const std::unordered_map<std::string_view, Directive> table = {
      {"Accelerator", {accelerator, Block::Options}},
      {"ActiveTransform", {active_transform}},
      {"AreaLightSource", {area_light_source, Block::World}},
      {"Attribute", {attribute}},
      {"AttributeBegin", {attribute_begin}},
      {"AttributeEnd", {attribute_end}},
      {"Camera", {camera, Block::Options}},
      {"ColorSpace", {color_space}},
      {"CoordSysTransform", {coord_sys_transform}},
      {"CoordinateSystem", {coordinate_system}},
      {"Film", {film, Block::Options}},
      {"Import", {include}},
      {"Include", {include}},
      {"Integrator", {integrator, Block::Options}},
      {"LightSource", {light_source, Block::World}},
      {"MakeNamedMaterial", {make_named_material}},
      {"MakeNamedMedium", {make_named_medium}},
      {"Material", {material}},
      {"MediumInterface", {medium_interface}},
      {"NamedMaterial", {named_material}},
      {"ObjectBegin", {object_begin, Block::World}},
      {"ObjectEnd", {object_end, Block::World}},
      {"ObjectInstance", {object_instance, Block::World}},
      {"Option", {option, Block::Options}},
      {"PixelFilter", {pixel_filter, Block::Options}},
      {"Renderer", {renderer, Block::Options}},
      {"ReverseOrientation", {reverse_orientation}},
      {"Sampler", {sampler, Block::Options}},
      {"Shape", {shape, Block::World}},
      {"SurfaceIntegrator", {surface_integrator, Block::Options}},
      {"Texture", {texture}},
      {"TransformBegin", {transform_begin}},
      {"TransformEnd", {transform_end}},
      {"TransformTimes", {transform_times}},
      {"Volume", {volume, Block::World}},
      {"VolumeIntegrator", {renderer, Block::Options}},
      {"WorldBegin", {world_begin, Block::Options}},
      {"WorldEnd", {world_end, Block::World}},
  };
  return table;
}

void carry_out_transform(State& state, Lexer& lexer, const Token& token) {
  glm::dmat4 ctm = state.attributes.ctm;
  apply_transform_directive(token, lexer, ctm);
  if (state.attributes.at_shutter_open) state.attributes.ctm = ctm;
}

// Carries out the directive that `token`, just taken from `lexer`, names.
void carry_out(State& state, Lexer& lexer, const Token& token) {
  const Location where = lexer.at(token);
  if (token.kind != Token::Kind::Word) fail(where, "expected a directive, found " + shown(token));
  if (is_transform_directive(token.text)) return carry_out_transform(state, lexer, token);

  const auto found = directives().find(token.text);
  if (found == directives().end()) fail(where, "unknown directive " + shown(token));
  const std::string name(token.text);
  const Block block = found->second.block;
  if (block == Block::World && !state.in_world) fail(where, name + " must come after WorldBegin");
  if (block == Block::Options && state.in_world) {
    fail(where, name + " must come before WorldBegin");
  }
  ++state.library.order;
  found->second.carry_out(state, {lexer, name, where});
}

}  // namespace

void push_scope(State& state, const Call& call) {
  constexpr size_t deepest = 1000;
  if (state.scopes.size() == deepest) {
    fail(call.where, call.name + " is nested more than " + std::to_string(deepest) +
                         " deep; is an end missing?");
  }
  state.scopes.push_back({call.name, call.where, state.attributes});
}

Attributes pop_scope(State& state, const Call& call, const char* begin) {
  if (state.scopes.empty()) {
    fail(call.where, call.name + " without " + std::string(begin));
  }
  if (state.scopes.back().begin != begin) {
    const Scope& open = state.scopes.back();
    fail(call.where, call.name + " does not close the " + open.begin + " of line " +
                         std::to_string(open.where.line));
  }
  Attributes saved = std::move(state.scopes.back().saved);
  state.scopes.pop_back();
  return saved;
}

void read_file(State& state, const std::string& path, const Location& from) {
  constexpr int deepest = 32;
  if (state.include_depth == deepest) {
    fail(from, "files include one another more than " + std::to_string(deepest) + " deep; does \"" +
                   path + "\" include itself?");
  }
  // Files that each include two others would be read for ever.
  constexpr int most_files = 10'000;
  if (++state.files_read > most_files) {
    fail(from, "more than " + std::to_string(most_files) + " files are included; join some");
  }
  ++state.include_depth;
  Lexer lexer(path, read_text(path, from));
  while (lexer.peek().kind != Token::Kind::End && !state.world_ended) {
    carry_out(state, lexer, lexer.next());
  }
  --state.include_depth;
}

}  // namespace lockstep::pbrt
