// The parameters of a texture or material as inputs: constants, or textures by name.
#pragma once

#include "core/pbrt/library.h"
#include "core/pbrt/parameters.h"

#include <optional>
#include <string>
#include <string_view>

namespace lockstep::pbrt {

class Inputs {
 public:
  // `order` decides what names stand for; see NameTable.
  Inputs(const ParameterSet& set, int order, Library& library)
      : set_(set), order_(order), library_(library) {}

  const ParameterSet& set() const { return set_; }
  Library& library() const { return library_; }
  int order() const { return order_; }

  // Colours; nothing where absent. Constant reflectances are clamped to [0, 1].
  std::optional<ColorInput> find_color(std::string_view name) const;
  ColorInput color(std::string_view name, glm::vec3 fallback) const;
  ColorInput reflectance(std::string_view name, float fallback) const;

  std::optional<FloatInput> find_number(std::string_view name) const;
  FloatInput number(std::string_view name, float fallback) const;
  // A number that must not vary over the surface; a texture gives a warning and the fallback.
  float constant(std::string_view name, float fallback) const;

  void warn(const std::string& what) const;  // "Material "glass": what"

 private:
  const ParameterSet& set_;
  int order_;
  Library& library_;
};

}  // namespace lockstep::pbrt
