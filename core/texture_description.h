// Textures as scene files state them, and the inputs of materials that refer to them.
//
// Convention: texture coordinates (u, v) have u to the right and v down, (0, 0) at the outer corner
// of an image's first pixel. Readers of formats with v upwards turn it by UvTransform.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <memory>
#include <string>
#include <variant>
#include <vector>

namespace lockstep {

// A colour that is constant, or `value` times a texture (an index of SceneDescription::textures).
struct ColorInput {
  glm::vec3 value{1.0f};
  int texture = -1;

  ColorInput() = default;
  ColorInput(glm::vec3 constant) : value(constant) {}
  ColorInput(glm::vec3 factor, int texture_index) : value(factor), texture(texture_index) {}
  friend bool operator==(const ColorInput&, const ColorInput&) = default;
};

// A number that is constant, or `value` times a power of one channel of a texture.
struct FloatInput {
  float value = 1.0f;
  int texture = -1;
  int channel = -1;    // 0 to 3; -1: the mean of the colours
  float power = 1.0f;  // roughness is stated as alpha, its square or its root

  FloatInput() = default;
  FloatInput(float constant) : value(constant) {}
  friend bool operator==(const FloatInput&, const FloatInput&) = default;
};

// (u, v) of a mesh to those of a texture: (dot(u_row, uv), dot(v_row, uv)) + offset.
struct UvTransform {
  glm::vec2 u_row{1.0f, 0.0f}, v_row{0.0f, 1.0f}, offset{0.0f};
};

enum class TextureWrap { Repeat, Mirror, Clamp, Black };
enum class TextureFilter { Nearest, Bilinear, Trilinear };

// How stored values become linear ones. ByFormat: sRGB for 8-bit images, linear for others. Data
// such as normals and roughness is Linear.
enum class TextureEncoding { ByFormat, Linear, Srgb, Gamma };

struct ImageTexture {
  std::string file;  // path; the name in errors where `encoded` holds the bytes
  std::shared_ptr<const std::vector<unsigned char>> encoded;  // an image inside the scene file
  TextureEncoding encoding = TextureEncoding::ByFormat;
  float gamma = 2.2f;  // of TextureEncoding::Gamma: linear = stored^gamma
  TextureWrap wrap_u = TextureWrap::Repeat, wrap_v = TextureWrap::Repeat;
  TextureFilter filter = TextureFilter::Bilinear;
  UvTransform uv;
  bool invert = false;  // 1 - value
  std::string where;    // "file:line" or what names it in the scene file, for errors
};

// Squares of side 1 after the transform: `even` where floor(u) + floor(v) is even.
struct CheckerboardTexture {
  ColorInput even{glm::vec3(1.0f)}, odd{glm::vec3(0.0f)};
  UvTransform uv;
};

struct ProductTexture {
  ColorInput a, b;
};

// a (1 - amount) + b amount
struct MixTexture {
  ColorInput a, b;
  FloatInput amount{0.5f};
};

using Texture = std::variant<ImageTexture, CheckerboardTexture, ProductTexture, MixTexture>;

}  // namespace lockstep
