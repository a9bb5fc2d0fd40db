// Renders of textures on surfaces, of holes in them and of maps that turn their normals, against
// closed forms.
#include "tests/t_square.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include <cmath>

namespace lockstep {
namespace {

using builtin::add_material;
using builtin::add_rectangle;

constexpr double pi_double = 3.14159265358979323846;

// Every pixel of one render, in which there is no noise.
void expect_pixels(const Scene& scene, const PixelFunction& expected, float tolerance = 1e-4f) {
  const Image image = rendered(scene, {.spp = 4, .depth = 1});
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const glm::vec3 e = expected(x, y);
      for (int c = 0; c < 3; ++c) {
        ASSERT_NEAR(image.at(x, y)[c], e[c], tolerance) << x << ' ' << y << ' ' << c;
      }
    }
  }
}

glm::vec3 texels(int x, int y) {
  return {float(1 + (3 * x + 5 * y) % 7) / 8.0f, float(1 + (x + 2 * y) % 5) / 6.0f, 0.5f};
}

// Images -----------------------------------------------------------------------------------------

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
        double u = std::atan2(double(n.y), double(n.x)) / (2.0 * pi_double);
        if (u < 0.0) u += 1.0;
        const double v = std::acos(-double(n.z)) / pi_double;
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

// Opacity ----------------------------------------------------------------------------------------

constexpr float wall_radiance = 3.0f;

// A black square with holes in z = 0, before a wall that shines towards it.
SceneDescription lattice(FloatInput opacity, float cutoff = 0.0f) {
  Material black = DiffuseMaterial{glm::vec3(0.0f)};
  black.opacity = opacity;
  black.opacity_cutoff = cutoff;
  SceneDescription d = square(black);
  d.environment.reset();
  const int solid = add_material(d, DiffuseMaterial{glm::vec3(0.0f)});
  add_rectangle(d, {0, 0, -1}, {9, 0, 0}, {0, 9, 0}, solid, Emission{glm::vec3(wall_radiance)});
  return d;
}

class Opacity : public TestWithImages {};

TEST_F(Opacity, IsTheShareOfCameraRaysThatEnd) {
  for (const float opacity : {0.0f, 0.25f, 0.9f}) {
    const Scene scene = build(lattice(opacity));
    for (const char* sampler : {"random", "owen"}) {
      expect_mean(observe(scene, {.sampler = sampler, .spp = 64}).mean,
                  (1.0 - double(opacity)) * double(wall_radiance));
    }
  }
}

// A floor under a lamp with a lattice between them: 3/4 of the light of the lamp alone, which a
// shadow ray finds at one interaction and a path at two.
TEST_F(Opacity, IsTheShareOfShadowRaysThatEnd) {
  for (const bool sphere : {false, true}) {
    SceneDescription d;
    const int grey = add_material(d, DiffuseMaterial{glm::vec3(0.5f)});
    const int black = add_material(d, DiffuseMaterial{glm::vec3(0.0f)});
    Material holes = DiffuseMaterial{glm::vec3(0.0f)};
    holes.opacity = 0.25f;
    const int lace = add_material(d, holes);
    add_rectangle(d, {0, 0, 0}, {5, 0, 0}, {0, 5, 0}, grey);
    add_rectangle(d, {0, 0, 4}, {0, 0.5f, 0}, {0.5f, 0, 0}, black, Emission{glm::vec3(20.0f)});
    look_straight(d, {-3, 0, 3}, {0, 0, 0}, 0.01f, 8, 8);
    const Plan plan{.spp = 64, .seeds = 24};
    const double open = observe(build(d), plan).mean.mean;
    ASSERT_GT(open, 0.1);
    if (sphere) {  // around the lamp: rays leave it once
      builtin::add_sphere(d, {0, 0, 4}, 1.0f, lace);
    } else {
      add_rectangle(d, {0, 0, 2}, {0, 1, 0}, {1, 0, 0}, lace);
    }
    for (const int depth : {1, 2}) {
      Plan with = plan;
      with.depth = depth;
      expect_mean(observe(build(d), with).mean, 0.75 * open, 1e-3);
    }
  }
}

