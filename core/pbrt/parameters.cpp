#include "core/pbrt/parameters.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace lockstep::pbrt {

namespace {

enum class Values { Numbers, Strings, Bools, NumbersOrStrings };

struct Type {
  std::string_view name;
  Values values;
  size_t group;  // a list's length is a multiple of this
};

constexpr Type types[] = {
    {"float", Values::Numbers, 1},     {"integer", Values::Numbers, 1},
    {"bool", Values::Bools, 1},        {"string", Values::Strings, 1},
    {"texture", Values::Strings, 1},   {"spectrum", Values::NumbersOrStrings, 1},
    {"blackbody", Values::Numbers, 1}, {"rgb", Values::Numbers, 3},
    {"color", Values::Numbers, 3},     {"xyz", Values::Numbers, 3},
    {"point", Values::Numbers, 3},     {"point2", Values::Numbers, 2},
    {"point3", Values::Numbers, 3},    {"vector", Values::Numbers, 3},
    {"vector2", Values::Numbers, 2},   {"vector3", Values::Numbers, 3},
    {"normal", Values::Numbers, 3},    {"normal3", Values::Numbers, 3},
};

const Type* type_named(std::string_view name) {
  const auto* found = std::find_if(std::begin(types), std::end(types),
                                   [&](const Type& t) { return t.name == name; });
  return found == std::end(types) ? nullptr : found;
}

std::string declaration(const Parameter& p) { return "\"" + p.type + " " + p.name + "\""; }

// Splits "float fov" at its blanks.
std::pair<std::string, std::string> split_declaration(const Lexer& lexer, const Token& token) {
  constexpr std::string_view blanks = " \t";
  const std::string_view text = token.text;
  const size_t type_begin = std::min(text.find_first_not_of(blanks), text.size());
  const size_t type_end = std::min(text.find_first_of(blanks, type_begin), text.size());
  const size_t name_begin = std::min(text.find_first_not_of(blanks, type_end), text.size());
  const size_t name_end = std::min(text.find_first_of(blanks, name_begin), text.size());
  const bool rest_is_blank = text.find_first_not_of(blanks, name_end) == std::string_view::npos;
  if (name_begin == name_end || !rest_is_blank) {
    fail(lexer.at(token), "expected a parameter such as \"float radius\", found " + shown(token));
  }
  return {std::string(text.substr(type_begin, type_end - type_begin)),
          std::string(text.substr(name_begin, name_end - name_begin))};
}

bool is_truth(const Token& token) {
  const bool named = token.kind == Token::Kind::Word || token.kind == Token::Kind::String;
  return named && (token.text == "true" || token.text == "false");
}

bool is_value(const Token& token) {
  return token.kind == Token::Kind::Number || token.kind == Token::Kind::String || is_truth(token);
}

void add_value(const Lexer& lexer, const Type& type, const Token& token, Parameter& p) {
  const bool numbers = type.values == Values::Numbers || type.values == Values::NumbersOrStrings;
  const bool strings = type.values == Values::Strings || type.values == Values::NumbersOrStrings;
  if (numbers && token.kind == Token::Kind::Number) {
    p.numbers.push_back(lexer.number(token));
  } else if ((strings && token.kind == Token::Kind::String) ||
             (type.values == Values::Bools && is_truth(token))) {
    p.strings.push_back(unescaped(token.text));
  } else {
    fail(lexer.at(token), declaration(p) + " cannot have the value " + shown(token));
  }
}

void read_values(Lexer& lexer, const Type& type, Parameter& p) {
  if (lexer.peek().kind != Token::Kind::Open) {
    // A single value may stand without brackets.
    if (!is_value(lexer.peek())) {
      fail({lexer.file(), p.line}, "expected a value list after " + declaration(p));
    }
    add_value(lexer, type, lexer.next(), p);
    return;
  }
  lexer.next();
  while (lexer.peek().kind != Token::Kind::Close) {
    if (!is_value(lexer.peek())) {
      fail(lexer.at(lexer.peek()),
           "expected a value or ] for " + declaration(p) + ", found " + shown(lexer.peek()));
    }
    add_value(lexer, type, lexer.next(), p);
  }
  lexer.next();
}

Parameter read_parameter(Lexer& lexer) {
  const Token head = lexer.next();
  Parameter p;
  p.line = head.line;
  std::tie(p.type, p.name) = split_declaration(lexer, head);
  const Type* type = type_named(p.type);
  if (type == nullptr) {
    fail(lexer.at(head), "unknown parameter type in " + shown(head));
  }
  read_values(lexer, *type, p);
  if (p.numbers.empty() == p.strings.empty()) {
    fail(lexer.at(head), p.numbers.empty() ? declaration(p) + " has no value"
                                           : declaration(p) + " mixes numbers and strings");
  }
  if (p.numbers.size() % type->group != 0) {
    fail(lexer.at(head), declaration(p) + " has " + std::to_string(p.numbers.size()) +
                             " values; expected a multiple of " + std::to_string(type->group));
  }
  return p;
}

std::vector<glm::vec3> as_vec3(const Parameter* p) {
  std::vector<glm::vec3> list;
  if (p == nullptr) return list;
  list.reserve(p->numbers.size() / 3);
  for (size_t i = 0; i + 2 < p->numbers.size(); i += 3) {
    list.emplace_back(p->numbers[i], p->numbers[i + 1], p->numbers[i + 2]);
  }
  return list;
}

int as_int(const ParameterSet& set, const Parameter& p, double value) {
  if (value != std::floor(value) || std::abs(value) > 2147483647.0) {
    fail(set.where(p), declaration(p) + " must hold whole numbers of 32 bits");
  }
  return static_cast<int>(value);
}

}  // namespace

