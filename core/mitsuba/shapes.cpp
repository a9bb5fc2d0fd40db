#include "core/mitsuba/shapes.h"

#include "core/mitsuba/bsdfs.h"
#include "core/mitsuba/colors.h"
#include "core/mitsuba/meshes.h"
#include "core/mitsuba/primitives.h"
#include "core/mitsuba/textured.h"
#include "core/mtl.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>

namespace lockstep::mitsuba {
namespace {

// Where shapes go: the scene, or a group.
struct Target {
  std::vector<Shape>& shapes;
  bool in_group = false;
};

struct ShapeCall {
  State& state;
  const Properties& set;
  glm::dmat4 to_world{1.0};
  bool flip = false;
};

std::optional<Emission> get_emission(State& state, const Properties& set) {
  const std::vector<const Property*> emitters = set.objects("emitter");
  if (emitters.empty()) return std::nullopt;
  const Properties light = state.properties(emitters.front()->element);
  if (light.type() != "area") {
    state.warnings.add(light.where(), "<emitter type=\"" + light.type() +
                                          "\"> on shapes is not supported; it is left out");
    return std::nullopt;
  }
  Emission emission;
  const char* name = light.has("intensity") ? "intensity" : "radiance";
  emission.radiance = get_color(state, light, name, glm::vec3(1.0f), ColorUse::Light);
  const glm::vec3 value = emission.radiance.value;
  if (std::min({value.x, value.y, value.z}) < 0.0f) {
    fail(light.where(), light.shown() + " has negative radiance");
  }
  light.ignore({"sampling_weight"});
  light.warn_unused(state.warnings);
  if (value == glm::vec3(0.0f)) return std::nullopt;
  return emission;
}

// Without a model: grey; of a light in Mitsuba 0.x black.
Material default_material(const State& state, bool emits) {
  DiffuseMaterial diffuse;
  if (emits && !state.sources.modern) diffuse.reflectance = glm::vec3(0.0f);
  Material material(diffuse);
  material.two_sided = false;
  return material;
}

std::optional<int> get_material(State& state, const Properties& set, bool emits) {
  const std::vector<const Property*> models = set.objects("bsdf");
  if (models.empty()) return add_material(state, default_material(state, emits));
  const std::optional<int> index = material_index(state, models.front()->element);
  if (index || !emits) return index;
  Material black(DiffuseMaterial{glm::vec3(0.0f), 0.0f});
  return add_material(state, black);
}

bool is_similarity(const glm::dmat3& m, int axes) {
  const double scale = glm::length(m[0]);
  for (int i = 0; i < axes; ++i) {
    for (int j = i; j < axes; ++j) {
      const double expected = i == j ? 1.0 : 0.0;
      if (std::abs(glm::dot(m[i], m[j]) / (scale * scale) - expected) > 1e-5) return false;
    }
  }
  return true;
}

bool is_finite(glm::vec3 p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

[[noreturn]] void fail_range(const ShapeCall& call) {
  fail(call.set.where(), call.set.shown() + " leaves the range of float in world space");
}

// Moves a mesh from object space.
Geometry to_world(const ShapeCall& call, TriangleMesh mesh, const glm::dmat4& m) {
  apply_transform(mesh, glm::mat4(m));
  if (!std::all_of(mesh.positions.begin(), mesh.positions.end(), is_finite)) fail_range(call);
  if (call.flip) turn_over(mesh);
  return mesh;
}

glm::dmat4 placed(glm::dvec3 origin, double scale) {
  glm::dmat4 m(scale);
  m[3] = glm::dvec4(origin, 1.0);
  return m;
}

float get_radius(const ShapeCall& call) {
  const float radius = call.set.get_float("radius", 1.0f);
  if (!(radius > 0.0f)) fail(call.set.where(), call.set.shown() + " needs a radius above 0");
  return radius;
}

Geometry make_sphere(const ShapeCall& call, bool exact) {
  const glm::dvec3 center = call.set.get_vector("center", glm::dvec3(0.0));
  const glm::dmat4 m = call.to_world * placed(center, double(get_radius(call)));
  if (!exact || !is_similarity(glm::dmat3(m), 3)) return to_world(call, sphere_mesh(), m);
  const Sphere sphere{glm::vec3(m[3]), float(glm::length(glm::dvec3(m[0]))), call.flip};
  const bool has_size = std::isfinite(sphere.radius) && sphere.radius > 0.0f;
  if (!has_size || !is_finite(sphere.center)) fail_range(call);
  return sphere;
}

Geometry make_disk(const ShapeCall& call, bool exact) {
  const glm::dmat3 m(call.to_world);
  if (!exact || !is_similarity(m, 2)) return to_world(call, disk_mesh(), call.to_world);
  const glm::dvec3 normal = glm::normalize(glm::cross(m[0], m[1]));
  // Normals move by the inverse transpose: a mirroring transform keeps their side.
  const double side = (glm::determinant(m) < 0.0) != call.flip ? -1.0 : 1.0;
  return Disk{glm::vec3(call.to_world[3]), glm::vec3(side * normal), float(glm::length(m[0]))};
}

Geometry make_cylinder(const ShapeCall& call) {
  const glm::dvec3 p0 = call.set.get_vector("p0", glm::dvec3(0.0));
  const glm::dvec3 p1 = call.set.get_vector("p1", glm::dvec3(0.0, 0.0, 1.0));
  const float radius = get_radius(call);
  if (glm::vec3(p0) == glm::vec3(p1)) fail(call.set.where(), "a cylinder needs two distinct ends");
  return to_world(call, cylinder_mesh(glm::vec3(p0), glm::vec3(p1), radius), call.to_world);
}

std::optional<Geometry> make_geometry(const ShapeCall& call, bool plain_material) {
  const std::string& type = call.set.type();
  if (type == "sphere") return make_sphere(call, plain_material);
  if (type == "disk") return make_disk(call, plain_material);
  if (type == "cylinder") return make_cylinder(call);
  if (type == "rectangle") return to_world(call, rectangle_mesh(), call.to_world);
  if (type == "cube") return to_world(call, cube_mesh(), call.to_world);
  if (is_mesh_file(type)) {
    return to_world(call, read_mesh_file(call.state, call.set), call.to_world);
  }
  return std::nullopt;
}

bool is_known(const std::string& type) {
  constexpr const char* known[] = {"sphere", "disk", "cylinder", "rectangle", "cube"};
  return is_mesh_file(type) ||
         std::any_of(std::begin(known), std::end(known), [&](const char* k) { return type == k; });
}

void append(State& state, const Properties& set, Target& target, Shape shape) {
  const auto* mesh = std::get_if<TriangleMesh>(&shape.geometry);
  if (mesh != nullptr && mesh->triangles.empty()) {
    state.warnings.add(set.where(), set.shown() + " has no triangles; it is left out");
    return;
  }
  if (target.in_group && shape.emission) {
    state.warnings.add(set.where(), "lights inside groups are not supported; they do not emit");
    shape.emission.reset();
  }
  target.shapes.push_back(std::move(shape));
}

// An obj file without a model for the whole of it: those that its materials' names refer to, or
// that its MTL file states.
bool has_own_materials(const State& state, const Properties& set) {
  if (set.type() != "obj" || state.sources.modern) return false;
  for (const Property* model : set.objects("bsdf")) {
    if (model->name.empty() || plain(model->name) == "bsdf") return false;
  }
  return set.get_bool("load_materials", true);
}

void add_obj_parts(const ShapeCall& call, const std::optional<Emission>& emission, Target& target) {
  State& state = call.state;
  ObjFile file = read_obj_file(state, call.set);
  const std::string path =
      resolve(state.sources, call.set.element(), call.set.get_string("filename", ""));
  const ObjMaterials materials = read_mtl_libraries(path, file.libraries, state.scene);
  for (ObjPart& part : file.parts) {
    const auto own = materials.find(part.material);
    const Property* model = part.material.empty() ? nullptr : call.set.find(part.material);
    std::optional<int> index;
    Shape shape{TriangleMesh{}, 0, emission};
    if (model != nullptr && model->tag == "bsdf") {
      index = material_index(state, model->element);
    } else if (own != materials.end()) {
      Material material = own->second.material;
      material.two_sided = false;
      index = add_material(state, std::move(material));
      if (!shape.emission) shape.emission = own->second.emission;
    } else {
      index = add_material(state, default_material(state, emission.has_value()));
    }
    if (!index) continue;
    shape.material = *index;
    shape.geometry = to_world(call, std::move(part.mesh), call.to_world);
    append(state, call.set, target, std::move(shape));
  }
  if (file.parts.empty()) {
    state.warnings.add(call.set.where(), call.set.shown() + " has no faces; it is left out");
  }
}

void add_to(State& state, const Element& element, Target& target);

void add_instance(State& state, const Properties& set) {
  const std::vector<const Property*> groups = set.objects("shape");
  if (groups.size() != 1) fail(set.where(), set.shown() + " needs one group of shapes to show");
  const Element& group = groups.front()->element;
  if (plain(group.attribute("type")) != "shapegroup") {
    fail(set.where(), set.shown() + " refers to " + group.shown() + "; expected a shapegroup");
  }
  const auto [known, is_new] = state.groups.try_emplace(group.node, -1);
  if (is_new) {
    ObjectDescription object;
    Target target{object.shapes, true};
    for (const Element& child : group.children()) {
      if (child.tag() == "shape") add_to(state, child, target);
    }
    known->second = int(state.scene.objects.size());
    state.scene.objects.push_back(std::move(object));
  }
  const glm::mat4 to_world(set.get_transform("to_world", state.warnings));
  set.warn_unused(state.warnings);
  if (!state.scene.objects[size_t(known->second)].shapes.empty()) {
    state.scene.instances.push_back({known->second, to_world});
  }
}

// Types that hold other shapes; true where it is one.
bool add_composite(State& state, const Element& element, const Properties& set, Target& target) {
  if (set.type() == "shapegroup") return true;  // seen through its instances only
  if (set.type() == "merge") {
    for (const Element& child : element.children()) {
      if (child.tag() == "shape") add_to(state, child, target);
    }
    return true;
  }
  if (set.type() != "instance") return false;
  if (target.in_group) {
    state.warnings.add(set.where(), "instances inside groups are not supported; they are left out");
  } else {
    add_instance(state, set);
  }
  return true;
}

void add_to(State& state, const Element& element, Target& target) {
  const Properties set = state.properties(element);
  if (add_composite(state, element, set, target)) return;
  if (!is_known(set.type())) {
    state.warnings.add(set.where(), "<shape type=\"" + element.attribute("type") +
                                        "\"> is not supported; it is left out");
    return;
  }
  ShapeCall call{state, set, set.get_transform("to_world", state.warnings),
                 set.get_bool("flip_normals", false)};
  set.ignore({"silhouette_sampling_weight"});
  for (const char* tag : {"medium", "subsurface", "sensor"}) {
    if (set.objects(tag).empty()) continue;
    state.warnings.add(set.where(),
                       std::string("<") + tag + "> of shapes is not supported; it is left out");
  }
  const std::optional<Emission> emission = get_emission(state, set);
  if (has_own_materials(state, set)) {
    add_obj_parts(call, emission, target);
    set.warn_unused(state.warnings);
    return;
  }
  const std::optional<int> material = get_material(state, set, emission.has_value());
  if (!material) {
    state.warnings.add(set.where(), "shapes without a visible surface (\"null\") are left out");
    return;
  }
  const bool plain_material =
      !is_textured(state.scene, *material) && (!emission || emission->radiance.texture < 0);
  std::optional<Geometry> geometry = make_geometry(call, plain_material);
  set.warn_unused(state.warnings);
  if (geometry) append(state, set, target, Shape{std::move(*geometry), *material, emission});
}

// The shape, or those inside it, whose mesh files need nothing but their own parameters. What is
// wrong with a shape is left for add_shape() to tell.
void collect_mesh_files(const State& state, const Element& element, std::vector<Element>& found) {
  const std::string type = plain(element.attribute("type"));
  if (type == "shapegroup" || type == "merge") {
    for (const Element& child : element.children()) {
      if (child.tag() == "shape") collect_mesh_files(state, child, found);
    }
  } else if (is_mesh_file(type)) {
    try {
      if (!has_own_materials(state, state.properties(element))) found.push_back(element);
    } catch (const Error&) {
    }
  }
}

}  // namespace

void read_shapes_ahead(State& state, const std::vector<Element>& elements) {
  std::vector<Element> found;
  for (const Element& element : elements) {
    if (element.tag() == "shape") collect_mesh_files(state, element, found);
  }
  read_meshes_ahead(state, found);
}

void add_shape(State& state, const Element& element) {
  Target target{state.scene.shapes};
  add_to(state, element, target);
}

}  // namespace lockstep::mitsuba
