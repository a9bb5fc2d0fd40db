// Footprints: their size and the levels of detail they give against closed forms, for coordinates
// of any kind, and equal bits at every width.
#include "core/texture_footprint.h"

#include "core/flatten.h"
#include "tests/t_texture.h"

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/trigonometric.hpp>

#include <limits>

namespace lockstep::test_texture_footprint {
namespace {

constexpr float infinite = std::numeric_limits<float>::infinity();
constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();

// What of a scene footprints depend on.
SceneData scene_with(const CameraDescription& camera, int width, int height) {
  FlatScene flat;
  flatten_camera(camera, {width, height, {}}, flat);
  SceneData scene;
  scene.camera = flat.camera;
  scene.features = flat.features;
  return scene;
}

float width_of_footprint(const SceneData& scene, glm::vec3 position, glm::vec3 normal) {
  return std::sqrt(footprint_width2<all_features>(scene, position, normal));
}

TEST(Footprint, OfAPerspectiveCameraGrowsWithDistance) {
  CameraDescription camera;
  camera.fov_degrees = 50.0f;
  const glm::vec3 eye(3.0f, -2.0f, 5.0f);
  // Cameras that mirror or scale space see the same.
  for (const glm::vec3 scale : {glm::vec3(1.0f), glm::vec3(-1.0f, 1.0f, 1.0f), glm::vec3(3.0f)}) {
    camera.camera_to_world = glm::scale(glm::translate(glm::mat4(1.0f), eye), scale);
    const SceneData scene = scene_with(camera, 300, 200);
    const double angle = 2.0 * std::tan(glm::radians(25.0)) / 200.0;
    for (const float distance : {1e-6f, 0.5f, 7.0f, 1e9f}) {
      for (const glm::vec3 direction : {glm::vec3(0, 0, 1), glm::vec3(0.6f, 0, -0.8f)}) {
        const float width = width_of_footprint(scene, eye + distance * direction, direction);
        const double rounding = 1e-6 + 1e-6 / double(distance);  // of the position
        EXPECT_NEAR(double(width) / (double(distance) * angle / 8.0), 1.0, rounding);
      }
    }
  }
}

TEST(Footprint, OfAnOrthographicCameraIsAConstant) {
  CameraDescription camera;
  camera.projection = CameraDescription::Projection::Orthographic;
  camera.extent = 6.0f;
  const SceneData scene = scene_with(camera, 300, 200);
  for (const glm::vec3 position : {glm::vec3(0.0f), glm::vec3(1e4f, 3.0f, -7.0f)}) {
    EXPECT_FLOAT_EQ(width_of_footprint(scene, position, {0, 0, -1}), 6.0f / 200.0f / 8.0f);
  }
}

// Seen under an angle it is longer, and never wider than a pixel.
TEST(Footprint, GrowsWithTheAngleUpToAPixel) {
  const SceneData scene = scene_with({}, 200, 200);
  const auto width = [&](float cosine) {
    const glm::vec3 normal(std::sqrt(1.0f - cosine * cosine), 0.0f, cosine);
    return width_of_footprint(scene, {0, 0, 4}, normal);
  };
  const float straight = width(1.0f);
  for (const float cosine : {0.9f, 0.5f, 0.2f}) {
    EXPECT_NEAR(width(cosine), straight / cosine, 1e-5f * straight / cosine);
    EXPECT_EQ(width(-cosine), width(cosine));
  }
  for (const float cosine : {0.12f, 1e-3f, 0.0f}) EXPECT_FLOAT_EQ(width(cosine), 8.0f * straight);
}

// The most that a u + b v changes over a step of `width` in any direction on the surface.
double largest_change(glm::dvec3 du, glm::dvec3 dv, double a, double b, double width) {
  const glm::dvec3 x = glm::normalize(du), y = glm::normalize(dv - x * glm::dot(x, dv));
  double largest = 0.0;
  for (int i = 0; i < 4096; ++i) {
    const double angle = 2.0 * 3.14159265358979 * i / 4096.0;
    const glm::dvec2 step(width * std::cos(angle), width * std::sin(angle));
    // step = u du + v dv in the frame of x and y.
    const double v = step.y / glm::dot(y, dv);
    const double u = (step.x - v * glm::dot(x, dv)) / glm::dot(x, du);
    largest = std::max(largest, std::abs(a * u + b * v));
  }
  return largest;
}

TEST(Footprint, OnTheTextureIsWhatItsOutlineCovers) {
  for (std::uint32_t i = 0; i < 200; ++i) {
    const glm::vec3 du = (uniform3(i, 21) - 0.5f) * std::exp2(10.0f * uniform2(i, 22).x - 5.0f);
    const glm::vec3 dv = (uniform3(i, 23) - 0.5f) * std::exp2(10.0f * uniform2(i, 24).x - 5.0f);
    const glm::vec3 across = glm::cross(du, dv);
    if (glm::length(across) < 0.1f * glm::length(du) * glm::length(dv)) continue;  // for rounding
    const float width = std::exp2(20.0f * uniform2(i, 25).x - 10.0f);
    const UvFootprint<float> f = uv_footprint(Vec3<float>(du), Vec3<float>(dv), width * width);
    for (const glm::dvec2 t : {glm::dvec2(1, 0), glm::dvec2(0, 1), glm::dvec2(0.7, -1.3)}) {
      const double change = std::sqrt(t.x * t.x * double(f.uu) + 2.0 * t.x * t.y * double(f.uv) +
                                      t.y * t.y * double(f.vv));
      const double expected = largest_change(du, dv, t.x, t.y, double(width));
      EXPECT_NEAR(change / expected, 1.0, 1e-4) << i;
    }
  }
}

TexelData sized(int width, int height) {
  TexelData t;
  t.width = width, t.height = height;
  return t;
}

float level_of_square(const UvTransform& t, float width, glm::vec3 du, glm::vec3 dv,
                      const TexelData& image = sized(64, 64)) {
  return level_of_detail(image, t, uv_footprint(Vec3<float>(du), Vec3<float>(dv), width * width));
}

TEST(Footprint, GivesTheLevelWhoseTexelsAreAsWide) {
  const glm::vec3 x(2, 0, 0), y(0, 0, 2);  // a texture two units wide, of 64 texels
  for (const float texels : {1.0f, 1.5f, 2.0f, 5.0f, 64.0f, 1000.0f}) {
    EXPECT_NEAR(level_of_square({}, texels / 32.0f, x, y), std::log2(texels), 1e-5f);
    // Of the side that has more of them.
    EXPECT_NEAR(level_of_square({}, texels / 32.0f, x, y, sized(8, 64)), std::log2(texels), 1e-5f);
    EXPECT_NEAR(level_of_square({}, texels / 32.0f, x, y, sized(64, 8)), std::log2(texels), 1e-5f);
    // Repeated four times along v; turned by 30 degrees, which changes nothing.
    UvTransform t;
    t.v_row.y = 4.0f;
    EXPECT_NEAR(level_of_square(t, texels / 128.0f, x, y), std::log2(texels), 1e-5f);
    t = {{0.8660254f, -0.5f}, {0.5f, 0.8660254f}, glm::vec2(3.0f)};
    EXPECT_NEAR(level_of_square(t, texels / 32.0f, x, y), std::log2(texels), 1e-5f);
  }
  for (const float texels : {0.99f, 0.1f, 0.0f}) {
    EXPECT_EQ(level_of_square({}, texels / 32.0f, x, y), 0.0f);
  }
}

TEST(Footprint, OfCoordinatesThatSpanNothingIsAPoint) {
  const glm::vec3 x(2, 0, 0), zero(0.0f);
  for (const auto& [du, dv] :
       {std::pair{zero, zero}, {x, zero}, {zero, x}, {x, x}, {x, -3.0f * x}}) {
    EXPECT_EQ(level_of_square({}, 10.0f, du, dv), 0.0f);
  }
}

TEST(Footprint, LevelsAreFiniteWhateverTheNumbers) {
  const SceneData scene = scene_with({}, 64, 64);
  const float odd[] = {0.0f,  1e-42f, 1e-30f,   1.0f,      -1e18f,
                       1e30f, 3e38f,  infinite, -infinite, not_a_number};
  for (const float a : odd) {
    for (const float b : odd) {
      for (const float c : odd) {
        const float width2 =
            footprint_width2<all_features>(scene, Vec3<float>(a, b, c), Vec3<float>(0, c, b));
        for (const float w2 : {width2, a}) {
          const auto f = uv_footprint(Vec3<float>(a, b, 0), Vec3<float>(0, a, c), w2);
          UvTransform t;
          t.u_row = {b, c};
          const float level = level_of_detail(sized(64, 64), t, f);
          ASSERT_TRUE(level >= 0.0f && level <= 64.0f) << a << ' ' << b << ' ' << c << ' ' << level;
        }
      }
    }
  }
}

class FootprintLookups : public Textures {
 protected:
  static UvFootprint<float> round(float texels, float size) {
    const float change = texels / size;
    return {change * change, 0.0f, change * change};
  }
};

// Below a texel exactly what bilinear gives; above it, what the level gives.
TEST_F(FootprintLookups, AreBilinearBelowATexel) {
  for (const Case& c : cases()) {
    ImageTexture t = texture_of(c), sharp = t;
    t.filter = TextureFilter::Trilinear;
    const TextureStore store({Texture(t), Texture(sharp)});
    const float size = float(std::max(c.reference.width, c.reference.height));
    for (std::uint32_t i = 0; i < 100; ++i) {
      const Vec2<float> uv = some_uv(i, 31);
      const Rgba<float> bilinear = lookup<float>(store.table(), 1, uv);
      for (const float texels : {0.0f, 0.3f, 0.999f}) {
        const auto found = lookup<float>(store.table(), 0, uv, round(texels, size));
        ASSERT_TRUE(same_value(found.r, bilinear.r) && same_value(found.g, bilinear.g) &&
                    same_value(found.b, bilinear.b) && same_value(found.a, bilinear.a))
            << c.name << ' ' << texels;
      }
      const auto above = lookup<float>(store.table(), 0, uv, round(3.0f, size));
      const auto level = lookup<float>(store.table(), 0, uv, std::log2(3.0f));
      EXPECT_NEAR(above.g, level.g, 1e-5f) << c.name;
      const auto other = lookup<float>(store.table(), 1, uv, round(3.0f, size));
      EXPECT_TRUE(same_value(other.g, bilinear.g)) << "bilinear images have no levels";
    }
  }
}

TEST_F(FootprintLookups, HaveTheSameBitsAtEveryWidth) {
  ImageTexture t = texture_of(cases()[0]);
  t.filter = TextureFilter::Trilinear;
  t.uv.u_row = {1.5f, 0.25f};
  const TextureStore store({Texture(t)});
  SceneData scenes[2] = {scene_with({}, 64, 64), scene_with({}, 64, 64)};
  scenes[1].features = bit(Feature::Orthographic);
  const auto found = [&]<class V>(const SceneData& scene, const Vec3<V>& position,
                                  const Vec3<V>& du, const Vec3<V>& dv, const Vec2<V>& uv) {
    const V width2 = footprint_width2<all_features>(scene, position, normalize(cross(du, dv)));
    return lookup(store.table(), 0, uv, uv_footprint(du, dv, width2));
  };
  for (const SceneData& scene : scenes) {
    for_each_width([&](auto width) {
      constexpr int W = width();
      using V = Float<W>;
      for (std::uint32_t first = 0; first < 480; first += W) {
        float v[11][W];
        for (int k = 0; k < W; ++k) {
          const std::uint32_t i = first + std::uint32_t(k);
          const float scale = std::exp2(24.0f * uniform2(i, 41).x - 4.0f);
          const glm::vec3 p = (uniform3(i, 42) - 0.5f) * scale, du = uniform3(i, 43) - 0.5f,
                          dv = i % 17 == 0 ? du : uniform3(i, 44) - 0.5f;
          const glm::vec2 uv = some_uv(i, 45);
          const float all[11] = {i % 19 == 0 ? not_a_number : p.x,
                                 p.y,
                                 p.z,
                                 du.x,
                                 du.y,
                                 du.z,
                                 dv.x,
                                 dv.y,
                                 dv.z,
                                 uv.x,
                                 uv.y};
          for (int j = 0; j < 11; ++j) v[j][k] = all[j];
        }
        const auto vec = [&](int j) {
          return Vec3<V>(load<V>(v[j]), load<V>(v[j + 1]), load<V>(v[j + 2]));
        };
        const Rgba<V> wide =
            found(scene, vec(0), vec(3), vec(6), Vec2<V>(load<V>(v[9]), load<V>(v[10])));
        for (int k = 0; k < W; ++k) {
          const auto one = [&](int j) { return Vec3<float>(v[j][k], v[j + 1][k], v[j + 2][k]); };
          const Rgba<float> narrow =
              found(scene, one(0), one(3), one(6), Vec2<float>(v[9][k], v[10][k]));
          ASSERT_TRUE(same_value(wide.r[k], narrow.r) && same_value(wide.a[k], narrow.a))
              << "W=" << W << " lane " << k;
        }
      }
    });
  }
}

}  // namespace
}  // namespace lockstep::test_texture_footprint