TEST_F(Opacity, WithACutoffIsAllOrNothing) {
  CheckerboardTexture checks;  // one pixel each
  checks.even = glm::vec3(0.6f), checks.odd = glm::vec3(0.4f);
  checks.uv = {{8.0f, 0.0f}, {0.0f, 8.0f}, glm::vec2(0.0f)};
  SceneDescription d = lattice(textured_number(0), 0.5f);
  add_texture(d, checks);
  const Scene scene = build(std::move(d));
  for (const char* sampler : {"owen", "random", "cpt"}) {
    const Image image = rendered(scene, {.sampler = sampler, .spp = 16});
    for (int y = 0; y < 8; ++y) {
      for (int x = 0; x < 8; ++x) {
        ASSERT_EQ(image.at(x, y)[0], (x + y) % 2 == 0 ? 0.0f : wall_radiance) << x << ' ' << y;
      }
    }
  }
}

// Exactly the cutoff is there; constants count too.
TEST_F(Opacity, AtTheCutoffIsThere) {
  EXPECT_EQ(mean_of(rendered(build(lattice(0.5f, 0.5f)), {})), 0.0);
  EXPECT_EQ(mean_of(rendered(build(lattice(0.49f, 0.5f)), {})), double(wall_radiance));
}

TEST_F(Opacity, ComesFromTheChannelItNames) {
  PngImage rgba{8, 1, 4, 8, {}};
  for (int x = 0; x < 8; ++x) {
    for (const int v : {0, 255, 0, x % 2 * 255}) rgba.values.push_back(std::uint16_t(v));
  }
  FloatInput alpha = textured_number(0);
  alpha.channel = 3;
  for (const float cutoff : {0.0f, 0.5f}) {
    SceneDescription d = lattice(alpha, cutoff);
    add_texture(d, texture_of(png("alpha", rgba)));
    const Image image = rendered(build(std::move(d)), {});
    for (int x = 0; x < 8; ++x) EXPECT_EQ(image.at(x, 3)[0], x % 2 ? 0.0f : wall_radiance);
  }
}

// Normals ----------------------------------------------------------------------------------------

constexpr float albedo = 0.5f;

// What a square of this normal reflects of unit light that comes from `towards`.
float reflected(glm::vec3 normal, glm::vec3 towards) {
  const float cosine = glm::dot(glm::normalize(normal), glm::normalize(towards));
  return albedo / float(pi_double) * std::max(cosine, 0.0f);
}

const glm::vec3 lights_from[] = {{0, 0, 1}, {1, 0, 1},  {-1, 0, 1},
                                 {0, 1, 1}, {0, -1, 1}, {0.5f, 0.3f, 1}};

class Normals : public TestWithImages {
 protected:
  SceneDescription square_with(const Material& material, Texture texture) const {
    SceneDescription d = square(material, 4);
    add_texture(d, std::move(texture));
    d.environment.reset();
    return d;
  }
  // That the square looks as one of this normal, from the front or from behind.
  static void expect_normal(SceneDescription d, glm::vec3 normal, float tolerance = 1e-5f,
                            float side = 1.0f) {
    look_straight(d, {0, 0, 3.0f * side}, {0, 0, 0}, 1.8f, 4, 4);
    for (const glm::vec3 from : lights_from) {
      const glm::vec3 towards = side * from;
      d.lights = {DistantLight{-glm::normalize(towards), glm::vec3(1.0f)}};
      SCOPED_TRACE(std::to_string(towards.x) + ' ' + std::to_string(towards.y));
      expect_pixels(
          build(d), [&](int, int) { return glm::vec3(reflected(side * normal, towards)); },
          tolerance);
    }
  }
  ImageTexture normal_map(glm::vec3 normal) const {
    return texture_of(exr("normal", 2, 2, [&](int, int) { return 0.5f + 0.5f * normal; }));
  }
  static Material mapped(float scale = 1.0f) {
    Material m = DiffuseMaterial{glm::vec3(albedo)};
    m.normal_map = 0;
    m.normal_scale = scale;
    return m;
  }
};

TEST_F(Normals, OfAFlatMapChangeNothing) {
  expect_normal(square_with(mapped(), normal_map({0, 0, 1})), {0, 0, 1});
}

