// Smaller levels of images.
#include "core/half.h"
#include "core/texture_image.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <vector>

namespace lockstep {
namespace {

struct Span {
  int first = 0, count = 0;
  double weights[4] = {};
};

// Texels from `size` that the texel `at` of the next smaller level covers, and their shares.
Span covered(int at, int size, int smaller) {
  const double lo = double(at) * size / smaller, hi = double(at + 1) * size / smaller;
  Span span;
  span.first = int(lo);
  for (int i = span.first; i < size && i < hi && span.count < 4; ++i) {
    const double share = std::min(hi, double(i + 1)) - std::max(lo, double(i));
    span.weights[span.count++] = share / (hi - lo);
  }
  return span;
}

LinearTexel average(const TextureImage& image, int level, const Span& columns, const Span& rows) {
  double sum[4] = {};
  for (int j = 0; j < rows.count; ++j) {
    for (int i = 0; i < columns.count; ++i) {
      const LinearTexel t = texel_at(image, level, columns.first + i, rows.first + j);
      const double weight = rows.weights[j] * columns.weights[i];
      sum[0] += weight * double(t.r), sum[1] += weight * double(t.g);
      sum[2] += weight * double(t.b), sum[3] += weight * double(t.a);
    }
  }
  return {float(sum[0]), float(sum[1]), float(sum[2]), float(sum[3])};
}

std::uint32_t whole(float fraction, float largest) {
  return std::uint32_t(std::lround(std::clamp(fraction, 0.0f, 1.0f) * largest));
}

// The code whose linear value is nearest.
std::uint32_t encoded(const TextureImage& image, float v) {
  if (image.decode.empty()) return whole(v, 255.0f);
  const auto above = std::lower_bound(image.decode.begin(), image.decode.end(), v);
  if (above == image.decode.end()) return 255u;
  const auto code = std::uint32_t(above - image.decode.begin());
  return code > 0 && v - *(above - 1) < *above - v ? code - 1 : code;
}

// Stores a texel in the format of `image`.
void put(const TextureImage& image, const LinearTexel& t, std::int32_t* words) {
  const auto pair = [](std::uint32_t low, std::uint32_t high) {
    return std::int32_t(low | high << 16);
  };
  switch (image.format) {
    case TexelFormat::Byte:
      words[0] = std::int32_t(encoded(image, t.r) | encoded(image, t.g) << 8 |
                              encoded(image, t.b) << 16 | whole(t.a, 255.0f) << 24);
      return;
    case TexelFormat::Short:
      words[0] = pair(whole(t.r, 65535.0f), whole(t.g, 65535.0f));
      words[1] = pair(whole(t.b, 65535.0f), whole(t.a, 65535.0f));
      return;
    case TexelFormat::Half:
      words[0] = pair(half_from_float(t.r), half_from_float(t.g));
      words[1] = pair(half_from_float(t.b), half_from_float(t.a));
      return;
    case TexelFormat::Float:
      for (const float v : {t.r, t.g, t.b, t.a}) *words++ = std::bit_cast<std::int32_t>(v);
  }
}

std::vector<Span> covered_by_all(int size, int smaller) {
  std::vector<Span> spans;
  for (int at = 0; at < smaller; ++at) spans.push_back(covered(at, size, smaller));
  return spans;
}

void append_level(TextureImage& image, int level) {
  const int width = image.levels[std::size_t(level) * level_stride];
  const int height = image.levels[std::size_t(level) * level_stride + 1];
  const int w = std::max(1, width / 2), h = std::max(1, height / 2);
  const std::vector<Span> columns = covered_by_all(width, w), rows = covered_by_all(height, h);
  const auto texel_words = std::size_t(words_per_texel(image.format));
  std::vector<std::int32_t> words(std::size_t(w) * std::size_t(h) * texel_words);
  tbb::parallel_for(std::size_t(0), rows.size(), [&](std::size_t y) {
    std::int32_t* out = words.data() + y * columns.size() * texel_words;
    for (const Span& span : columns) {
      put(image, average(image, level, span, rows[y]), out);
      out += texel_words;
    }
  });
  const auto first = std::int32_t(image.words.size() - texel_padding);
  image.levels.insert(image.levels.end(), {w, h, first, 0});
  image.words.insert(image.words.end() - texel_padding, words.begin(), words.end());
}

}  // namespace

void add_pyramid(TextureImage& image) {
  if (image.words.size() > std::size_t(1) << 30) return;  // the levels' indices would not fit
  image.words.reserve(image.words.size() / 3 * 4 + 64);
  for (int level = 0; image.levels.end()[-4] > 1 || image.levels.end()[-3] > 1; ++level) {
    append_level(image, level);
  }
}

}  // namespace lockstep
