// The parameters and nested objects of one Mitsuba object.
#pragma once

#include "core/mitsuba/document.h"

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lockstep::mitsuba {

// A tag inside an object; of a <ref> the object that it refers to, under the ref's name.
struct Property {
  std::string name;  // as the file has it; may be empty
  std::string tag;   // plain
  Element element;
  mutable bool used = false;
};

// Getters take names in any of the spellings and mark what they find as used; `warn_unused` then
// tells the user what the renderer did not look at.
class Properties {
 public:
  Properties(const Sources& sources, const Element& element);

  const Element& element() const { return element_; }
  const std::string& type() const { return type_; }  // plain
  Location where() const { return element_.where(); }
  std::string shown() const { return element_.shown(); }

  // The property `name`, whatever its tag.
  const Property* find(std::string_view name) const;
  bool has(std::string_view name) const;

  // Values; the second argument where absent. Throw where the tag or the text does not fit.
  float get_float(std::string_view name, float fallback) const;
  int get_int(std::string_view name, int fallback) const;
  bool get_bool(std::string_view name, bool fallback) const;
  std::string get_string(std::string_view name, const std::string& fallback) const;
  glm::dvec3 get_vector(std::string_view name, glm::dvec3 fallback) const;
  glm::dmat4 get_transform(std::string_view name, Warnings& warnings) const;

  // Nested objects of a kind, such as "bsdf", in the order of the file.
  std::vector<const Property*> objects(std::string_view tag) const;

  void ignore(std::initializer_list<std::string_view> names) const;
  void warn_unused(Warnings& warnings) const;

 private:
  const Property* find_value(std::string_view name, std::initializer_list<const char*> tags) const;

  Element element_;
  std::string type_;
  std::vector<Property> properties_;
};

}  // namespace lockstep::mitsuba
