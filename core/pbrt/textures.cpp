#include "core/pbrt/textures.h"

#include <initializer_list>
#include <string_view>
#include <utility>

namespace lockstep::pbrt {

namespace {

enum class Kind { Color, Float };

ColorInput as_color(const FloatInput& number) { return {glm::vec3(number.value), number.texture}; }

FloatInput as_number(const ColorInput& color) {
  FloatInput number(color.value.x);
  number.texture = color.texture;
  return number;
}

// An input of the same kind as the texture that it belongs to.
ColorInput input(const Inputs& in, Kind kind, std::string_view name, float fallback) {
  if (kind == Kind::Color) return in.color(name, glm::vec3(fallback));
  return as_color(in.number(name, fallback));
}

ColorInput mix(const Inputs& in, const ColorInput& a, const ColorInput& b, FloatInput amount) {
  if (a.texture < 0 && b.texture < 0 && amount.texture < 0) {
    return a.value * (1.0f - amount.value) + b.value * amount.value;
  }
  return {glm::vec3(1.0f), add_texture(in.library(), MixTexture{a, b, amount})};
}

ColorInput constant(const Inputs& in, Kind kind) { return input(in, kind, "value", 1.0f); }

ColorInput image(const Inputs& in, Kind) { return image_texture(in); }

ColorInput mixture(const Inputs& in, Kind kind) {
  const ColorInput a = input(in, kind, "tex1", 0.0f), b = input(in, kind, "tex2", 1.0f);
  return mix(in, a, b, in.number("amount", 0.5f));
}

// v4 scales "tex" by the number "scale", v3 multiplies "tex1" and "tex2".
ColorInput scaled(const Inputs& in, Kind kind) {
  const bool v4 = in.set().any("tex") != nullptr || in.set().any("scale") != nullptr;
  const ColorInput a = input(in, kind, v4 ? "tex" : "tex1", 1.0f);
  const ColorInput b = v4 ? as_color(in.number("scale", 1.0f)) : input(in, kind, "tex2", 1.0f);
  return multiply(in.library(), a, b);
}

ColorInput checkerboard(const Inputs& in, Kind kind) {
  CheckerboardTexture board;
  board.even = input(in, kind, "tex1", 1.0f);
  board.odd = input(in, kind, "tex2", 0.0f);
  in.set().ignore({"aamode"});
  if (in.set().get_int("dimension", 2) != 2) {
    in.warn("a checkerboard in three dimensions is not supported; the mean is used");
    return mix(in, board.even, board.odd, FloatInput(0.5f));
  }
  board.uv = uv_transform(in);
  return {glm::vec3(1.0f), add_texture(in.library(), std::move(board))};
}

// --- What kernels have no texture for: the mean

void warn_of_mean(const Inputs& in, std::initializer_list<std::string_view> ignored) {
  in.warn("this kind of texture is not supported; its mean is used");
  in.set().ignore(ignored);
}

ColorInput noise(const Inputs& in, float mean) {
  warn_of_mean(in, {"octaves", "roughness", "scale", "variation"});
  return glm::vec3(mean);
}

ColorInput signed_noise(const Inputs& in, Kind) { return noise(in, 0.0f); }
ColorInput wrinkled(const Inputs& in, Kind) { return noise(in, 0.5f); }

ColorInput marble(const Inputs& in, Kind) { return noise(in, 0.8f); }

// Dots are small: most of the surface is outside of them.
ColorInput dots(const Inputs& in, Kind kind) {
  warn_of_mean(in, {"inside", "mapping", "uscale", "vscale", "udelta", "vdelta"});
  return input(in, kind, "outside", 0.0f);
}

ColorInput bilinear(const Inputs& in, Kind kind) {
  warn_of_mean(in, {"mapping", "uscale", "vscale", "udelta", "vdelta"});
  glm::vec3 sum(0.0f);
  for (const char* corner : {"v00", "v01", "v10", "v11"}) {
    sum += input(in, kind, corner, corner[2] == '1' ? 1.0f : 0.0f).value;
  }
  return 0.25f * sum;
}

ColorInput by_direction(const Inputs& in, Kind kind) {
  warn_of_mean(in, {"dir"});
  const ColorInput a = input(in, kind, "tex1", 0.0f), b = input(in, kind, "tex2", 1.0f);
  return mix(in, a, b, FloatInput(0.5f));
}

ColorInput uv_colors(const Inputs& in, Kind) {
  warn_of_mean(in, {"mapping", "uscale", "vscale", "udelta", "vdelta"});
  return glm::vec3(0.5f, 0.5f, 0.0f);
}

ColorInput ptex(const Inputs& in, Kind) {
  warn_of_mean(in, {"filename", "encoding", "gamma"});
  return glm::vec3(0.5f * in.set().get_float("scale", 1.0f));
}

struct TextureType {
  std::string_view name;
  ColorInput (*make)(const Inputs&, Kind);
};

// To support another texture, write its function and add it here.
constexpr TextureType texture_types[] = {
    {"imagemap", image},
    {"constant", constant},
    {"scale", scaled},
    {"mix", mixture},
    {"checkerboard", checkerboard},
    {"fbm", signed_noise},
    {"windy", signed_noise},
    {"wrinkled", wrinkled},
    {"marble", marble},
    {"dots", dots},
    {"bilerp", bilinear},
    {"directionmix", by_direction},
    {"uv", uv_colors},
    {"ptex", ptex},
};

ColorInput make_texture(const Inputs& in, Kind kind, const std::string& type) {
  for (const TextureType& known : texture_types) {
    if (known.name != type) continue;
    const ColorInput made = known.make(in, kind);
    in.set().warn_unused(in.library().warnings);
    return made;
  }
  in.warn("this kind of texture is not known; a mean grey of 0.5 is used");
  return glm::vec3(0.5f);
}

const ColorInput& texture(Library& library, Kind kind, const std::string& name, int order,
                          const Location& where) {
  auto& own = kind == Kind::Color ? library.color_textures : library.float_textures;
  auto& others = kind == Kind::Color ? library.float_textures : library.color_textures;
  const char* word = kind == Kind::Color ? "spectrum" : "float";
  TextureDeclaration* found = own.find(name, order);
  if (found == nullptr) {
    const char* hint = others.find(name, order) != nullptr
                           ? (kind == Kind::Color ? "; there is a float texture of that name"
                                                  : "; there is a spectrum texture of that name")
                           : "";
    fail(where,
         "the " + std::string(word) + " texture \"" + name + "\" has not been defined" + hint);
  }
  if (found->progress != Progress::Done) {
    const Making making(library, found->progress, "the texture \"" + name + "\"", where);
    found->value = make_texture(Inputs(found->set, found->order, library), kind, found->type);
    found->progress = Progress::Done;
  }
  return found->value;
}

}  // namespace

ColorInput color_texture(Library& library, const std::string& name, int order,
                         const Location& where) {
  return texture(library, Kind::Color, name, order, where);
}

FloatInput float_texture(Library& library, const std::string& name, int order,
                         const Location& where) {
  return as_number(texture(library, Kind::Float, name, order, where));
}

ColorInput multiply(Library& library, const ColorInput& a, const ColorInput& b) {
  if (a.texture < 0) return {a.value * b.value, b.texture};
  if (b.texture < 0) return {a.value * b.value, a.texture};
  return {glm::vec3(1.0f), add_texture(library, ProductTexture{a, b})};
}

FloatInput multiply(Library& library, const FloatInput& a, const FloatInput& b) {
  return as_number(multiply(library, as_color(a), as_color(b)));
}

}  // namespace lockstep::pbrt
