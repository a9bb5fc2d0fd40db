// Textures as the kernels see them: plain arrays, owned by TextureStore; the same for every
// instruction set and width.
#pragma once

#include "core/texture_description.h"

#include <glm/vec3.hpp>

#include <cstdint>

namespace lockstep {

// How texels are stored, red first: 4 x 8 or 4 x 16 bits of fractions, 4 halves or 4 floats.
enum class TexelFormat : std::int32_t { Byte, Short, Half, Float };

constexpr int words_per_texel(TexelFormat format) {
  return format == TexelFormat::Byte ? 1 : format == TexelFormat::Float ? 4 : 2;
}

inline constexpr int texel_padding = 3;  // words behind the last texel: kernels read four at a time

// Texels row by row from the top left, in words of 32 bits. Smaller levels of a pyramid follow the
// image. Values are finite.
struct TexelData {
  const std::int32_t* words = nullptr;
  const float* decode = nullptr;         // linear values of the 256 bytes of a colour; none: linear
  const std::int32_t* levels = nullptr;  // `level_stride` each: width, height, first word
  std::int32_t level_count = 1;
  std::int32_t width = 0, height = 0;
  TexelFormat format = TexelFormat::Byte;
};
inline constexpr int level_stride = 4;

struct ImageLookup {
  TexelData texels;
  TextureWrap wrap_u = TextureWrap::Repeat, wrap_v = TextureWrap::Repeat;
  TextureFilter filter = TextureFilter::Bilinear;
  bool invert = false;
};

// Steps of a program on a stack of colours; what they take from it, and what they put there.
enum class TextureOp : std::int32_t {
  Constant,      //            -> value, alpha 1
  Image,         //            -> texel of the image at uv
  Scale,         // a          -> a value
  Number,        // a          -> value.x times the power of a channel of a, in all channels
  Checkerboard,  // even odd   -> the one that lies at uv
  Product,       // a b        -> a b
  Mix,           // a b amount -> a (1 - amount) + b amount
};

struct TextureNode {
  TextureOp op = TextureOp::Constant;
  std::int32_t image = -1;
  glm::vec3 value{1.0f};
  std::int32_t channel = -1;  // as FloatInput has it
  float power = 1.0f;
  UvTransform uv{};
};

inline constexpr int max_texture_depth = 16;
inline constexpr int max_texture_nodes = 256;
inline constexpr int texture_stack_size = 2 * max_texture_depth + 1;

struct TextureProgram {
  std::int32_t first = 0, count = 0;  // among the nodes
};

struct TextureTable {
  const TextureProgram* programs = nullptr;  // one per texture of the scene
  const TextureNode* nodes = nullptr;
  const ImageLookup* images = nullptr;
};

}  // namespace lockstep
