#include "core/mitsuba/textures.h"

#include "core/mitsuba/colors.h"
#include "core/mitsuba/transforms.h"

#include <glm/common.hpp>

namespace lockstep::mitsuba {
namespace {

int add_texture(State& state, Texture texture) {
  state.scene.textures.push_back(std::move(texture));
  return int(state.scene.textures.size()) - 1;
}

// Mitsuba 2 and 3 have a matrix, 0.x scales and offsets.
UvTransform uv_transform(State& state, const Properties& set) {
  UvTransform uv = to_uv_transform(set.get_transform("to_uv", state.warnings));
  const float both = set.get_float("uvscale", 1.0f);
  const glm::vec2 scale(set.get_float("uscale", both), set.get_float("vscale", both));
  const glm::vec2 offset(set.get_float("uoffset", 0.0f), set.get_float("voffset", 0.0f));
  uv.u_row *= scale.x;
  uv.v_row *= scale.y;
  uv.offset = scale * uv.offset + offset;
  return uv;
}

TextureWrap wrap_mode(State& state, const Properties& set, std::string_view name,
                      TextureWrap fallback) {
  const std::string mode = plain(set.get_string(name, ""));
  if (mode.empty()) return fallback;
  if (mode == "repeat") return TextureWrap::Repeat;
  if (mode == "mirror") return TextureWrap::Mirror;
  if (mode == "clamp") return TextureWrap::Clamp;
  if (mode == "zero") return TextureWrap::Black;
  state.warnings.add(set.where(), "the wrap mode \"" + mode + "\" is not supported; clamp is used");
  return TextureWrap::Clamp;
}

TextureFilter filter_type(State& state, const Properties& set) {
  const std::string type = plain(set.get_string("filter_type", ""));
  if (type == "nearest") return TextureFilter::Nearest;
  if (type == "bilinear") return TextureFilter::Bilinear;
  if (type == "trilinear" || type == "ewa") return TextureFilter::Trilinear;
  if (!type.empty()) {
    state.warnings.add(set.where(), "the filter type \"" + type + "\" is not known");
  }
  return state.sources.modern ? TextureFilter::Bilinear : TextureFilter::Trilinear;
}

void set_encoding(const Properties& set, ImageTexture& image) {
  // 0: by the file; -1: sRGB's curve.
  const float gamma = set.get_float("gamma", 0.0f);
  if (set.get_bool("raw", false) || gamma == 1.0f) {
    image.encoding = TextureEncoding::Linear;
  } else if (gamma == -1.0f) {
    image.encoding = TextureEncoding::Srgb;
  } else if (gamma > 0.0f) {
    image.encoding = TextureEncoding::Gamma;
    image.gamma = gamma;
  }
}

int channel_number(const Properties& set) {
  const std::string channel = plain(set.get_string("channel", ""));
  if (channel.empty()) return -1;
  for (const char* names : {"rgba", "xyzw"}) {
    const std::string_view known(names);
    if (channel.size() == 1 && known.find(channel[0]) != known.npos) {
      return int(known.find(channel[0]));
    }
  }
  fail(set.where(), set.shown() + " has the channel \"" + channel + "\"; expected r, g, b or a");
}

TextureInput bitmap(State& state, const Properties& set) {
  const std::string name = set.get_string("filename", "");
  if (name.empty()) fail(set.where(), set.shown() + " needs a filename");
  ImageTexture image;
  image.file = resolve(state.sources, set.element(), name);
  image.where = set.where().file + ":" + std::to_string(set.where().line);
  const TextureWrap both = wrap_mode(state, set, "wrap_mode", TextureWrap::Repeat);
  image.wrap_u = wrap_mode(state, set, "wrap_mode_u", both);
  image.wrap_v = wrap_mode(state, set, "wrap_mode_v", both);
  image.filter = filter_type(state, set);
  image.uv = uv_transform(state, set);
  set_encoding(set, image);
  set.ignore({"cache", "max_anisotropy", "format", "accel"});
  const int channel = channel_number(set);
  return {{glm::vec3(1.0f), add_texture(state, std::move(image))}, channel};
}

// Mitsuba's squares have side 1/2.
TextureInput checkerboard(State& state, const Properties& set) {
  CheckerboardTexture board;
  board.even = get_color(state, set, "color0", glm::vec3(0.4f), ColorUse::Reflectance);
  board.odd = get_color(state, set, "color1", glm::vec3(0.2f), ColorUse::Reflectance);
  board.uv = uv_transform(state, set);
  board.uv.u_row *= 2.0f;
  board.uv.v_row *= 2.0f;
  board.uv.offset *= 2.0f;
  return {{glm::vec3(1.0f), add_texture(state, board)}};
}

// A nested texture times a number or colour.
TextureInput scale(State& state, const Properties& set) {
  TextureInput result{ColorInput(glm::vec3(0.5f))};
  const std::vector<const Property*> nested = set.objects("texture");
  if (!nested.empty()) {
    result = read_texture(state, nested.front()->element);
  } else {
    result.color = get_color(state, set, "value", glm::vec3(0.5f), ColorUse::Reflectance);
  }
  const Property* factor = set.find("scale");
  if (factor != nullptr && factor->tag != "texture") {
    result.color.value *= read_color(state, factor->element, ColorUse::Reflectance);
  }
  return result;
}

TextureInput make_texture(State& state, const Properties& set) {
  if (set.type() == "bitmap" || set.type() == "ldrtexture") return bitmap(state, set);
  if (set.type() == "checkerboard") return checkerboard(state, set);
  if (set.type() == "scale") return scale(state, set);
  state.warnings.add(set.where(), "<texture type=\"" + set.element().attribute("type") +
                                      "\"> is not supported; a grey of 0.5 is used");
  for (const char* tag : {"texture", "transform", "float", "rgb", "string"}) set.objects(tag);
  return {ColorInput(glm::vec3(0.5f))};
}

}  // namespace

TextureInput read_texture(State& state, const Element& element) {
  const auto known = state.textures.find(element.node);
  if (known != state.textures.end()) return known->second;
  const Nesting nesting(state, element);
  const Properties set = state.properties(element);
  const TextureInput texture = make_texture(state, set);
  set.warn_unused(state.warnings);
  state.textures[element.node] = texture;
  return texture;
}

}  // namespace lockstep::mitsuba
