// Directives that fill the world: materials, textures, lights and shapes.
#include "core/pbrt/call.h"
#include "core/pbrt/lights.h"
#include "core/pbrt/shapes.h"

#include <algorithm>
#include <string_view>
#include <utility>

namespace lockstep::pbrt {

namespace {

int declare_material(State& state, std::string type, ParameterSet set) {
  Library& library = state.library;
  library.materials.push_back({std::move(type), std::move(set), library.order});
  return static_cast<int>(library.materials.size()) - 1;
}

// Whether images might be looked up by the shape's (u, v).
bool may_be_textured(State& state, const ParameterSet& shape) {
  const MaterialReference& reference = state.attributes.material;
  Library& library = state.library;
  int index = reference.declared;
  if (!reference.name.empty()) {
    const int* named = library.named_materials.find(reference.name, reference.order);
    if (named == nullptr) return true;
    index = *named;
  }
  const MaterialDeclaration& material = library.materials[static_cast<size_t>(index)];
  const auto is_texture = [](const Parameter& p) {
    return p.type == "texture" || p.name == "normalmap";
  };
  const auto& light = state.attributes.area_light;
  return material.type == "mix" || (light && light->image) ||
         std::any_of(material.set.all().begin(), material.set.all().end(), is_texture) ||
         std::any_of(shape.all().begin(), shape.all().end(), is_texture);
}

Surface make_surface(const State& state, const Call& call, const ParameterSet& set) {
  Surface surface;
  surface.material = state.attributes.material;
  surface.medium = state.attributes.inside;
  surface.order = state.library.order;
  surface.where = call.where;
  if (const Parameter* p = set.find("alpha", {"texture"})) {
    if (p->strings.size() != 1) fail(set.where(*p), "\"texture alpha\" must have one value");
    surface.alpha_texture = p->strings[0];
  } else {
    surface.alpha = std::clamp(set.get_float("alpha", 1.0f), 0.0f, 1.0f);
  }
  return surface;
}

// Whether nothing that is looked up later tells the two apart.
bool are_alike(const Surface& a, const Surface& b) {
  const auto is_plain = [](const Surface& s) {
    return s.medium.empty() && s.alpha_texture.empty() && s.alpha == 1.0f;
  };
  return is_plain(a) && is_plain(b) && a.material.declared == b.material.declared &&
         a.material.order == b.material.order;
}

int add_surface(State& state, Surface surface) {
  std::vector<Surface>& surfaces = state.surfaces;
  if (surfaces.empty() || !are_alike(surfaces.back(), surface)) {
    surfaces.push_back(std::move(surface));
  }
  return static_cast<int>(surfaces.size()) - 1;
}

// Curves come in thousands: those that follow each other on one surface become one mesh. False
// where `shape` is the first of them.
bool joins_curves(const State& state, std::vector<Shape>& shapes, const Shape& shape) {
  if (state.curves != &shapes || shapes.empty()) return false;
  Shape& last = shapes.back();
  auto& all = std::get<TriangleMesh>(last.geometry);
  const auto& more = std::get<TriangleMesh>(shape.geometry);
  const size_t vertices = all.positions.size();
  if (last.material != shape.material || vertices + more.positions.size() > 1u << 30) return false;
  const auto append = [](auto& to, const auto& from) {
    to.insert(to.end(), from.begin(), from.end());
  };
  append(all.positions, more.positions);
  append(all.normals, more.normals);
  append(all.uvs, more.uvs);
  for (const glm::uvec3 t : more.triangles) {
    all.triangles.push_back(t + glm::uvec3(static_cast<unsigned>(vertices)));
  }
  return true;
}

}  // namespace

ParameterSet with_defaults(const State& state, const Call& call, const std::string& type,
                           const char* target) {
  ParameterSet set = call.read_parameters(type);
  const auto defaults = state.attributes.defaults.find(target);
  if (defaults != state.attributes.defaults.end()) set.add_defaults(defaults->second);
  return set;
}

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
  // Each scope and each declaration that follows has a copy.
  constexpr size_t most_values = 256;
  size_t values = 0;
  for (const Parameter& p : defaults) values += p.numbers.size() + p.strings.size();
  if (values > most_values) {
    fail(call.where, "Attribute \"" + target + "\" holds more than " + std::to_string(most_values) +
                         " values; state them where they are used");
  }
}

