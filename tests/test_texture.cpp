// Textures: lookups against a plain reference in double precision, widths against each other.
#include "core/texture.h"

#include "core/half.h"
#include "tests/t_texture.h"

#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace lockstep::test_texture {
namespace {

// Nearest texels change here, and rounding decides.
bool next_to_an_edge(const Reference& r, const ImageTexture& t, glm::vec2 uv) {
  const glm::dvec2 p = transformed(t.uv, uv) * glm::dvec2(r.width, r.height);
  const auto off = [](double x) { return std::abs(x - std::round(x)); };
  return t.filter == TextureFilter::Nearest && (off(p.x) < 1e-3 || off(p.y) < 1e-3);
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
  EXPECT_LT(TextureStore({Texture(sharp)}).memory_bytes(),
            TextureStore({Texture(t)}).memory_bytes());
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
}  // namespace lockstep::test_texture
