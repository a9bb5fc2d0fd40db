// Directives that fill the world: materials, lights and shapes.
#include "core/pbrt/call.h"
#include "core/pbrt/lights.h"
#include "core/pbrt/materials.h"
#include "core/pbrt/shapes.h"

#include <algorithm>
#include <string_view>
#include <utility>

namespace lockstep::pbrt {

namespace {

bool in_object(const State& state) {
  return std::any_of(state.scopes.begin(), state.scopes.end(),
                     [](const Scope& scope) { return scope.begin == "ObjectBegin"; });
}

ParameterSet with_defaults(const State& state, const Call& call, const std::string& type,
                           const char* target) {
  ParameterSet set = call.read_parameters(type);
  const auto defaults = state.attributes.defaults.find(target);
  if (defaults != state.attributes.defaults.end()) set.add_defaults(defaults->second);
  return set;
}

int declare_material(State& state, std::optional<Material> material) {
  state.materials.push_back({std::move(material), -1});
  return static_cast<int>(state.materials.size()) - 1;
}

// The scene's index of the current material; nothing for an interface.
std::optional<int> scene_material(State& state) {
  DeclaredMaterial& declared = state.materials[state.attributes.material];
  if (!declared.material) return std::nullopt;
  if (declared.scene_index < 0) {
    declared.scene_index = static_cast<int>(state.scene.materials.size());
    state.scene.materials.push_back(*declared.material);
  }
  return declared.scene_index;
}

}  // namespace

// v4: Attribute "shape" [parameters] sets defaults of the shapes that follow.
void attribute(State& state, const Call& call) {
  const std::string target = call.read_name("what the attributes are for");
  constexpr std::string_view targets[] = {"shape", "light", "material", "medium", "texture"};
  if (std::find(std::begin(targets), std::end(targets), target) == std::end(targets)) {
    fail(call.where,
         "Attribute \"" + target + "\" is not one of shape, light, material, medium, " + "texture");
  }
  const ParameterSet set = call.read_parameters(target);
  std::vector<Parameter>& defaults = state.attributes.defaults[target];
  for (const Parameter& p : set.all()) {
    std::erase_if(defaults, [&](const Parameter& old) { return old.name == p.name; });
    defaults.push_back(p);
  }
}

void material(State& state, const Call& call) {
  const std::string type = call.read_name("the material's type");
  const ParameterSet set = with_defaults(state, call, type, "material");
  state.attributes.material = declare_material(state, make_material(type, set, state.warnings));
}

void make_named_material(State& state, const Call& call) {
  const std::string name = call.read_name("the material's name");
  const ParameterSet set = with_defaults(state, call, name, "material");
  const std::string type = set.get_string("type", "");
  if (set.any("type") == nullptr) {
    fail(call.where, set.owner() + " needs \"string type\"");
  }
  state.named_materials[name] = declare_material(state, make_material(type, set, state.warnings));
}

void named_material(State& state, const Call& call) {
  const std::string name = call.read_name("the material's name");
  const auto found = state.named_materials.find(name);
  if (found == state.named_materials.end()) {
    fail(call.where, "NamedMaterial \"" + name + "\" has not been defined");
  }
  state.attributes.material = found->second;
}

void texture(State& state, const Call& call) {
  call.read_name("the texture's name");
  call.read_name("the texture's value type");
  const std::string type = call.read_name("the texture's type");
  with_defaults(state, call, type, "texture");
  state.warnings.add(call.where, "textures are not supported yet; a mean grey of 0.5 is used");
}

void light_source(State& state, const Call& call) {
  const std::string type = call.read_name("the light's type");
  const ParameterSet set = with_defaults(state, call, type, "light");
  const std::optional<glm::vec3> added = make_environment(type, set, state.warnings);
  if (!added) return;
  state.scene.environment =
      state.scene.environment.value_or(Environment(glm::vec3(0.0f))).radiance + *added;
}

void area_light_source(State& state, const Call& call) {
  const std::string type = call.read_name("the area light's type");
  const ParameterSet set = with_defaults(state, call, type, "light");
  state.attributes.emission = make_area_light(type, set, state.warnings);
}

void shape(State& state, const Call& call) {
  const std::string type = call.read_name("the shape's type");
  const ParameterSet set = with_defaults(state, call, type, "shape");
  ShapeContext context;
  context.object_to_world = state.attributes.ctm;
  context.reverse_orientation = state.attributes.reverse_orientation;
  context.resolve = [&](const std::string& name) { return resolve(state, call.where.file, name); };
  std::optional<Geometry> geometry = make_shape(type, set, context, state.warnings);
  if (!geometry || in_object(state)) return;

  const std::optional<int> index = scene_material(state);
  if (!index) {
    state.warnings.add(call.where, "shapes with an interface material are left out");
    return;
  }
  state.scene.shapes.push_back({std::move(*geometry), *index, state.attributes.emission});
}

void media(State& state, const Call& call) {
  while (call.lexer.peek().kind == Token::Kind::String) {
    // MediumInterface has one or two names, MakeNamedMedium a name and parameters.
    const bool named = call.lexer.peek().text.find(' ') == std::string_view::npos;
    if (named) {
      call.lexer.next();
    } else {
      ParameterSet(call.lexer, call.name, call.where);
    }
  }
  state.warnings.add(call.where, "participating media are not supported; they are left out");
}

}  // namespace lockstep::pbrt