void material(State& state, const Call& call) {
  const std::string type = call.read_name("the material's type");
  state.attributes.material = {};
  state.attributes.material.declared =
      declare_material(state, type, with_defaults(state, call, type, "material"));
}

void make_named_material(State& state, const Call& call) {
  const std::string name = call.read_name("the material's name");
  ParameterSet set = with_defaults(state, call, name, "material");
  const std::string type = set.get_string("type", "");
  if (set.any("type") == nullptr) {
    fail(call.where, set.owner() + " needs \"string type\"");
  }
  const int index = declare_material(state, type, std::move(set));
  state.library.named_materials.declare(name, state.library.order, index);
}

void named_material(State& state, const Call& call) {
  const std::string name = call.read_name("the material's name");
  state.attributes.material = {0, name, state.library.order, call.where};
  if (state.library.named_materials.find(name, state.library.order) == nullptr) {
    state.unknown_materials.push_back(state.attributes.material);
  }
}

void texture(State& state, const Call& call) {
  const std::string name = call.read_name("the texture's name");
  const std::string value = call.read_name("the texture's value type");
  const std::string type = call.read_name("the texture's type");
  const bool is_color = value == "spectrum" || value == "color";
  if (!is_color && value != "float") {
    fail(call.where, "Texture \"" + name + "\" is of the type \"" + value +
                         "\"; it must be spectrum, color or float");
  }
  Library& library = state.library;
  auto& textures = is_color ? library.color_textures : library.float_textures;
  ParameterSet set = with_defaults(state, call, type, "texture");
  textures.declare(name, library.order, {name, type, std::move(set), library.order});
}

void light_source(State& state, const Call& call) {
  const std::string type = call.read_name("the light's type");
  const ParameterSet set = with_defaults(state, call, type, "light");
  if (type == "infinite") {
    add_environment(set, state.attributes.ctm, state.library, state.scene.environment);
  } else if (const auto light = make_light(type, set, state.attributes.ctm, state.library)) {
    state.scene.lights.push_back(*light);
  }
}

void area_light_source(State& state, const Call& call) {
  const std::string type = call.read_name("the area light's type");
  const ParameterSet set = with_defaults(state, call, type, "light");
  state.attributes.area_light = make_area_light(type, set, state.library);
}

void shape(State& state, const Call& call) {
  const std::string type = call.read_name("the shape's type");
  const ParameterSet set = with_defaults(state, call, type, "shape");
  Surface surface = make_surface(state, call, set);
  ShapeContext context;
  context.object_to_world = state.attributes.ctm;
  context.reverse_orientation = state.attributes.reverse_orientation;
  context.may_be_textured = may_be_textured(state, set);
  context.triangles_left = state.triangles_left;
  context.resolve = [&](const std::string& name) {
    return resolve(state.library, call.where.file, name);
  };
  auto found = make_shape(type, set, context, state.library.warnings);
  if (!found) return;
  Shape made;
  if (auto* geometry = std::get_if<Geometry>(&*found)) made.geometry = std::move(*geometry);
  if (type == "loopsubdiv" || type == "curve") {
    state.triangles_left -= double(std::get<TriangleMesh>(made.geometry).triangles.size());
  }

  made.material = add_surface(state, std::move(surface));
  AreaLight* light = state.attributes.area_light.get();
  if (light != nullptr && state.open_object != nullptr) {
    state.library.warnings.add(call.where, "shapes of objects do not emit; place them without one");
  } else if (light != nullptr) {
    made.emission = emission_of(*light, state.library);
    // A mesh that is still to be read has no area, which leaves the emission as it is.
    set_power(light->power, made.geometry, *made.emission);
  }
  auto& shapes = state.open_object != nullptr ? state.open_object->shapes : state.scene.shapes;
  if (auto* file = std::get_if<MeshFile>(&*found)) {
    state.mesh_files.push_back(std::move(*file));
    state.file_shapes.push_back({&shapes, shapes.size(), light != nullptr ? light->power : 0.0f});
  }
  const bool gathers = type == "curve" && !made.emission;
  if (gathers && joins_curves(state, shapes, made)) return;
  state.curves = gathers ? &shapes : nullptr;
  shapes.push_back(std::move(made));
}

}  // namespace lockstep::pbrt
