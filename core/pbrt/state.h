// What the reader remembers between directives.
#pragma once

#include "core/pbrt/library.h"
#include "core/pbrt/parameters.h"
#include "core/pbrt/shapes.h"
#include "core/pbrt/view.h"
#include "core/scene_description.h"

#include <glm/mat4x4.hpp>

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace lockstep::pbrt {

// The current material: an index of Library::materials, or a name.
struct MaterialReference {
  int declared = 0;
  std::string name;
  int order = 0;
  Location where;
};

// What a shape's material is made of, once the file has been read. While reading, Shape::material
// is an index of State::surfaces.
struct Surface {
  MaterialReference material;
  std::string medium;  // inside; empty: none
  float alpha = 1.0f;
  std::string alpha_texture;  // instead of alpha; empty: none
  int order = 0;
  Location where;
};

// Area lights share their image.
struct AreaLight {
  Emission emission;
  float power = 0.0f;  // above 0: what each shape emits in all
  std::optional<ImageTexture> image;
  int texture = -1;  // in the scene, once a shape uses it
};

// Saved by AttributeBegin and brought back by AttributeEnd.
struct Attributes {
  glm::dmat4 ctm{1.0};
  bool reverse_orientation = false;
  MaterialReference material;
  std::string inside;                     // the medium
  std::shared_ptr<AreaLight> area_light;  // null: shapes do not emit
  bool at_shutter_open = true;  // false: ActiveTransform EndTime, whose transforms are ignored
  std::map<std::string, std::vector<Parameter>> defaults;  // of the v4 directive Attribute
};

struct Scope {
  std::string begin;  // the directive that opened it
  Location where;
  Attributes saved;
};

struct ObjectDeclaration {
  std::vector<Shape> shapes;
  int scene_index = -1;  // once it is placed
};

// The shape whose geometry is to come from a file: shapes[index].
struct ShapeReference {
  std::vector<Shape>* shapes = nullptr;
  size_t index = 0;
  float power = 0.0f;  // see AreaLight
};

struct InstanceReference {
  std::string name;
  int order = 0;
  Location where;
  glm::mat4 to_world{1.0f};
};

struct State {
  SceneDescription scene;
  Library library;

  Attributes attributes;
  std::vector<Scope> scopes;
  std::vector<Surface> surfaces;
  std::vector<MaterialReference> unknown_materials;  // when they were named
  NameTable<ObjectDeclaration> objects;
  ObjectDeclaration* open_object = nullptr;
  std::vector<InstanceReference> instances;
  std::vector<MeshFile> mesh_files;
  std::vector<ShapeReference> file_shapes;  // one per mesh file
  std::map<std::string, glm::dmat4> coordinate_systems;

  ScreenWindow window;
  std::string film_type;
  std::optional<ParameterSet> film;
  std::pair<std::string, std::optional<ParameterSet>> filter;

  bool v2_directive = false;  // one that only v2 has was met
  bool in_world = false;
  bool world_ended = false;
  int include_depth = 0, files_read = 0;
  std::vector<Shape>* curves = nullptr;  // whose last shape more curves may join
  double triangles_left = 1 << 26;       // that subdivision and curves may make
};

}  // namespace lockstep::pbrt
