// Renders of images that are filtered over the footprint of a pixel. Squares of one texel average
// to 1/2 at every level above the whole image, so what is left of their contrast tells the level.
#include "core/features.h"
#include "tests/t_square.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <functional>

namespace lockstep::test_render_trilinear {
namespace {

using builtin::add_material;
using builtin::add_sphere;

constexpr int texels = 64;  // along both sides of the image
constexpr int side = 8;     // of renders, in pixels

// What a scene shows with this texture, between 0 and 1 in every pixel.
using View = std::function<std::vector<double>(const ImageTexture&)>;
// How many texels the footprint covers in the middle of a pixel.
using PixelNumber = std::function<double(int x, int y)>;

class RenderedTrilinear : public TestWithImages {
 protected:
  ImageTexture checks(TextureFilter filter, glm::vec2 repeats) const {
    ImageTexture t = texture_of(exr("checks", texels, texels, check), filter);
    t.uv = {{repeats.x, 0.0f}, {0.0f, repeats.y}, {0.137f, 0.071f}};
    return t;
  }
  static glm::vec3 check(int x, int y) { return glm::vec3((x + y) % 2 == 0 ? 0.0f : 1.0f); }

  // That of the contrast that bilinear lookups have there is left what the level leaves.
  void expect_footprint(const View& view, glm::vec2 repeats, const PixelNumber& covered) const {
    const std::vector<double> sharp = view(checks(TextureFilter::Bilinear, repeats));
    const std::vector<double> found = view(checks(TextureFilter::Trilinear, repeats));
    double contrast = 0.0;
    for (int y = 0; y < side; ++y) {
      for (int x = 0; x < side; ++x) {
        const auto at = std::size_t(y * side + x);
        const double level = std::clamp(std::log2(covered(x, y)), 0.0, 1.0);
        EXPECT_NEAR(found[at] - 0.5, (1.0 - level) * (sharp[at] - 0.5), 1e-3)
            << x << ' ' << y << " at level " << level;
        contrast += std::abs(sharp[at] - 0.5) / (side * side);
      }
    }
    EXPECT_GT(contrast, 0.02) << "grey says little";
  }

  static std::vector<double> reds(const Image& image, float white) {
    std::vector<double> values;
    for (std::size_t i = 0; i < image.pixels.size(); i += 3) {
      values.push_back(double(image.pixels[i] / white));
    }
    return values;
  }

