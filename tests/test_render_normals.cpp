// Renders of maps that turn normals, against what a surface of that normal reflects.
#include "tests/t_square.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <numbers>

namespace lockstep::test_render_normals {
namespace {

constexpr float albedo = 0.5f;

// What a square of this normal reflects of unit light that comes from `towards`.
float reflected(glm::vec3 normal, glm::vec3 towards) {
  const float cosine = glm::dot(glm::normalize(normal), glm::normalize(towards));
  return albedo / float(std::numbers::pi) * std::max(cosine, 0.0f);
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
}  // namespace lockstep::test_render_normals