ParameterSet::ParameterSet(Lexer& lexer, std::string owner, const Location& where)
    : owner_(std::move(owner)), where_(where) {
  constexpr size_t most = 1000;  // comparing each with all takes the square of that
  while (lexer.peek().kind == Token::Kind::String) {
    if (parameters_.size() == most) {
      fail(lexer.at(lexer.peek()), owner_ + " has more than " + std::to_string(most) +
                                       " parameters; remove those that are not used");
    }
    parameters_.push_back(read_parameter(lexer));
    const Parameter& added = parameters_.back();
    for (size_t i = 0; i + 1 < parameters_.size(); ++i) {
      if (parameters_[i].name == added.name && parameters_[i].type == added.type) {
        fail(this->where(added), declaration(added) + " is given twice");
      }
    }
  }
}

const Parameter* ParameterSet::any(std::string_view name) const {
  const auto found = std::find_if(parameters_.begin(), parameters_.end(),
                                  [&](const Parameter& p) { return p.name == name; });
  return found == parameters_.end() ? nullptr : &*found;
}

const Parameter* ParameterSet::find(std::string_view name,
                                    std::initializer_list<std::string_view> wanted) const {
  for (const Parameter& p : parameters_) {
    if (p.name == name && std::find(wanted.begin(), wanted.end(), p.type) != wanted.end()) {
      p.used = true;
      return &p;
    }
  }
  return nullptr;
}

const Parameter* ParameterSet::find_single(std::string_view name,
                                           std::initializer_list<std::string_view> wanted) const {
  const Parameter* p = find(name, wanted);
  if (p != nullptr && p->numbers.size() + p->strings.size() != 1) {
    fail(where(*p), declaration(*p) + " must have one value");
  }
  return p;
}

float ParameterSet::get_float(std::string_view name, float fallback) const {
  const Parameter* p = find_single(name, {"float", "integer"});
  return p != nullptr ? static_cast<float>(p->numbers[0]) : fallback;
}

int ParameterSet::get_int(std::string_view name, int fallback) const {
  const Parameter* p = find_single(name, {"integer", "float"});
  return p != nullptr ? as_int(*this, *p, p->numbers[0]) : fallback;
}

bool ParameterSet::get_bool(std::string_view name, bool fallback) const {
  const Parameter* p = find_single(name, {"bool"});
  return p != nullptr ? p->strings[0] == "true" : fallback;
}

std::string ParameterSet::get_string(std::string_view name, const std::string& fallback) const {
  const Parameter* p = find_single(name, {"string"});
  return p != nullptr ? p->strings[0] : fallback;
}

std::vector<glm::vec3> ParameterSet::get_points(std::string_view name) const {
  return as_vec3(find(name, {"point", "point3"}));
}

glm::vec3 ParameterSet::get_point(std::string_view name, glm::vec3 fallback) const {
  const Parameter* p = find(name, {"point", "point3"});
  if (p == nullptr) return fallback;
  if (p->numbers.size() != 3) fail(where(*p), declaration(*p) + " must have three values");
  return as_vec3(p)[0];
}

std::vector<glm::vec3> ParameterSet::get_normals(std::string_view name) const {
  return as_vec3(find(name, {"normal", "normal3"}));
}

std::vector<glm::vec2> ParameterSet::get_uvs() const {
  const Parameter* p = nullptr;
  for (const char* name : {"uv", "st", "texcoords"}) {
    if (p == nullptr) p = find(name, {"point2", "float"});
  }
  std::vector<glm::vec2> list;
  for (size_t i = 0; p != nullptr && i + 1 < p->numbers.size(); i += 2) {
    list.emplace_back(p->numbers[i], p->numbers[i + 1]);
  }
  return list;
}

std::vector<int> ParameterSet::get_ints(std::string_view name) const {
  const Parameter* p = find(name, {"integer"});
  std::vector<int> list;
  if (p == nullptr) return list;
  list.reserve(p->numbers.size());
  for (const double value : p->numbers) list.push_back(as_int(*this, *p, value));
  return list;
}

void ParameterSet::add_defaults(const std::vector<Parameter>& defaults) {
  for (const Parameter& p : defaults) {
    if (any(p.name) == nullptr) parameters_.push_back(p);
  }
}

void ParameterSet::ignore(std::initializer_list<std::string_view> names) const {
  for (const std::string_view name : names) {
    for (const Parameter& p : parameters_) p.used = p.used || p.name == name;
  }
}

void ParameterSet::warn_unused(Warnings& warnings) const {
  for (const Parameter& p : parameters_) {
    if (p.used) continue;
    warnings.add(where(p),
                 owner_ + ": the parameter " + declaration(p) + " is not supported; it is ignored");
  }
}

}  // namespace lockstep::pbrt
