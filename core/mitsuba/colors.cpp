#include "core/mitsuba/colors.h"

#include "core/mitsuba/textures.h"
#include "core/mitsuba/values.h"
#include "core/srgb.h"

#include <glm/common.hpp>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>

namespace lockstep::mitsuba {
namespace {

// "#rrggbb"
glm::vec3 hexadecimal(const Element& e, const std::string& text) {
  unsigned packed = 0;
  const char* end = text.data() + text.size();
  const auto [rest, status] = std::from_chars(text.data() + 1, end, packed, 16);
  if (text.size() != 7 || status != std::errc() || rest != end) {
    fail(e.where(), e.shown() + ": expected #rrggbb");
  }
  const auto channel = [&](int shift) {
    return linear_from_srgb(float(packed >> shift & 0xffu) / 255.0f);
  };
  return {channel(16), channel(8), channel(0)};
}

glm::vec3 rgb_color(const Element& e, bool encoded) {
  const std::string text = e.attribute("value");
  const std::vector<std::string> words = words_of(text);
  if (words.size() == 1 && words[0].front() == '#') return hexadecimal(e, words[0]);
  const std::vector<double> v = numbers_of(e, text);
  if (v.size() != 1 && v.size() != 3) fail(e.where(), e.shown() + " needs one or three numbers");
  const glm::vec3 c = v.size() == 1 ? glm::vec3(float(v[0])) : glm::vec3(v[0], v[1], v[2]);
  if (!encoded) return c;
  return {linear_from_srgb(c.x), linear_from_srgb(c.y), linear_from_srgb(c.z)};
}

glm::vec3 from_pairs(const Element& e, const std::vector<glm::dvec2>& samples, ColorUse use) {
  for (std::size_t i = 1; i < samples.size(); ++i) {
    if (samples[i].x <= samples[i - 1].x) {
      fail(e.where(), e.shown() + ": the wavelengths do not increase");
    }
  }
  const auto zero_beyond = [&](double w) {
    const bool inside = samples.size() > 1 && w >= samples.front().x && w <= samples.back().x;
    return inside ? interpolate(samples, w) : 0.0;
  };
  return spectrum_to_rgb(zero_beyond, use);
}

// One value, or "wavelength:value" many times.
glm::vec3 spectrum_values(const Element& e, ColorUse use) {
  const std::string text = e.attribute("value");
  if (text.find(':') == text.npos) {
    const std::vector<double> v = numbers_of(e, text);
    if (v.size() != 1) {
      fail(e.where(), e.shown() + " needs one number or pairs of wavelength:value");
    }
    return glm::vec3(float(v[0]));
  }
  std::vector<glm::dvec2> samples;
  for (const std::string& word : words_of(text)) {
    const std::size_t colon = std::min(word.find(':'), word.size());
    const std::vector<double> wavelength = numbers_of(e, word.substr(0, colon));
    const std::vector<double> value = numbers_of(e, word.substr(std::min(colon + 1, word.size())));
    if (wavelength.size() != 1 || value.size() != 1) {
      fail(e.where(), e.shown() + ": expected pairs of wavelength:value");
    }
    samples.emplace_back(wavelength[0], value[0]);
  }
  return from_pairs(e, samples, use);
}

// Lines of "wavelength value"; '#' starts a comment.
glm::vec3 spectrum_file(State& state, const Element& e, ColorUse use) {
  if (!e.has("filename")) fail(e.where(), e.shown() + " needs a value, a type or a filename");
  const std::string path = resolve(state.sources, e, e.attribute("filename"));
  std::error_code ignored;
  std::ifstream file(path);
  if (!std::filesystem::is_regular_file(path, ignored) || !file) {
    fail(e.where(), path + ": cannot be opened; check the path");
  }
  std::vector<glm::dvec2> samples;
  for (std::string line; std::getline(file, line);) {
    const std::vector<double> v = numbers_of(e, line.substr(0, line.find('#')));
    if (v.size() >= 2) samples.emplace_back(v[0], v[1]);
  }
  return from_pairs(e, samples, use);
}

glm::vec3 black_body(const Element& e, double kelvin, double scale) {
  if (!(kelvin > 0.0 && kelvin <= 1e6)) {
    fail(e.where(), e.shown() + " needs a temperature between 0 and a million K");
  }
  const auto radiance = [&](double w) { return black_body_radiance(w, kelvin); };
  return float(scale) * spectrum_to_rgb(radiance, ColorUse::Light);
}

// <blackbody temperature="5000K" scale="1"/>
glm::vec3 black_body_tag(const Element& e) {
  std::string text = e.attribute("temperature");
  if (!text.empty() && (text.back() == 'K' || text.back() == 'k')) text.pop_back();
  const std::vector<double> kelvin = numbers_of(e, text);
  if (kelvin.size() != 1) fail(e.where(), "<blackbody> needs a temperature");
  return black_body(e, kelvin[0], number(e, "scale", 1.0));
}

// Mitsuba 3: <spectrum type="..."> with parameters of its own.
glm::vec3 spectrum_object(State& state, const Element& e, ColorUse use) {
  const Nesting nesting(state, e);
  const Properties set = state.properties(e);
  const std::string& type = set.type();
  glm::vec3 color(0.5f);
  if (type == "uniform") {
    color = glm::vec3(set.get_float("value", 1.0f));
  } else if (type == "d65") {
    color = glm::vec3(set.get_float("scale", 1.0f));
    if (const Property* p = set.find("color")) color *= read_color(state, p->element, use);
  } else if (type == "srgb") {
    if (const Property* p = set.find("color")) color = read_color(state, p->element, use);
  } else if (type == "blackbody") {
    color = black_body(e, double(set.get_float("temperature", 0.0f)),
                       double(set.get_float("scale", 1.0f)));
  } else if (type == "irregular") {
    const std::vector<double> w = numbers_of(e, set.get_string("wavelengths", ""));
    const std::vector<double> v = numbers_of(e, set.get_string("values", ""));
    if (w.size() != v.size() || w.size() < 2) {
      fail(e.where(), e.shown() + " needs as many wavelengths as values, at least two");
    }
    std::vector<glm::dvec2> samples;
    for (std::size_t i = 0; i < w.size(); ++i) samples.emplace_back(w[i], v[i]);
    color = from_pairs(e, samples, use);
  } else {
    state.warnings.add(e.where(), "<spectrum type=\"" + e.attribute("type") +
                                      "\"> is not supported; a grey of 0.5 is used");
    return color;
  }
  set.warn_unused(state.warnings);
  return color;
}

const Property* find_color(const Properties& set, std::string_view name) {
  const Property* p = set.find(name);
  if (p == nullptr) return nullptr;
  for (const char* tag :
       {"rgb", "srgb", "color", "spectrum", "blackbody", "float", "integer", "texture"}) {
    if (p->tag == tag) return p;
  }
  fail(p->element.where(), p->element.shown() + ": expected a colour or a texture");
}

}  // namespace

glm::vec3 read_color(State& state, const Element& e, ColorUse use) {
  const std::string tag = e.tag();
  if (tag == "srgb") return rgb_color(e, true);
  if (tag == "rgb" || tag == "color") return rgb_color(e, false);
  if (tag == "blackbody") return black_body_tag(e);
  if (tag == "float" || tag == "integer") return glm::vec3(float(number(e, "value")));
  if (tag != "spectrum") fail(e.where(), e.shown() + ": expected a colour");
  if (e.has("type")) return spectrum_object(state, e, use);
  if (e.has("value")) return spectrum_values(e, use);
  return spectrum_file(state, e, use);
}

ColorInput get_color(State& state, const Properties& set, std::string_view name, glm::vec3 fallback,
                     ColorUse use) {
  const Property* p = find_color(set, name);
  if (p == nullptr) return fallback;
  if (p->tag != "texture") return read_color(state, p->element, use);
  const TextureInput texture = read_texture(state, p->element);
  if (texture.channel >= 0) {
    state.warnings.add(p->element.where(),
                       "single channels are supported as numbers only; all colours are used");
  }
  return texture.color;
}

ColorInput get_reflectance(State& state, const Properties& set, std::string_view name,
                           float fallback) {
  ColorInput input = get_color(state, set, name, glm::vec3(fallback), ColorUse::Reflectance);
  const glm::vec3 clamped = glm::clamp(input.value, 0.0f, 1.0f);
  if (clamped != input.value) {
    state.warnings.add(set.where(), set.shown() + ": \"" + std::string(name) +
                                        "\" is clamped to the range from 0 to 1");
    input.value = clamped;
  }
  return input;
}

glm::vec3 get_light(State& state, const Properties& set, std::string_view name) {
  ColorInput input = get_color(state, set, name, glm::vec3(1.0f), ColorUse::Light);
  if (input.texture >= 0) {
    state.warnings.add(set.where(), set.shown() +
                                        ": textures are not supported here; half of "
                                        "what scales it is used");
    input.value *= 0.5f;
  }
  if (std::min({input.value.x, input.value.y, input.value.z}) < 0.0f) {
    fail(set.where(), set.shown() + " has a negative \"" + std::string(name) + "\"");
  }
  return input.value;
}

FloatInput get_number(State& state, const Properties& set, std::string_view name, float fallback) {
  const Property* p = find_color(set, name);
  if (p == nullptr) return fallback;
  FloatInput input;
  glm::vec3 value;
  if (p->tag == "texture") {
    const TextureInput texture = read_texture(state, p->element);
    input.texture = texture.color.texture;
    input.channel = texture.channel;
    value = texture.color.value;
  } else {
    value = read_color(state, p->element, ColorUse::Reflectance);
  }
  input.value = (value.x + value.y + value.z) / 3.0f;
  return input;
}

}  // namespace lockstep::mitsuba
