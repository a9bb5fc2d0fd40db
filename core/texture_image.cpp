// Reading the images of textures.
#include "core/texture_image.h"

#include "core/error.h"
#include "core/exr_file.h"
#include "core/half.h"
#include "core/image.h"
#include "core/image_module.h"
#include "core/srgb.h"
#include "core/texel.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <new>
#include <stdexcept>

namespace lockstep {
namespace {

namespace fs = std::filesystem;

// Runs an action on a texture's file; its errors get the place in the scene and the file's name.
template <typename Action>
auto naming(const ImageTexture& texture, bool name_file, Action action) {
  const std::string file = texture.file.empty() ? "image in the scene file" : texture.file;
  const std::string place = texture.where.empty() ? "" : texture.where + ": ";
  const std::string prefix = name_file ? place + file + ": " : place;
  try {
    return action();
  } catch (const std::bad_alloc&) {
    throw Error(place + file + ": image too large for memory, or its header is damaged");
  } catch (const std::length_error&) {
    throw Error(place + file + ": image too large for memory, or its header is damaged");
  } catch (const std::exception& error) {
    std::string reason = error.what();
    std::replace(reason.begin(), reason.end(), '\n', ' ');
    throw Error(prefix + reason.substr(0, reason.find_last_not_of(' ') + 1));
  }
}

// `words` without their padding.
TextureImage image_of(int width, int height, TexelFormat format, std::vector<std::int32_t> words) {
  TextureImage image;
  image.format = format;
  image.words = std::move(words);
  image.words.resize(image.words.size() + texel_padding);
  image.levels = {width, height, 0, 0};
  return image;
}

float finite(float v) {
  if (std::isnan(v)) return 0.0f;
  return std::isinf(v) ? std::copysign(largest_half, v) : v;
}

TextureImage image_of_exr(const std::string& path) {
  const Image image = read_image(path);
  const std::size_t texels = image.pixels.size() / 3;
  if (texels > std::size_t(1) << 29) throw Error(path + ": the image is too large; scale it down");
  std::vector<std::int32_t> words;
  words.reserve(texels * 4 + texel_padding);
  for (std::size_t i = 0; i < image.pixels.size(); i += 3) {
    for (std::size_t c = 0; c < 3; ++c) {
      words.push_back(std::bit_cast<std::int32_t>(image.pixels[i + c]));
    }
    words.push_back(std::bit_cast<std::int32_t>(1.0f));
  }
  return image_of(image.width, image.height, TexelFormat::Float, std::move(words));
}

TextureImage image_of_pixels(StoredPixels pixels) {
  TextureImage image;
  image.format = pixels.format;
  image.words = std::move(pixels.words);
  image.levels = {pixels.width, pixels.height, 0, 0};
  return image;
}

TextureImage stored_image(const ImageTexture& texture) {
  if (texture.encoded) {
    return naming(texture, true,
                  [&] { return image_of_pixels(read_stored_with_module(*texture.encoded)); });
  }
  std::error_code ignored;
  const bool readable =
      fs::exists(texture.file, ignored) && !fs::is_directory(texture.file, ignored);
  if (!readable || is_exr_file(texture.file)) {
    // read_image names the file in its errors.
    return naming(texture, false, [&] { return image_of_exr(texture.file); });
  }
  return naming(texture, true,
                [&] { return image_of_pixels(read_stored_with_module(texture.file)); });
}

float decoded(const ImageTexture& texture, float stored) {
  if (texture.encoding == TextureEncoding::Gamma) {
    return std::pow(std::max(stored, 0.0f), texture.gamma);
  }
  return linear_from_srgb(stored);
}

bool is_linear(const ImageTexture& texture, TexelFormat format) {
  return texture.encoding == TextureEncoding::Linear ||
         (texture.encoding == TextureEncoding::ByFormat && format != TexelFormat::Byte);
}

void fill_decode_table(const ImageTexture& texture, TextureImage& image) {
  for (int code = 0; code < 256; ++code) {
    image.decode.push_back(decoded(texture, float(code) / 255.0f));
  }
}

// Replaces texels of any format by linear floats, their colours decoded.
void turn_into_linear_floats(const ImageTexture& texture, TextureImage& image) {
  const std::size_t texels = std::size_t(image.width()) * std::size_t(image.height());
  if (texels > std::size_t(1) << 29) throw Error("the image is too large; scale it down");
  std::vector<std::int32_t> words;
  words.reserve(texels * 4 + texel_padding);
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      const LinearTexel t = texel_at(image, 0, x, y);
      for (const float v : {decoded(texture, t.r), decoded(texture, t.g), decoded(texture, t.b)}) {
        words.push_back(std::bit_cast<std::int32_t>(finite(v)));
      }
      words.push_back(std::bit_cast<std::int32_t>(t.a));
    }
  }
  image = image_of(image.width(), image.height(), TexelFormat::Float, std::move(words));
}

