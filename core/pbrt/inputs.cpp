#include "core/pbrt/inputs.h"

#include "core/pbrt/colors.h"
#include "core/pbrt/textures.h"

#include <fmt/format.h>
#include <glm/common.hpp>

namespace lockstep::pbrt {

namespace {

// The name in "texture NAME".
std::optional<std::string> texture_name(const ParameterSet& set, std::string_view name) {
  const Parameter* p = set.find(name, {"texture"});
  if (p == nullptr) return std::nullopt;
  if (p->strings.size() != 1) {
    fail(set.where(*p), "\"texture " + p->name + "\" must have one value");
  }
  return p->strings[0];
}

}  // namespace

std::optional<ColorInput> Inputs::find_color(std::string_view name) const {
  if (const auto texture = texture_name(set_, name)) {
    return color_texture(library_, *texture, order_, set_.where(*set_.any(name)));
  }
  const auto constant = pbrt::find_color(set_, name, ColorUse::Reflectance, library_);
  if (!constant) return std::nullopt;
  return ColorInput(*constant);
}

ColorInput Inputs::color(std::string_view name, glm::vec3 fallback) const {
  return find_color(name).value_or(ColorInput(fallback));
}

ColorInput Inputs::reflectance(std::string_view name, float fallback) const {
  ColorInput given = color(name, glm::vec3(fallback));
  if (given.texture >= 0) return given;
  const glm::vec3 clamped = glm::clamp(given.value, 0.0f, 1.0f);
  if (given.value != clamped) {
    warn(fmt::format("\"{}\" is clamped to the range from 0 to 1", name));
  }
  return clamped;
}

std::optional<FloatInput> Inputs::find_number(std::string_view name) const {
  if (const auto texture = texture_name(set_, name)) {
    return float_texture(library_, *texture, order_, set_.where(*set_.any(name)));
  }
  if (set_.find(name, {"float", "integer"}) == nullptr) return std::nullopt;
  return FloatInput(set_.get_float(name, 0.0f));
}

FloatInput Inputs::number(std::string_view name, float fallback) const {
  return find_number(name).value_or(FloatInput(fallback));
}

float Inputs::constant(std::string_view name, float fallback) const {
  if (set_.find(name, {"texture"}) == nullptr) return set_.get_float(name, fallback);
  warn("a texture for \"" + std::string(name) + "\" is not supported; the default is used");
  return fallback;
}

void Inputs::warn(const std::string& what) const {
  library_.warnings.add(set_.where(), set_.owner() + ": " + what);
}

}  // namespace lockstep::pbrt
