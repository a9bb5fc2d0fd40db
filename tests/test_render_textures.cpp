// Renders of textures on surfaces against closed forms.
#include "tests/t_square.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include <cmath>
#include <numbers>

namespace lockstep::test_render_textures {
namespace {

using builtin::add_material;
using builtin::add_rectangle;

glm::vec3 texels(int x, int y) {
  return {float(1 + (3 * x + 5 * y) % 7) / 8.0f, float(1 + (x + 2 * y) % 5) / 6.0f, 0.5f};
}

class RenderedTexture : public TestWithImages {
 protected:
  ImageTexture image(int width, int height, TextureFilter filter = TextureFilter::Nearest) const {
    return texture_of(exr("texels", width, height, texels), filter);
  }
  static SceneDescription square_with(Texture texture, int side = 8) {
    SceneDescription d = square(DiffuseMaterial{textured(0)}, side);
    add_texture(d, std::move(texture));
    return d;
  }
};

TEST_F(RenderedTexture, HasItsFirstTexelAtTheTopLeft) {
  expect_pixels(build(square_with(image(8, 8))), [](int x, int y) { return sky * texels(x, y); });
}

TEST_F(RenderedTexture, IsExactAtTexelCentresAndBilinearBetween) {
  SceneDescription d = square_with(image(8, 8, TextureFilter::Bilinear));
  sample_centres(d);
  expect_pixels(
      build(d), [](int x, int y) { return sky * texels(x, y); }, 2e-3f);
  // Pixels of half a texel: their centres lie a quarter of a texel from the next centre.
  d.film.width = d.film.height = 16;
  const auto along = [](int i) { return std::pair{(i + 15) / 2 % 8, (i + 17) / 2 % 8}; };
  const auto weight = [](int i) { return i % 2 == 0 ? 0.75f : 0.25f; };
  expect_pixels(
      build(d),
      [&](int x, int y) {
        const auto [x0, x1] = along(x);
        const auto [y0, y1] = along(y);
        const float s = weight(x), t = weight(y);
        return sky * ((1 - s) * ((1 - t) * texels(x0, y0) + t * texels(x0, y1)) +
                      s * ((1 - t) * texels(x1, y0) + t * texels(x1, y1)));
      },
      2e-3f);
}

TEST_F(RenderedTexture, WrapsAsItsModesSay) {
  const auto wrapped = [](TextureWrap wrap, int i) {  // of 4 texels; -1: outside
    const int repeated = (i + 8) % 4;
    if (wrap == TextureWrap::Repeat) return repeated;
    if (wrap == TextureWrap::Mirror) return (i + 8) / 4 % 2 == 0 ? repeated : 3 - repeated;
    if (wrap == TextureWrap::Clamp) return std::min(std::max(i, 0), 3);
    return i >= 0 && i < 4 ? i : -1;
  };
  using enum TextureWrap;
  for (const auto& [u, v] :
       {std::pair{Repeat, Mirror}, {Mirror, Clamp}, {Clamp, Black}, {Black, Repeat}}) {
    ImageTexture t = image(4, 4);
    t.wrap_u = u, t.wrap_v = v;
    // Twelve texels along each side, the image in their middle.
    t.uv = {{3.0f, 0.0f}, {0.0f, 3.0f}, glm::vec2(-1.0f)};
    expect_pixels(build(square_with(t, 12)), [&, u = u, v = v](int x, int y) {
      const int i = wrapped(u, x - 4), j = wrapped(v, y - 4);
      return i < 0 || j < 0 ? glm::vec3(0.0f) : sky * texels(i, j);
    });
  }
}

TEST_F(RenderedTexture, IsTurnedMirroredAndMovedByItsTransform) {
  ImageTexture t = image(8, 8);
  t.uv = {{0.0f, 1.0f}, {-1.0f, 0.0f}, {0.25f, 1.0f}};  // u' = v + 1/4, v' = 1 - u
  expect_pixels(build(square_with(t)),
                [](int x, int y) { return sky * texels((y + 2) % 8, 7 - x); });
  t.invert = true;
  expect_pixels(build(square_with(t)),
                [](int x, int y) { return sky * (glm::vec3(1.0f) - texels((y + 2) % 8, 7 - x)); });
}

TEST_F(RenderedTexture, OfBytesFollowsTheSrgbCurve) {
  PngImage image{4, 1, 3, 8, {0, 10, 60, 128, 188, 255, 20, 30, 40, 255, 0, 200}};
  const std::vector<std::uint16_t> stored = image.values;
  const Scene scene = build(square_with(texture_of(png("bytes", image)), 4));
  expect_pixels(scene, [&](int x, int) {
    const auto linear = [&](int c) {
      const double v = double(stored[std::size_t(3 * x + c)]) / 255.0;
      return float(v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4));
    };
    return sky * glm::vec3(linear(0), linear(1), linear(2));
  });
}

TEST_F(RenderedTexture, OfOtherTextures) {
  CheckerboardTexture checks;  // squares of two by four pixels
  checks.even = glm::vec3(0.1f, 0.2f, 0.3f);
  checks.odd = textured(0, glm::vec3(1.0f, 0.5f, 0.25f));
  checks.uv.u_row = {4.0f, 0.0f}, checks.uv.v_row = {0.0f, 2.0f};
  const auto checked = [](int x, int y) {
    return (x / 2 + y / 4) % 2 == 0 ? glm::vec3(0.1f, 0.2f, 0.3f)
                                    : glm::vec3(1.0f, 0.5f, 0.25f) * texels(x, y);
  };
  SceneDescription d = square_with(image(8, 8));
  add_texture(d, checks);
  add_texture(d, ProductTexture{textured(1, glm::vec3(0.5f)), textured(0)});
  FloatInput amount = textured_number(0, 0.8f);
  amount.channel = 1;
  amount.power = 2.0f;
  add_texture(d, MixTexture{textured(1), glm::vec3(0.9f, 0.0f, 0.6f), amount});
  const auto show = [&](int texture, const PixelFunction& expected) {
    d.materials[0] = DiffuseMaterial{textured(texture)};
    expect_pixels(build(d), [&](int x, int y) { return sky * expected(x, y); });
  };
  show(1, checked);
  show(2, [&](int x, int y) { return 0.5f * checked(x, y) * texels(x, y); });
  show(3, [&](int x, int y) {
    const float a = 0.8f * texels(x, y).y * texels(x, y).y;
    return (1.0f - a) * checked(x, y) + a * glm::vec3(0.9f, 0.0f, 0.6f);
  });
}

// Several materials, and several textures in one packet.
TEST_F(RenderedTexture, OfEveryMaterialIsItsOwn) {
  SceneDescription d = square_with(image(8, 8), 8);
  d.shapes.clear();
  d.materials.clear();
  add_texture(d, texture_of(exr("other", 8, 8, [](int x, int y) { return texels(y, x); })));
  for (int i = 0; i < 8; ++i) {  // columns of one pixel, each with the whole square's coordinates
    const glm::vec3 factor(1.0f, 1.0f - 0.1f * float(i), 1.0f);
    const int m = add_material(d, DiffuseMaterial{textured(i % 2, factor)});
    add_rectangle(d, {-0.875f + 0.25f * float(i), 0, 0}, {0.125f, 0, 0}, {0, 1, 0}, m);
    set_uvs(d, d.shapes.size() - 1);
    for (glm::vec2& uv : std::get<TriangleMesh>(d.shapes.back().geometry).uvs) {
      uv.x = (uv.x + float(i)) / 8.0f;
    }
  }
  expect_pixels(build(d), [](int x, int y) {
    const glm::vec3 t = x % 2 ? texels(y, x) : texels(x, y);
    return sky * t * glm::vec3(1.0f, 1.0f - 0.1f * float(x), 1.0f);
  });
}

// Triangles have (0, 0), (1, 0) and (1, 1) where nothing is said.
TEST_F(RenderedTexture, OfMeshesWithoutCoordinates) {
  // Along the diagonal, which is of both triangles, both have the first row.
  const auto color = [](int x, int y) { return y == 0 ? glm::vec3(0.7f) : texels(x, y); };
  ImageTexture t = texture_of(exr("texels", 8, 8, color));
  t.uv.offset.y = 0.5f / 8.0f;  // from between texels to their middle
  SceneDescription d = square_with(t);
  TriangleMesh mesh;
  mesh.positions = {{-1, 1, 0}, {1, 1, 0}, {1, -1, 0}, {-1, -1, 0}};
  mesh.triangles = {{0, 2, 1}, {2, 0, 3}};
  d.shapes[0].geometry = mesh;
  sample_centres(d);
  expect_pixels(build(d), [&](int x, int y) {
    // The first one's corners lie top left, bottom right and top right: with s to the right and r
    // down their weights are 1 - s, r and s - r, and so u = s and v = s - r. The second is turned.
    return sky * (x >= y ? color(x, x - y) : color(7 - x, y - x));
  });
}

// u = phi / 2 pi, v = 0 at -z. Seen along the axes, pixel by pixel.
TEST_F(RenderedTexture, OfSpheres) {
  const glm::vec3 centre(0.4f, -0.2f, 0.3f);
  const float radius = 0.7f;
  CheckerboardTexture checks;
  checks.even = glm::vec3(0.8f), checks.odd = glm::vec3(0.2f);
  checks.uv = {{16.0f, 0.0f}, {0.0f, 8.0f}, glm::vec2(0.0f)};
  for (const glm::vec3 from :
       {glm::vec3(2, 1, 1), glm::vec3(-1, 0.5f, -2), glm::vec3(0.3f, -2, 1)}) {
    SceneDescription d;
    builtin::add_sphere(d, centre, radius, add_material(d, DiffuseMaterial{textured(0)}));
    add_texture(d, checks);
    d.environment = glm::vec3(sky);
    look_straight(d, centre + from, centre, 2.0f * radius, 16, 16);
    sample_centres(d);
    const glm::mat4 camera = d.camera.camera_to_world;
    const Image image = rendered(build(std::move(d)), {.spp = 1, .depth = 1});
    int compared = 0;
    for (int y = 0; y < 16; ++y) {
      for (int x = 0; x < 16; ++x) {
        const float sx = (float(x) - 7.5f) / 8.0f, sy = (7.5f - float(y)) / 8.0f;
        const float r2 = sx * sx + sy * sy;
        if (r2 > 0.9f) continue;
        const glm::vec3 n(camera * glm::vec4(sx, sy, -std::sqrt(1.0f - r2), 0.0f));
        double u = std::atan2(double(n.y), double(n.x)) / (2.0 * std::numbers::pi);
        if (u < 0.0) u += 1.0;
        const double v = std::acos(-double(n.z)) / std::numbers::pi;
        const double a = u * 16.0, b = v * 8.0;
        // Not where rounding decides.
        if (std::abs(a - std::round(a)) < 1e-2 || std::abs(b - std::round(b)) < 1e-2) continue;
        const bool even = (int(std::floor(a)) + int(std::floor(b))) % 2 == 0;
        ASSERT_NEAR(image.at(x, y)[0], sky * (even ? 0.8f : 0.2f), 1e-3f) << x << ' ' << y;
        ++compared;
      }
    }
    EXPECT_GT(compared, 120);
  }
}

// Parameters other than the albedo: a texture of them gives each pixel what a constant gives all.
TEST_F(RenderedTexture, OfAnyParameterIsWhatItsConstantsAre) {
  const std::string ramp =
      exr("ramp", 4, 1, [](int x, int) { return glm::vec3(0.1f + 0.2f * float(x)); });
  const auto compare = [&](const auto& make) {
    SceneDescription d = square(make(textured_number(0)), 4);
    add_texture(d, texture_of(ramp));
    d.environment = {};
    d.lights = {PointLight{{2, 1, 3}, glm::vec3(30.0f)}};
    const Image all = rendered(build(d), {.spp = 4, .depth = 1});
    EXPECT_GT(mean_of(all), 1e-3);
    for (int x = 0; x < 4; ++x) {
      d.materials[0] = make(FloatInput(0.1f + 0.2f * float(x)));
      const Image one = rendered(build(d), {.spp = 4, .depth = 1});
      for (int y = 0; y < 4; ++y) {
        for (int c = 0; c < 3; ++c) {
          EXPECT_NEAR(all.at(x, y)[c], one.at(x, y)[c], 1e-5f * (1.0f + one.at(x, y)[c]));
        }
      }
    }
  };
  compare([](FloatInput x) {
    x.value *= 50.0f;
    return DiffuseMaterial{glm::vec3(0.5f), x};
  });
  compare([](const FloatInput& x) {
    ConductorMaterial m;
    m.alpha = {0.5f, 0.9f};
    m.alpha_scale = x;
    return m;
  });
  compare([](const FloatInput& x) {
    CoatedMaterial m;
    m.alpha = 0.9f;
    m.alpha_scale = x;
    return m;
  });
  for (auto PrincipledMaterial::*member :
       {&PrincipledMaterial::metallic, &PrincipledMaterial::alpha, &PrincipledMaterial::specular,
        &PrincipledMaterial::transmission, &PrincipledMaterial::coat,
        &PrincipledMaterial::coat_alpha}) {
    compare([&](const FloatInput& x) {
      PrincipledMaterial m;
      m.base_color = glm::vec3(0.8f, 0.4f, 0.2f);
      m.coat = 0.5f;
      m.*member = x;
      return m;
    });
  }
}

TEST_F(RenderedTexture, OfAMixesAmount) {
  SceneDescription d = square(MixMaterial{1, 2, textured_number(0)}, 4);
  add_texture(
      d, texture_of(exr("amount", 4, 1, [](int x, int) { return glm::vec3(float(x) / 3.0f); })));
  add_material(d, DiffuseMaterial{glm::vec3(0.1f)});
  add_material(d, DiffuseMaterial{glm::vec3(0.7f)});
  const Observed o = observe(build(std::move(d)), {.spp = 64});
  for (std::size_t i = 0; i < o.pixels.size(); ++i) {
    expect_mean(o.pixels[i], double(sky) * (0.1 + 0.6 * double(i % 4) / 3.0));
  }
}

}  // namespace
}  // namespace lockstep::test_render_textures
