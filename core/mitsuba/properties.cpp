#include "core/mitsuba/properties.h"

#include "core/mitsuba/transforms.h"
#include "core/mitsuba/values.h"

#include <algorithm>
#include <cmath>

namespace lockstep::mitsuba {
namespace {

// Names of Mitsuba 0.3 and before.
std::string current_tag(const std::string& tag) {
  if (tag == "luminaire") return "emitter";
  return tag == "camera" ? "sensor" : tag;
}

Property make_property(const Sources& sources, const Element& element) {
  Property property{element.attribute("name"), current_tag(element.tag()), element};
  // An alias may refer to a reference: a few steps at most.
  for (int steps = 0; property.tag == "ref"; ++steps) {
    const std::string id = property.element.attribute("id");
    const auto target = sources.by_id.find(id);
    if (target == sources.by_id.end() || steps > 8) {
      fail(element.where(), "there is no object with the id \"" + id + "\"");
    }
    property.element = target->second;
    property.tag = current_tag(property.element.tag());
  }
  return property;
}

}  // namespace

Properties::Properties(const Sources& sources, const Element& element)
    : element_(element), type_(plain(element.attribute("type"))) {
  for (const Element& child : element.children()) {
    properties_.push_back(make_property(sources, child));
  }
}

const Property* Properties::find(std::string_view name) const {
  const std::string wanted = plain(name);
  const auto found = std::find_if(properties_.begin(), properties_.end(),
                                  [&](const Property& p) { return plain(p.name) == wanted; });
  if (found == properties_.end()) return nullptr;
  found->used = true;
  return &*found;
}

bool Properties::has(std::string_view name) const {
  const std::string wanted = plain(name);
  return std::any_of(properties_.begin(), properties_.end(),
                     [&](const Property& p) { return plain(p.name) == wanted; });
}

const Property* Properties::find_value(std::string_view name,
                                       std::initializer_list<const char*> tags) const {
  const Property* p = find(name);
  if (p == nullptr) return nullptr;
  for (const char* tag : tags) {
    if (p->tag == tag) return p;
  }
  fail(p->element.where(), p->element.shown() + ": expected <" + *tags.begin() + ">");
}

float Properties::get_float(std::string_view name, float fallback) const {
  const Property* p = find_value(name, {"float", "integer", "spectrum"});
  return p != nullptr ? float(number(p->element, "value")) : fallback;
}

int Properties::get_int(std::string_view name, int fallback) const {
  const Property* p = find_value(name, {"integer", "float"});
  if (p == nullptr) return fallback;
  const double value = number(p->element, "value");
  if (value != std::floor(value) || std::abs(value) > 2147483647.0) {
    fail(p->element.where(), p->element.shown() + ": expected an integer of 32 bits");
  }
  return int(value);
}

bool Properties::get_bool(std::string_view name, bool fallback) const {
  const Property* p = find_value(name, {"boolean"});
  if (p == nullptr) return fallback;
  const std::string value = plain(p->element.attribute("value"));
  if (value != "true" && value != "false") {
    fail(p->element.where(), p->element.shown() + ": expected true or false");
  }
  return value == "true";
}

std::string Properties::get_string(std::string_view name, const std::string& fallback) const {
  const Property* p = find_value(name, {"string"});
  return p != nullptr ? p->element.attribute("value") : fallback;
}

glm::dvec3 Properties::get_vector(std::string_view name, glm::dvec3 fallback) const {
  const Property* p = find_value(name, {"vector", "point"});
  return p != nullptr ? vector(p->element, 0.0) : fallback;
}

glm::dmat4 Properties::get_transform(std::string_view name, Warnings& warnings) const {
  const Property* p = find_value(name, {"transform", "animation"});
  return p != nullptr ? read_transform(p->element, warnings) : glm::dmat4(1.0);
}

std::vector<const Property*> Properties::objects(std::string_view tag) const {
  std::vector<const Property*> result;
  for (const Property& p : properties_) {
    if (p.tag != tag) continue;
    p.used = true;
    result.push_back(&p);
  }
  return result;
}

void Properties::ignore(std::initializer_list<std::string_view> names) const {
  for (const std::string_view name : names) find(name);
}

void Properties::warn_unused(Warnings& warnings) const {
  for (const Property& p : properties_) {
    if (p.used) continue;
    const std::string what = p.name.empty() ? "<" + p.tag + ">" : "\"" + p.name + "\"";
    warnings.add(p.element.where(), what + " of <" + std::string(element_.node.name()) +
                                        " type=\"" + element_.attribute("type") +
                                        "\"> is not understood; it is left out");
  }
}

}  // namespace lockstep::mitsuba
