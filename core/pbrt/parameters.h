// The typed, named value lists that follow most directives: "float fov" [39].
#pragma once

#include "core/location.h"
#include "core/pbrt/lexer.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lockstep::pbrt {

struct Parameter {
  std::string type;
  std::string name;
  int line = 0;
  std::vector<double> numbers;       // of numeric types
  std::vector<std::string> strings;  // of string, texture, spectrum names; bool: "true" or "false"
  mutable bool used = false;
};

// The parameters of one directive. Getters mark what they find as used; `warn_unused` then tells
// the user what the renderer did not look at.
class ParameterSet {
 public:
  // Reads parameters up to the next directive. `owner` names the directive in messages, such as
  // Shape "sphere".
  ParameterSet(Lexer& lexer, std::string owner, const Location& where);
  // No parameters.
  explicit ParameterSet(std::string owner) : owner_(std::move(owner)) {}

  const Location& where() const { return where_; }
  const std::string& owner() const { return owner_; }
  Location where(const Parameter& p) const { return {where_.file, p.line}; }

  // The parameter `name` if it has one of the `types`.
  const Parameter* find(std::string_view name, std::initializer_list<std::string_view> types) const;
  // The parameter `name`, whatever its type, not marked as used.
  const Parameter* any(std::string_view name) const;

  float get_float(std::string_view name, float fallback) const;
  int get_int(std::string_view name, int fallback) const;
  bool get_bool(std::string_view name, bool fallback) const;
  std::string get_string(std::string_view name, const std::string& fallback) const;

  // Lists; empty where absent.
  std::vector<glm::vec3> get_points(std::string_view name) const;
  std::vector<glm::vec3> get_normals(std::string_view name) const;
  std::vector<glm::vec2> get_uvs() const;  // "uv", "st" or "texcoords", as point2 or float
  std::vector<int> get_ints(std::string_view name) const;
  // A single point.
  glm::vec3 get_point(std::string_view name, glm::vec3 fallback) const;

  // Adds those of `defaults` whose names are not given.
  void add_defaults(const std::vector<Parameter>& defaults);
  const std::vector<Parameter>& all() const { return parameters_; }

  void ignore(std::initializer_list<std::string_view> names) const;
  void warn_unused(Warnings& warnings) const;

 private:
  const Parameter* find_single(std::string_view name,
                               std::initializer_list<std::string_view> types) const;

  std::string owner_;
  Location where_;
  std::vector<Parameter> parameters_;
};

}  // namespace lockstep::pbrt