std::uint32_t finite_half(std::uint32_t bits) {
  if ((bits & 0x7c00u) != 0x7c00u) return bits;
  return bits & 0x3ffu ? 0u : (bits & 0x8000u) | half_from_float(largest_half);
}

void make_finite(TextureImage& image) {
  if (image.format == TexelFormat::Half) {
    for (std::int32_t& word : image.words) {
      const auto bits = std::uint32_t(word);
      word = std::int32_t(finite_half(bits & 0xffffu) | finite_half(bits >> 16) << 16);
    }
  }
  if (image.format == TexelFormat::Float) {
    for (std::int32_t& word : image.words) {
      word = std::bit_cast<std::int32_t>(finite(std::bit_cast<float>(word)));
    }
  }
}

bool is_half(std::int32_t word) {
  const std::uint32_t bits = std::uint32_t(word), exponent = bits >> 23 & 255u;
  if ((bits & 0x1fffu) == 0 && exponent >= 127u - 14u && exponent <= 127u + 15u) return true;
  const float v = std::bit_cast<float>(word);
  return float_from_half_bits(half_from_float(v)) == v;
}

// Floats that are halves, every one of them, take half the memory as such.
void pack_halves(TextureImage& image) {
  if (image.format != TexelFormat::Float) return;
  if (!std::all_of(image.words.begin(), image.words.end(), is_half)) return;
  const auto half = [&](std::size_t i) {
    return std::uint32_t(half_from_float(std::bit_cast<float>(image.words[i])));
  };
  std::vector<std::int32_t> words;
  words.reserve(image.words.size() / 2 + texel_padding);
  for (std::size_t i = 0; i + texel_padding < image.words.size(); i += 2) {
    words.push_back(std::int32_t(half(i) | half(i + 1) << 16));
  }
  image = image_of(image.width(), image.height(), TexelFormat::Half, std::move(words));
}

}  // namespace

TexelData TextureImage::view() const {
  return {words.data(),  decode.empty() ? nullptr : decode.data(),
          levels.data(), std::int32_t(levels.size() / level_stride),
          width(),       height(),
          format};
}

std::size_t TextureImage::memory_bytes() const {
  return words.size() * sizeof(words[0]) + levels.size() * sizeof(levels[0]) +
         decode.size() * sizeof(decode[0]);
}

void TextureImage::add_to(Fingerprint& print) const {
  print.add(std::int32_t(format));
  print.add_all(levels);
  print.add_all(words);
  print.add_all(decode);
}

LinearTexel texel_at(const TextureImage& image, int level, int x, int y) {
  const std::int32_t* row = &image.levels[std::size_t(level) * level_stride];
  const std::int32_t index = (y * row[0] + x) * words_per_texel(image.format);
  const Rgba<float> t = load_texel(image.view(), row[2] + index);
  return {t.r, t.g, t.b, t.a};
}

TextureImage read_texture_image(const ImageTexture& texture) {
  TextureImage image = stored_image(texture);
  naming(texture, true, [&] {
    if (texture.encoding == TextureEncoding::Gamma && !(texture.gamma > 0.0f)) {
      throw Error("the gamma of a texture must be above 0");
    }
    make_finite(image);
    if (is_linear(texture, image.format)) {
      pack_halves(image);
    } else if (image.format == TexelFormat::Byte) {
      fill_decode_table(texture, image);
    } else {
      turn_into_linear_floats(texture, image);
    }
  });
  return image;
}

}  // namespace lockstep
