#include "core/pbrt/textures.h"

#include <cstdlib>
#include <optional>
#include <string_view>
#include <utility>

namespace lockstep::pbrt {

namespace {

std::string where_text(const Location& where) {
  return where.file + ":" + std::to_string(where.line);
}

// From v upwards to v downwards.
UvTransform turned_over(const UvTransform& uv) {
  return {uv.u_row, -uv.v_row, {uv.offset.x, 1.0f - uv.offset.y}};
}

TextureWrap get_wrap(const Inputs& in) {
  const std::string wrap = in.set().get_string("wrap", "repeat");
  if (wrap == "black") return TextureWrap::Black;
  if (wrap == "clamp") return TextureWrap::Clamp;
  if (wrap != "repeat") in.warn("wrap \"" + wrap + "\" is not supported; the image repeats");
  return TextureWrap::Repeat;
}

// v4 names the filter; before it the choice was between two kinds of pyramid.
TextureFilter get_filter(const Inputs& in) {
  in.set().ignore({"maxanisotropy", "trilinear"});
  const char* fallback = in.library().version == Version::v4 ? "bilinear" : "ewa";
  const std::string filter = in.set().get_string("filter", fallback);
  if (filter == "point") return TextureFilter::Nearest;
  if (filter == "trilinear" || filter == "ewa" || filter == "EWA") return TextureFilter::Trilinear;
  if (filter != "bilinear") in.warn("filter \"" + filter + "\" is not known; bilinear is used");
  return TextureFilter::Bilinear;
}

void set_gamma(ImageTexture& image, float gamma) {
  image.encoding = gamma == 1.0f ? TextureEncoding::Linear : TextureEncoding::Gamma;
  image.gamma = gamma;
}

// "gamma 2.2"
std::optional<float> named_gamma(const std::string& encoding) {
  constexpr std::string_view word = "gamma ";
  if (!encoding.starts_with(word)) return std::nullopt;
  const float gamma = std::strtof(encoding.c_str() + word.size(), nullptr);
  if (gamma > 0.0f && gamma < 100.0f) return gamma;
  return std::nullopt;
}

// v4 "string encoding", v3 "bool gamma", v2 "float gamma".
void set_encoding(const Inputs& in, ImageTexture& image) {
  const ParameterSet& set = in.set();
  const std::string encoding = set.get_string("encoding", "");
  if (encoding == "sRGB") {
    image.encoding = TextureEncoding::Srgb;
  } else if (encoding == "linear") {
    image.encoding = TextureEncoding::Linear;
  } else if (const auto named = named_gamma(encoding)) {
    set_gamma(image, *named);
  } else if (!encoding.empty()) {
    in.warn("encoding \"" + encoding + "\" is not known; the file's format decides");
  } else if (set.find("gamma", {"bool"}) != nullptr) {
    const bool curved = set.get_bool("gamma", true);
    image.encoding = curved ? TextureEncoding::Srgb : TextureEncoding::Linear;
  } else if (set.find("gamma", {"float"}) != nullptr || in.library().version == Version::v2) {
    const float gamma = set.get_float("gamma", 1.0f);
    if (!(gamma > 0.0f)) fail(set.where(), set.owner() + " needs a gamma above 0");
    set_gamma(image, gamma);
  }
}

}  // namespace

UvTransform uv_transform(const Inputs& in) {
  const ParameterSet& set = in.set();
  const std::string mapping = set.get_string("mapping", "uv");
  if (mapping != "uv") {
    in.warn("the mapping \"" + mapping + "\" is not supported; the surface's uv is used");
    set.ignore({"v1", "v2", "udelta", "vdelta"});
    return {};
  }
  UvTransform uv;
  uv.u_row.x = set.get_float("uscale", 1.0f);
  uv.v_row.y = set.get_float("vscale", 1.0f);
  uv.offset = {set.get_float("udelta", 0.0f), set.get_float("vdelta", 0.0f)};
  return uv;
}

ImageTexture named_image(const Library& library, const ParameterSet& set, const Parameter& p) {
  if (p.strings.size() != 1 || p.strings[0].empty()) {
    fail(set.where(p), "\"string " + p.name + "\" must name one image file");
  }
  ImageTexture image;
  image.file = resolve(library, set.where().file, p.strings[0]);
  image.where = where_text(set.where(p));
  image.uv = turned_over(UvTransform{});
  return image;
}

ColorInput image_texture(const Inputs& in) {
  const ParameterSet& set = in.set();
  const Parameter* file = set.find("filename", {"string"});
  if (file == nullptr) fail(set.where(), set.owner() + " needs \"string filename\"");
  ImageTexture image = named_image(in.library(), set, *file);
  image.uv = turned_over(uv_transform(in));
  image.wrap_u = image.wrap_v = get_wrap(in);
  image.filter = get_filter(in);
  set_encoding(in, image);
  image.invert = set.get_bool("invert", false);
  const float scale = set.get_float("scale", 1.0f);
  if (image.invert && scale != 1.0f) {
    in.warn("the image is inverted before it is scaled, not after");
  }
  return {glm::vec3(scale), add_texture(in.library(), std::move(image))};
}

}  // namespace lockstep::pbrt
