// What the reader remembers between directives.
#pragma once

#include "core/pbrt/parameters.h"
#include "core/pbrt/view.h"
#include "core/scene_description.h"

#include <glm/mat4x4.hpp>

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace lockstep::pbrt {

// A material that was declared; it enters the scene when the first shape uses it.
struct DeclaredMaterial {
  std::optional<Material> material;  // nothing: an interface
  int scene_index = -1;
};

// Saved by AttributeBegin and brought back by AttributeEnd. Indices refer to State::materials.
struct Attributes {
  glm::dmat4 ctm{1.0};
  bool reverse_orientation = false;
  int material = 0;
  std::optional<Emission> emission;
  bool at_shutter_open = true;  // false: ActiveTransform EndTime, whose transforms are ignored
  std::map<std::string, std::vector<Parameter>> defaults;  // of the v4 directive Attribute
};

struct Scope {
  std::string begin;  // the directive that opened it
  Location where;
  Attributes saved;
};

struct State {
  SceneDescription scene;
  Warnings warnings;
  std::string main_file;

  Attributes attributes;
  std::vector<Scope> scopes;
  std::vector<DeclaredMaterial> materials;
  std::map<std::string, int> named_materials;
  std::map<std::string, glm::dmat4> coordinate_systems;

  std::string film_type;
  std::optional<ParameterSet> film;
  std::pair<std::string, std::optional<ParameterSet>> filter;

  bool in_world = false;
  bool world_ended = false;
  int include_depth = 0;
};

}  // namespace lockstep::pbrt