  // The scene's first shape with the texture: as the albedo of what it reflects of the sky, or as
  // what it emits.
  static View shown(SceneDescription d, bool glows) {
    return [d, glows](const ImageTexture& texture) mutable {
      d.textures = {texture};
      if (glows) {
        d.materials[0] = DiffuseMaterial{glm::vec3(0.0f)};
        d.shapes[0].emission = Emission{textured(0, glm::vec3(sky))};
        d.environment.reset();
      } else {
        d.materials[0] = DiffuseMaterial{textured(0)};
      }
      sample_centres(d);
      return reds(rendered(build(d), {.spp = 1, .depth = 1}), sky);
    };
  }
};

// A pixel is 1/4 wide, a footprint 1/32, a texel 1/32 without repeats.
TEST_F(RenderedTrilinear, LevelsOfAnOrthographicCamera) {
  for (const glm::vec2 repeats : {glm::vec2(0.93f, 0.71f), glm::vec2(1.3713f, 1.1f),
                                  glm::vec2(0.6f, 1.77f), glm::vec2(2.34f, 0.9f)}) {
    for (const bool glows : {false, true}) {
      expect_footprint(shown(square({}), glows), repeats,
                       [&](int, int) { return double(std::max(repeats.x, repeats.y)); });
    }
  }
}

// Where the ray through the middle of a pixel meets z = 0.
glm::dvec3 point_on_square(glm::dvec3 eye, const glm::mat4& to_world, double fov, int x, int y) {
  const double half = std::tan(0.5 * fov);
  const glm::dvec3 local(half * (2.0 * (x + 0.5) / side - 1.0),
                         half * (1.0 - 2.0 * (y + 0.5) / side), 1.0);
  const glm::dvec3 d = glm::dmat3(glm::mat3(to_world)) * local;
  return eye - d * (eye.z / d.z);
}

TEST_F(RenderedTrilinear, LevelsOfAPerspectiveCamera) {
  for (const auto& [eye, degrees] : {std::pair{glm::vec3(0, 0, 3), 12.0f},
                                     {glm::vec3(1.8f, 0, 1.2f), 12.0f},
                                     {glm::vec3(0, -4, 0.4f), 1.6f}}) {
    SceneDescription d = square({});
    const double fov = glm::radians(double(degrees));
    d.camera = {};
    d.camera.camera_to_world = builtin::look_at(eye, {0, 0, 0});
    d.camera.fov_degrees = degrees;
    const double angle = 2.0 * std::tan(0.5 * fov) / side;
    const auto covered = [&, eye = eye](double repeats, int x, int y) {
      const glm::dvec3 view =
          point_on_square(eye, d.camera.camera_to_world, fov, x, y) - glm::dvec3(eye);
      const double distance = glm::length(view), cosine = std::abs(view.z) / distance;
      return angle * distance / 8.0 / std::max(cosine, 0.125) * repeats * texels / 2.0;
    };
    // One and a half texels in the middle.
    const double repeats = 1.5 / covered(1.0, side / 2, side / 2);
    for (const bool glows : {false, true}) {
      expect_footprint(shown(d, glows), {float(repeats), 0.73f * float(repeats)},
                       [&](int x, int y) { return covered(repeats, x, y); });
    }
  }
}

TEST_F(RenderedTrilinear, LevelsOfASphere) {
  SceneDescription d = square({});
  d.shapes.clear();
  add_sphere(d, {0, 0, 0}, 1.0f, 0);
  look_straight(d, {2.4f, 1.8f, 0}, {0, 0, 0}, 0.02f, side, side);
  const double width = 0.02 / side / 8.0, around = 2.0 * 3.14159265358979 / texels;
  for (const auto& [u, v] : {std::pair{1.4, 0.9}, {0.7, 1.6}}) {
    for (const bool glows : {false, true}) {
      expect_footprint(shown(d, glows),
                       {float(u * around / width), float(v * 0.5 * around / width)},
                       [&, u = u, v = v](int, int) { return std::max(u, v); });
    }
  }
}

// Stretched to twice its width, half of it in the image.
TEST_F(RenderedTrilinear, LevelsOfAnInstance) {
  SceneDescription d = square({});
  d.objects.push_back({{d.shapes[0]}});
  d.shapes.clear();
  const glm::mat4 stretched = glm::scale(glm::mat4(1.0f), {2.0f, 1.0f, 1.0f});
  d.instances = {{0, stretched}, {0, glm::translate(glm::mat4(1.0f), {0, 0, 90})}};
  ASSERT_TRUE(build(d).features() & bit(Feature::Instances));
  expect_footprint(shown(d, false), {2.9f, 1.2f}, [](int, int) { return 1.45; });
}

// In a mirror behind the camera, seven units away: it is the straight way to the camera that
// counts.
TEST_F(RenderedTrilinear, LevelsInAMirror) {
  SceneDescription d = square({});
  d.environment.reset();
  add_material(d, ConductorMaterial{.alpha = glm::vec2(0.0f)});
  builtin::add_rectangle(d, {0, 0, 5}, {0, 9, 0}, {9, 0, 0}, 1);
  d.camera = {};
  d.camera.camera_to_world = builtin::look_at({0, 0, 3}, {0, 0, 9});
  d.camera.fov_degrees = 12.0f;
  sample_centres(d);
  const View view = [&](const ImageTexture& texture) {
    const auto with = [&](ColorInput radiance) {
      SceneDescription lit = d;
      lit.textures = {texture};
      lit.shapes[0].emission = Emission{radiance};
      return rendered(build(lit), {.spp = 1, .depth = 2});
    };
    const Image textured_square = with(textured(0)), white = with(glm::vec3(1.0f));
    std::vector<double> values;
    for (std::size_t i = 0; i < white.pixels.size(); i += 3) {
      values.push_back(double(textured_square.pixels[i] / white.pixels[i]));
    }
    return values;
  };
  const double half = std::tan(glm::radians(6.0));
  const auto covered = [&](double repeats, int x, int y) {
    const glm::dvec2 p = 7.0 * half * (2.0 * (glm::dvec2(x, y) + 0.5) / double(side) - 1.0);
    const double distance2 = 9.0 + glm::dot(p, p);  // over the cosine, 3 / distance
    return 2.0 * half / side * distance2 / 3.0 / 8.0 * repeats * texels / 2.0;
  };
  const double repeats = 1.5 / covered(1.0, side / 2, side / 2);
  expect_footprint(view, {float(repeats), 0.6f * float(repeats)},
                   [&](int x, int y) { return covered(repeats, x, y); });
}

// The slope of the shading normal along x from two lights, within [-1/2, 1/2].
TEST_F(RenderedTrilinear, LevelsOfSurfaceMaps) {
  const std::string normals = exr("normals", texels, texels, [](int x, int y) {
    return glm::vec3(0.5f + 0.3f * (2.0f * check(x, y).x - 1.0f), 0.5f, 0.9f);
  });
  for (const bool bumps : {true, false}) {
    const View view = [&](ImageTexture texture) {
      SceneDescription d = square(DiffuseMaterial{glm::vec3(0.5f)});
      d.environment.reset();
      sample_centres(d);
      if (bumps) {
        d.materials[0].bump = textured_number(0, 0.01f);
      } else {
        texture.file = normals;
        d.materials[0].normal_map = 0;
      }
      d.textures = {texture};
      const auto lit_from = [&](float x) {
        d.lights = {DistantLight{-glm::normalize(glm::vec3(x, 0, 1)), glm::vec3(1.0f)}};
        return rendered(build(d), {.spp = 1, .depth = 1});
      };
      const Image left = lit_from(-1.0f), right = lit_from(1.0f);
      std::vector<double> values;
      for (std::size_t i = 0; i < left.pixels.size(); i += 3) {
        const double a = double(left.pixels[i]), b = double(right.pixels[i]);
        values.push_back(0.5 + 0.5 * (b - a) / (b + a));
      }
      return values;
    };
    expect_footprint(view, {1.41f, 1.23f}, [](int, int) { return 1.41; });
  }
}

// The share of a mix's second part is that of the lookup.
TEST_F(RenderedTrilinear, LevelsOfAMixesAmount) {
  SceneDescription d = square(MixMaterial{1, 2, textured_number(0)});
  add_material(d, DiffuseMaterial{glm::vec3(0.0f)});
  add_material(d, DiffuseMaterial{glm::vec3(1.0f)});
  sample_centres(d);
  const glm::vec2 repeats(1.3713f, 1.1f);
  const std::vector<double> sharp =
      shown(square({}), false)(checks(TextureFilter::Bilinear, repeats));
  add_texture(d, checks(TextureFilter::Trilinear, repeats));
  const Observed o = observe(build(d), {.spp = 64});
  const double level = std::log2(double(repeats.x));
  for (std::size_t i = 0; i < sharp.size(); ++i) {
    expect_mean(o.pixels[i], double(sky) * (0.5 + (1.0 - level) * (sharp[i] - 0.5)), 2e-3);
  }
}

// Texels far smaller than a pixel: single samples of it scatter over all their values where they
// are not filtered.
TEST_F(RenderedTrilinear, AFarPlaneIsGrey) {
  SceneDescription d = square(DiffuseMaterial{textured(0)}, 32);
  d.camera = {};
  d.camera.camera_to_world = builtin::look_at({0.3f, 0.2f, 400}, {0, 0, 0});
  d.camera.fov_degrees = 0.28f;
  const auto statistics = [&](TextureFilter filter) {
    d.textures = {checks(filter, {29.0f, 29.0f})};
    const Image image = rendered(build(d), {.sampler = "random", .spp = 1, .depth = 1});
    Moments m;
    for (std::size_t i = 0; i < image.pixels.size(); i += 3) m.add(double(image.pixels[i] / sky));
    return m;
  };
  const Moments sharp = statistics(TextureFilter::Bilinear);
  const Moments filtered = statistics(TextureFilter::Trilinear);
  // Bilinear weights are uniform: the value is 1/2 + (1/2 - s) (2 t - 1), of variance 1/36.
  EXPECT_GT(mean_is(sharp, 0.5), significance);
  EXPECT_NEAR(sharp.variance(), 1.0 / 36.0, 0.2 / 36.0);
  EXPECT_NEAR(filtered.mean, 0.5, 1e-4);
  EXPECT_LT(filtered.variance(), 1e-8);
}

// Opacity is looked up in the whole image, so nothing else pays for it.
TEST_F(RenderedTrilinear, OpacityHasNoFootprint) {
  Image images[2];
  for (const TextureFilter filter : {TextureFilter::Bilinear, TextureFilter::Trilinear}) {
    Material lace = DiffuseMaterial{glm::vec3(0.0f)};
    lace.opacity = textured_number(0);
    SceneDescription d = square(lace);
    add_texture(d, checks(filter, {2.3f, 2.9f}));
    const Scene scene = build(std::move(d));
    EXPECT_FALSE(scene.features() & bit(Feature::Trilinear));
    images[int(filter == TextureFilter::Trilinear)] = rendered(scene, {});
  }
  EXPECT_TRUE(same_bytes(images[0], images[1]));
  EXPECT_GT(mean_of(images[0]), 0.1);
}

// However deep it is in other textures, and only where something refers to it.
TEST_F(RenderedTrilinear, IsAFeatureWhereAnImageIsUsed) {
  const auto has = [](const SceneDescription& d) {
    return (build(d).features() & bit(Feature::Trilinear)) != 0;
  };
  for (const TextureFilter filter : {TextureFilter::Bilinear, TextureFilter::Trilinear}) {
    const bool trilinear = filter == TextureFilter::Trilinear;
    SceneDescription d = square(DiffuseMaterial{textured(2)});
    d.textures = {MixTexture{glm::vec3(0.1f), glm::vec3(0.2f), textured_number(1)},
                  checks(filter, {1, 1}), CheckerboardTexture{glm::vec3(1.0f), textured(0), {}}};
    EXPECT_EQ(has(d), trilinear);
    d.materials[0] = DiffuseMaterial{};
    EXPECT_FALSE(has(d)) << "an image that nothing shows";
    d.materials[0].normal_map = 1;
    EXPECT_EQ(has(d), trilinear);
    d.materials[0] = DiffuseMaterial{};
    d.shapes[0].emission = Emission{textured(0)};
    EXPECT_EQ(has(d), trilinear);
    add_material(d, DiffuseMaterial{textured(1)});
    d.shapes[0].emission.reset();
    EXPECT_FALSE(has(d)) << "a material that nothing has";
  }
}

}  // namespace
}  // namespace lockstep::test_render_trilinear
