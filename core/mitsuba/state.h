// What the reader of a Mitsuba scene remembers while it goes through the objects.
#pragma once

#include "core/mitsuba/document.h"
#include "core/mitsuba/properties.h"
#include "core/scene_description.h"

#include <exception>
#include <map>
#include <optional>
#include <utility>
#include <variant>

namespace lockstep::mitsuba {

// A texture as an input of a material: `color` times the texture, or one channel of it.
struct TextureInput {
  ColorInput color;
  int channel = -1;
};

struct State {
  Sources sources;
  Warnings warnings;
  SceneDescription scene;

  // By tag; materials also by whether "twosided" is around them. No index: nothing to see.
  std::map<pugi::xml_node, TextureInput> textures;
  std::map<std::pair<pugi::xml_node, bool>, std::optional<int>> materials;
  std::map<pugi::xml_node, int> groups;  // of shapes: index of SceneDescription::objects
  // By tag: mesh files that were read ahead and not yet asked for, or why they could not be read.
  std::map<pugi::xml_node, std::variant<TriangleMesh, std::exception_ptr>> meshes_ahead;
  int nesting = 0;

  Properties properties(const Element& element) const { return {sources, element}; }
};

// Counts how deeply objects are nested in one another while it lives; throws where references make
// a circle, or all but one.
class Nesting {
 public:
  Nesting(State& state, const Element& element) : state_(state) {
    constexpr int deepest = 64;
    if (state_.nesting >= deepest) {
      fail(element.where(), element.shown() + " is nested too deeply or refers to itself");
    }
    ++state_.nesting;
  }
  Nesting(const Nesting&) = delete;
  Nesting& operator=(const Nesting&) = delete;
  ~Nesting() { --state_.nesting; }

 private:
  State& state_;
};

}  // namespace lockstep::mitsuba