TEST_F(Normals, OfAMapHaveXAlongUAndYAgainstV) {
  const glm::vec3 n = glm::normalize(glm::vec3(0.3f, 0.2f, 1.0f));
  SceneDescription d = square_with(mapped(), normal_map(n));
  for (const float side : {1.0f, -1.0f}) expect_normal(d, n, 1e-5f, side);
  auto& uvs = std::get<TriangleMesh>(d.shapes[0].geometry).uvs;
  for (glm::vec2& uv : uvs) uv.x = 3.0f - 2.0f * uv.x;  // u to the left
  expect_normal(d, {-n.x, n.y, n.z});
  for (glm::vec2& uv : uvs) uv = {uv.y, uv.x};  // u down, v to the left
  expect_normal(d, {n.y, -n.x, n.z});
  // Coordinates that do not span the surface give no direction but that of the normal.
  for (glm::vec2& uv : uvs) uv = glm::vec2(0.5f);
  d.textures[0] = normal_map({0, 0, 1});
  expect_normal(d, {0, 0, 1});
}

TEST_F(Normals, OfAMapAreScaled) {
  const glm::vec3 n = glm::normalize(glm::vec3(0.3f, 0.2f, 1.0f));
  expect_normal(square_with(mapped(0.5f), normal_map(n)), {0.5f * n.x, 0.5f * n.y, n.z});
}

TEST_F(Normals, OfATextureProgramAreItsColours) {
  CheckerboardTexture checks;
  checks.even = glm::vec3(0.7f, 0.5f, 0.9f), checks.odd = checks.even;
  expect_normal(square_with(mapped(), checks), {0.4f, 0.0f, 0.8f});
}

// Heights that rise along u or v, on a square two wide: half as steep as the texture.
TEST_F(Normals, OfARampAreThoseOfATiltedSquare) {
  for (const bool along_u : {true, false}) {
    ImageTexture ramp = texture_of(
        exr("ramp", 8, 8, [&](int x, int y) { return glm::vec3(float(along_u ? x : y) / 8.0f); }),
        TextureFilter::Bilinear);
    ramp.wrap_u = ramp.wrap_v = TextureWrap::Clamp;
    for (const float height : {0.5f, -1.0f}) {
      Material m = DiffuseMaterial{glm::vec3(albedo)};
      m.bump = textured_number(0, height);
      const float slope = 0.5f * height;
      // Between the middles of the outer texels.
      SceneDescription d = square_with(m, ramp);
      for (glm::vec2& uv : std::get<TriangleMesh>(d.shapes[0].geometry).uvs) {
        uv = 0.25f + 0.5f * uv;
      }
      // Half of the texture on the square: half as steep again.
      const glm::vec3 n = along_u ? glm::vec3(-0.5f * slope, 0, 1) : glm::vec3(0, 0.5f * slope, 1);
      expect_normal(d, n, 1e-3f);
      expect_normal(d, n, 1e-3f, -1.0f);
    }
  }
}

TEST_F(Normals, OfAConstantHeightChangeNothing) {
  Material m = DiffuseMaterial{glm::vec3(albedo)};
  m.bump = textured_number(0, 5.0f);
  expect_normal(square_with(m, normal_map({0.2f, 0.4f, 0.6f})), {0, 0, 1});
}

// On a sphere u runs to the east and v to the north, so y points south.
TEST_F(Normals, OfAMapOnASphere) {
  const glm::vec3 n = glm::normalize(glm::vec3(0.3f, 0.2f, 1.0f));
  SceneDescription d = square_with(mapped(), normal_map(n));
  d.shapes.clear();
  builtin::add_sphere(d, {0, 0, 0}, 1.0f, 0);
  look_straight(d, {3, 0, 0}, {0, 0, 0}, 0.002f, 4, 4);
  for (const glm::vec3 towards :
       {glm::vec3(1, 1, 0), glm::vec3(1, -1, 0), glm::vec3(1, 0, 1), glm::vec3(1, 0, -1)}) {
    d.lights = {DistantLight{-glm::normalize(towards), glm::vec3(1.0f)}};
    // At +x: east is +y, north +z.
    expect_pixels(
        build(d),
        [&](int, int) {
          return glm::vec3(reflected({n.z, n.x, -n.y}, towards));
        },
        1e-3f);
  }
}

}  // namespace
}  // namespace lockstep
