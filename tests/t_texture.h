// Images in files with their linear colours, and lookups in double precision to compare with.
#pragma once

#include "core/image.h"
#include "core/texture.h"
#include "core/texture_store.h"
#include "tests/t_files.h"
#include "tests/t_png.h"
#include "tests/widths.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

namespace lockstep {

using Color = std::array<double, 4>;

inline constexpr TextureWrap wraps[] = {TextureWrap::Repeat, TextureWrap::Mirror,
                                        TextureWrap::Clamp, TextureWrap::Black};

// Linear colours, row by row.
struct Reference {
  int width = 0, height = 0;
  std::vector<Color> texels;
};

// The texel of an index anywhere along an endless axis; -1: outside.
inline int wrapped(TextureWrap wrap, long i, long n) {
  const long period = wrap == TextureWrap::Mirror ? 2 * n : n;
  const long in_period = (i % period + period) % period;
  if (wrap == TextureWrap::Repeat) return int(in_period);
  if (wrap == TextureWrap::Mirror) return int(in_period < n ? in_period : period - 1 - in_period);
  if (wrap == TextureWrap::Clamp) return int(std::min(std::max(i, 0l), n - 1));
  return i >= 0 && i < n ? int(i) : -1;
}

inline Color texel(const Reference& r, const ImageTexture& t, long x, long y) {
  const int column = wrapped(t.wrap_u, x, r.width), row = wrapped(t.wrap_v, y, r.height);
  if (column < 0 || row < 0) return {};
  return r.texels[size_t(row * r.width + column)];
}

inline glm::dvec2 transformed(const UvTransform& t, glm::vec2 uv) {
  const glm::dvec2 p(uv);
  return {double(t.u_row.x) * p.x + double(t.u_row.y) * p.y + double(t.offset.x),
          double(t.v_row.x) * p.x + double(t.v_row.y) * p.y + double(t.offset.y)};
}

inline Color reference_lookup(const Reference& r, const ImageTexture& t, glm::vec2 uv) {
  const glm::dvec2 p = transformed(t.uv, uv) * glm::dvec2(r.width, r.height);
  Color sum{};
  if (t.filter == TextureFilter::Nearest) {
    sum = texel(r, t, long(std::floor(p.x)), long(std::floor(p.y)));
  } else {
    const double x = std::floor(p.x - 0.5), y = std::floor(p.y - 0.5);
    for (const int j : {0, 1}) {
      for (const int i : {0, 1}) {
        const double weight =
            (1.0 - std::abs(p.x - 0.5 - x - i)) * (1.0 - std::abs(p.y - 0.5 - y - j));
        const Color c = texel(r, t, long(x) + i, long(y) + j);
        for (size_t k = 0; k < 4; ++k) sum[k] += weight * c[k];
      }
    }
  }
  for (size_t k = 0; k < 3 && t.invert; ++k) sum[k] = 1.0 - sum[k];
  return sum;
}

inline double linear_of_srgb(double v) {
  return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

// An image file with its linear colours under one encoding.
struct Case {
  std::string name;
  std::string file;
  TextureEncoding encoding = TextureEncoding::ByFormat;
  TexelFormat format = TexelFormat::Byte;  // in which it must be kept
  Reference reference;
};

class Textures : public TestWithFiles {
 protected:
  PngImage random_png(int channels, int bits) const {
    PngImage image{7, 5, channels, bits, {}};
    for (std::uint32_t i = 0; i < 35u * std::uint32_t(channels); ++i) {
      image.values.push_back(std::uint16_t(pcg3d(i, 1u, 2u).x >> (32 - bits)));
    }
    return image;
  }

  Case png_case(const std::string& name, int bits, TextureEncoding encoding, TexelFormat format,
                std::function<double(double)> decode) const {
    const PngImage image = random_png(4, bits);
    Case c{name, write(name + ".png", png_bytes(image)), encoding, format, {7, 5, {}}};
    const double largest = bits == 8 ? 255.0 : 65535.0;
    for (size_t i = 0; i < image.values.size(); i += 4) {
      Color color{};
      for (size_t k = 0; k < 4; ++k) color[k] = double(image.values[i + k]) / largest;
      for (size_t k = 0; k < 3; ++k) color[k] = decode(color[k]);
      c.reference.texels.push_back(color);
    }
    return c;
  }

  // Values in steps of 2^-20 for floats, of 2^-8 for halves.
  Case exr_case(const std::string& name, float steps, TexelFormat format) const {
    Image image(6, 9);
    Case c{name, path(name + ".exr"), TextureEncoding::ByFormat, format, {6, 9, {}}};
    for (std::uint32_t i = 0; i < 54; ++i) {
      const glm::vec3 v = floor3(uniform3(i, 3) * 2.0f * steps) / steps - 0.5f;
      for (int k = 0; k < 3; ++k) image.pixels[i * 3 + std::uint32_t(k)] = v[k];
      c.reference.texels.push_back({double(v.x), double(v.y), double(v.z), 1.0});
    }
    write_image(c.file, image);
    return c;
  }
  static glm::vec3 floor3(glm::vec3 v) {
    return {std::floor(v.x), std::floor(v.y), std::floor(v.z)};
  }

  std::vector<Case> cases() const {
    const auto same = [](double v) { return v; };
    const auto gamma = [](double v) { return std::pow(v, double(2.2f)); };
    return {
        png_case("srgb", 8, TextureEncoding::ByFormat, TexelFormat::Byte, linear_of_srgb),
        png_case("srgb2", 8, TextureEncoding::Srgb, TexelFormat::Byte, linear_of_srgb),
        png_case("linear", 8, TextureEncoding::Linear, TexelFormat::Byte, same),
        png_case("gamma", 8, TextureEncoding::Gamma, TexelFormat::Byte, gamma),
        png_case("short", 16, TextureEncoding::ByFormat, TexelFormat::Short, same),
        png_case("short_srgb", 16, TextureEncoding::Srgb, TexelFormat::Float, linear_of_srgb),
        png_case("short_gamma", 16, TextureEncoding::Gamma, TexelFormat::Float, gamma),
        exr_case("half", 0x1p8f, TexelFormat::Half),
        exr_case("float", 0x1p20f, TexelFormat::Float),
    };
  }

  static ImageTexture texture_of(const Case& c) {
    ImageTexture t;
    t.file = c.file;
    t.encoding = c.encoding;
    t.where = "scene:7";
    return t;
  }
};

inline glm::vec2 some_uv(std::uint32_t i, std::uint32_t seed) {
  const Vec2<float> u = uniform2(i, seed);
  return {u.x * 7.0f - 3.0f, u.y * 7.0f - 3.0f};
}

inline void expect_color(const Rgba<float>& c, const Color& expected, double tolerance,
                         const std::string& what) {
  const double found[4] = {double(c.r), double(c.g), double(c.b), double(c.a)};
  for (size_t k = 0; k < 4; ++k) {
    EXPECT_NEAR(found[k], expected[k], tolerance) << what << ", channel " << k;
  }
}

}  // namespace lockstep
