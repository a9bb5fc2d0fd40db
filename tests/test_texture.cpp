// Textures: lookups against a plain reference in double precision, widths against each other,
// expressions by hand, and files that cannot be used.
#include "core/texture.h"

#include "core/half.h"
#include "core/image.h"
#include "core/texture_store.h"
#include "tests/t_files.h"
#include "tests/t_png.h"
#include "tests/widths.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <string>

namespace lockstep {
namespace {

using Color = std::array<double, 4>;

constexpr TextureWrap wraps[] = {TextureWrap::Repeat, TextureWrap::Mirror, TextureWrap::Clamp,
                                 TextureWrap::Black};

// Linear colours, row by row.
struct Reference {
  int width = 0, height = 0;
  std::vector<Color> texels;
};

// The texel of an index anywhere along an endless axis; -1: outside.
int wrapped(TextureWrap wrap, long i, long n) {
  const long period = wrap == TextureWrap::Mirror ? 2 * n : n;
  const long in_period = (i % period + period) % period;
  if (wrap == TextureWrap::Repeat) return int(in_period);
  if (wrap == TextureWrap::Mirror) return int(in_period < n ? in_period : period - 1 - in_period);
  if (wrap == TextureWrap::Clamp) return int(std::min(std::max(i, 0l), n - 1));
  return i >= 0 && i < n ? int(i) : -1;
}

Color texel(const Reference& r, const ImageTexture& t, long x, long y) {
  const int column = wrapped(t.wrap_u, x, r.width), row = wrapped(t.wrap_v, y, r.height);
  if (column < 0 || row < 0) return {};
  return r.texels[size_t(row * r.width + column)];
}

glm::dvec2 transformed(const UvTransform& t, glm::vec2 uv) {
  const glm::dvec2 p(uv);
  return {double(t.u_row.x) * p.x + double(t.u_row.y) * p.y + double(t.offset.x),
          double(t.v_row.x) * p.x + double(t.v_row.y) * p.y + double(t.offset.y)};
}

Color reference_lookup(const Reference& r, const ImageTexture& t, glm::vec2 uv) {
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

// Nearest texels change here, and rounding decides.
bool next_to_an_edge(const Reference& r, const ImageTexture& t, glm::vec2 uv) {
  const glm::dvec2 p = transformed(t.uv, uv) * glm::dvec2(r.width, r.height);
  const auto off = [](double x) { return std::abs(x - std::round(x)); };
  return t.filter == TextureFilter::Nearest && (off(p.x) < 1e-3 || off(p.y) < 1e-3);
}

double linear_of_srgb(double v) {
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

glm::vec2 some_uv(std::uint32_t i, std::uint32_t seed) {
  const Vec2<float> u = uniform2(i, seed);
  return {u.x * 7.0f - 3.0f, u.y * 7.0f - 3.0f};
}

void expect_color(const Rgba<float>& c, const Color& expected, double tolerance,
                  const std::string& what) {
  const double found[4] = {double(c.r), double(c.g), double(c.b), double(c.a)};
  for (size_t k = 0; k < 4; ++k) {
    EXPECT_NEAR(found[k], expected[k], tolerance) << what << ", channel " << k;
  }
}

TEST_F(Textures, LookupsMatchAReference) {
  for (const Case& c : cases()) {
    std::vector<Texture> textures;
    for (const TextureWrap u : wraps) {
      for (const TextureWrap v : wraps) {
        ImageTexture t = texture_of(c);
        t.wrap_u = u, t.wrap_v = v;
        t.invert = u == v;
        if (u != TextureWrap::Repeat) t.uv = {{0.5f, -0.25f}, {0.75f, 1.5f}, {0.3f, -1.2f}};
        for (const TextureFilter f : {TextureFilter::Nearest, TextureFilter::Bilinear}) {
          t.filter = f;
          textures.push_back(t);
        }
      }
    }
    const TextureStore store(textures);
    ASSERT_EQ(store.image_count(), 1u);
    ASSERT_EQ(store.table().images[0].texels.format, c.format) << c.name;
    for (size_t k = 0; k < textures.size() && !HasFailure(); ++k) {
      const auto& t = std::get<ImageTexture>(textures[k]);
      for (std::uint32_t i = 0; i < 400 && !HasFailure(); ++i) {
        const glm::vec2 uv = some_uv(i, 11);
        if (next_to_an_edge(c.reference, t, uv)) continue;
        const Rgba<float> found = lookup<float>(store.table(), int(k), uv);
        expect_color(found, reference_lookup(c.reference, t, uv), 3e-5,
                     c.name + " " + std::to_string(k));
      }
    }
  }
}

TEST_F(Textures, TexelCentresAreExact) {
  for (const Case& c : cases()) {
    const TextureStore store({Texture(texture_of(c))});
    const Reference& r = c.reference;
    for (int y = 0; y < r.height; ++y) {
      for (int x = 0; x < r.width; ++x) {
        const glm::vec2 uv((float(x) + 0.5f) / float(r.width), (float(y) + 0.5f) / float(r.height));
        const Rgba<float> found = lookup<float>(store.table(), 0, uv);
        expect_color(found, r.texels[size_t(y * r.width + x)], 2e-6, c.name);
      }
    }
  }
}

TEST_F(Textures, WhiteIsOne) {
  for (const int bits : {8, 16}) {
    const PngImage white{1, 1, 4, bits, std::vector<std::uint16_t>(4, 0xffff)};
    ImageTexture t;
    t.file = write("white.png", png_bytes(white));
    for (const auto encoding : {TextureEncoding::Linear, TextureEncoding::Srgb}) {
      t.encoding = encoding;
      const TextureStore store({Texture(t)});
      const Rgba<float> c = lookup<float>(store.table(), 0, Vec2<float>(0.3f, 5.7f));
      for (const float v : {c.r, c.g, c.b, c.a}) EXPECT_EQ(v, 1.0f);
    }
  }
}

TEST_F(Textures, GreyAndAlphaArePutInTheirPlaces) {
  for (const int channels : {1, 2, 3, 4}) {
    for (const int bits : {8, 16}) {
      PngImage image{1, 1, channels, bits, {}};
      for (int k = 0; k < channels; ++k) image.values.push_back(std::uint16_t(10 * (k + 1)));
      ImageTexture t;
      t.file = write("a.png", png_bytes(image));
      t.encoding = TextureEncoding::Linear;
      const TextureStore store({Texture(t)});
      const double step = bits == 8 ? 10.0 / 255.0 : 10.0 / 65535.0;
      const bool grey = channels < 3;
      const double alpha = channels == 2 ? 2.0 * step : channels == 4 ? 4.0 * step : 1.0;
      expect_color(lookup<float>(store.table(), 0, Vec2<float>(0.5f)),
                   {step, grey ? step : 2.0 * step, grey ? step : 3.0 * step, alpha}, 1e-7,
                   std::to_string(channels) + " channels");
    }
  }
}

TEST_F(Textures, NonFiniteTexelsAndCoordinatesStayHarmless) {
  Image image(2, 1);
  const float infinite = std::numeric_limits<float>::infinity();
  image.pixels = {std::nanf(""), infinite, -infinite, 1.0f, 1e-42f, 1.1f};
  write_image(path("a.exr"), image);
  ImageTexture t;
  t.file = path("a.exr");
  std::vector<Texture> textures;
  for (const TextureWrap wrap : wraps) {
    t.wrap_u = t.wrap_v = wrap;
    for (const auto filter : {TextureFilter::Nearest, TextureFilter::Trilinear}) {
      t.filter = filter;
      textures.push_back(t);
    }
  }
  textures.push_back(CheckerboardTexture{});
  const TextureStore store(textures);
  const Rgba<float> left = lookup<float>(store.table(), 0, Vec2<float>(0.25f, 0.5f));
  EXPECT_EQ(left.r, 0.0f);
  EXPECT_EQ(left.g, 65504.0f);
  EXPECT_EQ(left.b, -65504.0f);
  const float odd[] = {0.0f, -1e-9f, 1.0f,     1e9f,      -3e38f,       3e38f,
                       1.5f, -1.0f,  infinite, -infinite, std::nanf("")};
  for (int k = 0; k < int(textures.size()); ++k) {
    for (const float u : odd) {
      for (const float v : odd) {
        const auto c = lookup<float>(store.table(), k, Vec2<float>(u, v));
        const auto d = lookup<float>(store.table(), k, Vec2<float>(u, v), u);
        for (const float x : {c.r, c.g, c.b, c.a, d.r, d.g, d.b, d.a}) {
          EXPECT_TRUE(std::isfinite(x)) << "texture " << k << " at " << u << ", " << v;
        }
      }
    }
  }
}

TEST(Half, EveryCodeIsConvertedBothWays) {
  for (std::uint32_t code = 0; code < 0x10000u; ++code) {
    if ((code & 0x7c00u) == 0x7c00u) continue;  // not finite
    const int exponent = int(code >> 10 & 31u), fraction = int(code & 1023u);
    const double magnitude = exponent == 0 ? std::ldexp(double(fraction), -24)
                                           : std::ldexp(1024.0 + fraction, exponent - 25);
    const auto expected = float(code & 0x8000u ? -magnitude : magnitude);
    ASSERT_TRUE(same_value(float_from_half(code), expected)) << code;
    ASSERT_TRUE(same_value(float_from_half_bits(std::uint16_t(code)), expected)) << code;
    ASSERT_EQ(half_from_float(expected), code);
    if (fraction == 1023 || exponent == 0) continue;
    // Half way to the next code: to the even one.
    const float step = std::ldexp(expected < 0.0f ? -1.0f : 1.0f, exponent - 26);
    ASSERT_EQ(half_from_float(expected + step), code + (code & 1u));
    ASSERT_EQ(half_from_float(expected + 1.25f * step), code + 1u);
  }
  EXPECT_EQ(half_from_float(1e30f), half_from_float(largest_half));
}

// Pyramids --------------------------------------------------------------------------------------

TEST_F(Textures, PyramidsAverageByArea) {
  const Image whole = [] {
    Image image(8, 4);
    for (std::uint32_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = uniform3(i, 4).x;
    return image;
  }();
  write_image(path("a.exr"), whole);
  ImageTexture t;
  t.file = path("a.exr");
  t.filter = TextureFilter::Trilinear;
  ImageTexture sharp = t;
  sharp.filter = TextureFilter::Bilinear;
  const TextureStore store({Texture(t), Texture(sharp)});
  EXPECT_EQ(store.image_count(), 1u);
  EXPECT_LT(TextureStore({Texture(t)}, false).memory_bytes(), store.memory_bytes());
  Reference half{4, 2, {}};
  for (int y = 0; y < 2; ++y) {
    for (int x = 0; x < 4; ++x) {
      Color c{0.0, 0.0, 0.0, 1.0};
      for (int k = 0; k < 12; ++k) {
        c[size_t(k % 3)] += 0.25 * double(whole.at(2 * x + k / 3 % 2, 2 * y + k / 6)[k % 3]);
      }
      half.texels.push_back(c);
    }
  }
  for (std::uint32_t i = 0; i < 200; ++i) {
    const glm::vec2 uv = some_uv(i, 12);
    const Rgba<float> none = lookup<float>(store.table(), 0, uv);
    const Rgba<float> zero = lookup<float>(store.table(), 0, uv, 0.0f);
    const Rgba<float> one = lookup<float>(store.table(), 0, uv, 1.0f);
    EXPECT_EQ(none.r, zero.r);
    EXPECT_EQ(none.g, lookup<float>(store.table(), 1, uv, 2.0f).g);
    expect_color(one, reference_lookup(half, sharp, uv), 3e-6, "level 1");
    const Rgba<float> between = lookup<float>(store.table(), 0, uv, 0.25f);
    EXPECT_NEAR(between.r, 0.75f * zero.r + 0.25f * one.r, 1e-6f);
  }
  double mean = 0.0;
  for (size_t i = 0; i < whole.pixels.size(); i += 3) mean += double(whole.pixels[i]) / 32.0;
  EXPECT_NEAR(double(lookup<float>(store.table(), 0, Vec2<float>(0.1f), 99.0f).r), mean, 1e-6);
}

// Every format, sides that are not even, a single row: the smallest level is the linear mean.
TEST_F(Textures, SmallestLevelIsTheMean) {
  for (const Case& c : cases()) {
    ImageTexture t = texture_of(c);
    t.filter = TextureFilter::Trilinear;
    const TextureStore store({Texture(t)});
    Color mean{};
    for (const Color& texel : c.reference.texels) {
      for (size_t k = 0; k < 4; ++k) mean[k] += texel[k] / double(c.reference.texels.size());
    }
    const double step = c.format == TexelFormat::Byte ? 1.5e-2 : 1e-3;  // of what is stored
    expect_color(lookup<float>(store.table(), 0, Vec2<float>(0.2f), 9.0f), mean, step, c.name);
  }
}

// Expressions -----------------------------------------------------------------------------------

Color plus_alpha(glm::vec3 v) { return {double(v.x), double(v.y), double(v.z), 1.0}; }

TEST_F(Textures, ExpressionsAreEvaluated) {
  const Case c =
      png_case("a", 8, TextureEncoding::Linear, TexelFormat::Byte, [](double v) { return v; });
  CheckerboardTexture board;
  board.even = glm::vec3(0.25f, 0.5f, 1.0f);
  board.odd = ColorInput(glm::vec3(0.5f, 2.0f, 1.0f), 0);
  board.uv = {{2.0f, 0.0f}, {0.0f, 3.0f}, {0.1f, 0.0f}};
  const ProductTexture product{ColorInput(glm::vec3(2.0f), 0), ColorInput(glm::vec3(1.0f), 1)};
  MixTexture mix{ColorInput(glm::vec3(1.0f), 2), glm::vec3(0.1f, 0.2f, 0.3f)};
  MixTexture by_channel = mix;
  by_channel.amount.texture = 0, by_channel.amount.channel = 1, by_channel.amount.value = 0.5f;
  by_channel.amount.power = 2.0f;
  MixTexture by_mean = by_channel;
  by_mean.amount.channel = -1, by_mean.amount.power = 1.7f;
  const TextureStore store({Texture(texture_of(c)), board, product, mix, by_channel, by_mean});
  for (std::uint32_t i = 0; i < 300; ++i) {
    const glm::vec2 uv = some_uv(i, 13);
    const Color image = reference_lookup(c.reference, texture_of(c), uv);
    const glm::dvec2 p = transformed(board.uv, uv);
    const bool even = std::fmod(std::floor(p.x) + std::floor(p.y), 2.0) == 0.0;
    Color expected = plus_alpha(board.even.value), a{}, b = plus_alpha(mix.b.value);
    if (!even) expected = {image[0] * 0.5, image[1] * 2.0, image[2], image[3]};
    const auto found = [&](int texture) { return lookup<float>(store.table(), texture, uv); };
    expect_color(found(1), expected, 1e-4, "checkerboard");
    for (size_t k = 0; k < 4; ++k) a[k] = image[k] * (k < 3 ? 2.0 : 1.0) * expected[k];
    expect_color(found(2), a, 1e-4, "product");
    const auto mixed_by = [&](double amount) {
      Color m{};
      for (size_t k = 0; k < 4; ++k) m[k] = (1.0 - amount) * a[k] + amount * b[k];
      return m;
    };
    expect_color(found(3), mixed_by(0.5), 1e-4, "mix");
    expect_color(found(4), mixed_by(0.5 * image[1] * image[1]), 1e-4, "mix by a channel");
    const double mean = (image[0] + image[1] + image[2]) / 3.0;
    expect_color(found(5), mixed_by(0.5 * std::pow(mean, double(1.7f))), 1e-4, "mix by a mean");
  }
}

ProductTexture product_of(int a, int b) {
  return {ColorInput(glm::vec3(1.0f), a), ColorInput(glm::vec3(0.5f), b)};
}

TEST_F(Textures, ExpressionsHaveLimits) {
  const auto error = [](const std::vector<Texture>& textures) {
    return error_of([&] { TextureStore store(textures); });
  };
  expect_one_line_with(error({product_of(0, -1)}), "refers to itself");
  expect_one_line_with(error({product_of(1, -1), product_of(0, -1)}), "refers to itself");
  expect_one_line_with(error({product_of(7, -1)}), "texture 7, which does not exist");
  std::vector<Texture> chain{CheckerboardTexture{}}, tree = chain;
  for (int i = 0; i < max_texture_depth - 1; ++i) {
    chain.push_back(product_of(-1, i));
    tree.push_back(product_of(i, i));
  }
  EXPECT_EQ(error(chain), "");
  expect_one_line_with(error(tree), "parts");
  const TextureStore store(chain);
  const int last = max_texture_depth - 1;
  EXPECT_EQ(lookup<float>(store.table(), last, Vec2<float>(0.5f)).g, std::ldexp(1.0f, -last));
  chain.push_back(product_of(-1, last));
  expect_one_line_with(error(chain), "deep");
}

// Sharing and memory ----------------------------------------------------------------------------

TEST_F(Textures, ImagesAreHeldOncePerEncoding) {
  const Case c = cases()[0];
  const ImageTexture t = texture_of(c);
  ImageTexture mirrored = t, linear = t, detour = t;
  mirrored.wrap_u = TextureWrap::Mirror;
  linear.encoding = TextureEncoding::Linear;
  detour.file = path("./srgb.png");
  const TextureStore one({Texture(t)}), same({Texture(t), mirrored, detour}),
      two({Texture(t), linear});
  EXPECT_EQ(same.image_count(), 1u);
  EXPECT_EQ(two.image_count(), 2u);
  EXPECT_GE(one.memory_bytes(), 7u * 5u * 4u);
  EXPECT_LT(one.memory_bytes(), 4096u);
  EXPECT_EQ(TextureStore().memory_bytes(), 0u);
  EXPECT_EQ(one.fingerprint(), TextureStore({Texture(t)}).fingerprint());
  EXPECT_NE(one.fingerprint(), TextureStore({Texture(mirrored)}).fingerprint());
  EXPECT_NE(one.fingerprint(), TextureStore({Texture(linear)}).fingerprint());
}

std::shared_ptr<const std::vector<unsigned char>> in_memory(const std::string& bytes) {
  return std::make_shared<const std::vector<unsigned char>>(bytes.begin(), bytes.end());
}

TEST_F(Textures, ImagesInMemoryAreRead) {
  const Case c = cases()[0];
  std::ifstream file(c.file, std::ios::binary);
  const std::string png{std::istreambuf_iterator<char>(file), {}};
  ImageTexture t = texture_of(c), on_disk = t;
  t.file = "scene.glb: image 3";
  t.encoded = in_memory(png);
  const TextureStore store({Texture(t), on_disk});
  for (std::uint32_t i = 0; i < 50; ++i) {
    const glm::vec2 uv = some_uv(i, 14);
    EXPECT_EQ(lookup<float>(store.table(), 0, uv).g, lookup<float>(store.table(), 1, uv).g);
  }
  Image grey(16, 16);
  for (float& v : grey.pixels) v = 0.2f;
  for (const std::string name : {"a.jpg", "a.webp", "a.bmp", "a.hdr", "a.exr"}) {
    write_image(path(name), grey);
    std::ifstream other(path(name), std::ios::binary);
    t.encoded = in_memory({std::istreambuf_iterator<char>(other), {}});
    const TextureStore from_memory({Texture(t)});
    EXPECT_NEAR(lookup<float>(from_memory.table(), 0, Vec2<float>(0.5f)).b, 0.2f, 0.01f) << name;
  }
}

// Files that cannot be used ---------------------------------------------------------------------

TEST_F(Textures, BadFilesAreErrors) {
  const auto error = [](const std::string& file) {
    ImageTexture t;
    t.file = file;
    t.where = "scene.pbrt:12";
    const std::string message = error_of([&] { TextureStore store({Texture(t)}); });
    expect_one_line_with(message, "scene.pbrt:12: " + file + ": ");
    return message;
  };
  const std::string png = png_bytes(random_png(3, 8));
  expect_one_line_with(error(path("missing.png")), "no such image file");
  expect_one_line_with(error(path("missing.exr")), "no such image file");
  expect_one_line_with(error(directory_.string()), "directory");
  error(write("text.png", "not an image at all\n"));
  error(write("empty.png", ""));
  error(write("cut.png", png.substr(0, png.size() / 2)));
  error(write("zero.png", png_bytes({0, 0, 3, 8, {}})));
  error(write("zero.ppm", "P6\n0 0\n255\n"));
  error(write("vast.png", png_bytes({60000, 60000, 3, 16, {}})));
  error(write("absurd.png", png_bytes({0x7fffffff, 0x7fffffff, 3, 8, {}})));
  Image noise(64, 64);
  for (std::uint32_t i = 0; i < noise.pixels.size(); ++i) noise.pixels[i] = uniform3(i, 5).x;
  write_image(path("cut.exr"), noise);
  std::filesystem::resize_file(path("cut.exr"), std::filesystem::file_size(path("cut.exr")) / 2);
  error(path("cut.exr"));
}

TEST_F(Textures, BadImagesInMemoryAndBadGammasAreErrors) {
  ImageTexture t;
  t.file = "scene.glb: image 3";
  t.where = "scene.glb: texture 1";
  const std::string png = png_bytes(random_png(3, 8));
  for (const std::string& bytes :
       {std::string(), std::string("GIF89a"), std::string("\x89PNG"), png.substr(0, 60)}) {
    t.encoded = in_memory(bytes);
    const std::string message = error_of([&] { TextureStore store({Texture(t)}); });
    expect_one_line_with(message, "scene.glb: texture 1: scene.glb: image 3: ");
  }
  ImageTexture dark = texture_of(cases()[0]);
  dark.encoding = TextureEncoding::Gamma;
  for (const float gamma : {0.0f, -1.0f, std::nanf("")}) {
    dark.gamma = gamma;
    expect_one_line_with(error_of([&] { TextureStore store({Texture(dark)}); }), "gamma");
  }
}

// Widths ----------------------------------------------------------------------------------------

template <int W>
void expect_same_bits(const TextureTable& table, int texture) {
  using V = Float<W>;
  for (std::uint32_t first = 0; first < 160; first += W) {
    float u[W], v[W], level[W];
    for (int k = 0; k < W; ++k) {
      const std::uint32_t i = first + std::uint32_t(k);
      const glm::vec2 uv = some_uv(i, 15);
      u[k] = i == 9 ? std::nanf("") : i == 10 ? 1e30f : i == 11 ? -1e-9f : uv.x;
      v[k] = uv.y, level[k] = uniform2(i, 16).x * 6.0f - 1.0f;
    }
    const Vec2<V> uv(load<V>(u), load<V>(v));
    const Rgba<V> wide = lookup(table, texture, uv),
                  at_level = lookup(table, texture, uv, load<V>(level));
    for (int k = 0; k < W; ++k) {
      const Rgba<float> one = lookup<float>(table, texture, {u[k], v[k]});
      const Rgba<float> one_at_level = lookup<float>(table, texture, {u[k], v[k]}, level[k]);
      ASSERT_TRUE(same_value(wide.r[k], one.r) && same_value(wide.g[k], one.g) &&
                  same_value(wide.b[k], one.b) && same_value(wide.a[k], one.a))
          << "W=" << W << " texture " << texture;
      ASSERT_TRUE(same_value(at_level.r[k], one_at_level.r) &&
                  same_value(at_level.a[k], one_at_level.a))
          << "W=" << W << " texture " << texture;
    }
  }
}

TEST_F(Textures, EveryWidthGivesTheSameBits) {
  std::vector<Texture> textures;
  int n = 0;
  for (const Case& c : cases()) {
    for (const auto filter :
         {TextureFilter::Nearest, TextureFilter::Bilinear, TextureFilter::Trilinear}) {
      ImageTexture t = texture_of(c);
      t.filter = filter;
      t.wrap_u = wraps[n % 4], t.wrap_v = wraps[n / 4 % 4];
      t.uv.u_row.y = 0.25f;
      t.invert = n++ % 2 == 0;
      textures.push_back(t);
    }
  }
  MixTexture mix{ColorInput(glm::vec3(2.0f), 1), ColorInput(glm::vec3(0.5f), n + 1)};
  mix.amount.texture = 2, mix.amount.power = 0.5f;
  textures.push_back(mix);
  textures.push_back(CheckerboardTexture{glm::vec3(0.3f), ColorInput(glm::vec3(1.0f), n + 2), {}});
  mix.b = glm::vec3(0.1f), mix.amount.power = 1.3f;
  textures.push_back(mix);
  const TextureStore store(textures);
  for (int k = 0; k < int(textures.size()); ++k) {
    for_each_width([&](auto width) { expect_same_bits<width()>(store.table(), k); });
  }
}

}  // namespace
}  // namespace lockstep
