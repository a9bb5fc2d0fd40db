// Renders of light from environment maps and textured emitters, and of what lenses and orthographic
// cameras see of light, against closed forms and quadrature.
#include "core/bsdf/metal.h"
#include "tests/t_images.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/mat3x3.hpp>

#include <array>
#include <cmath>

namespace lockstep::test_render_lights {
namespace {

using builtin::add_material;
using builtin::add_rectangle;

constexpr double pi_double = 3.14159265358979323846;
constexpr float albedo = 0.6f;

// Environment maps -------------------------------------------------------------------------------

// A direction in the map's frame, at a point of its square.
glm::dvec3 direction_at(Environment::Mapping mapping, double u, double v) {
  if (mapping == Environment::Mapping::LatLong) {
    const double phi = 2.0 * pi_double * u, theta = pi_double * v;
    return {-std::sin(theta) * std::sin(phi), std::cos(theta), std::sin(theta) * std::cos(phi)};
  }
  // Clarberg 2008, section 3.1, by cases: z falls with the square of the distance from the centre
  // of the upper half's diamond, the lower half is folded outwards.
  const double x = 2.0 * u - 1.0, y = 2.0 * v - 1.0, ax = std::abs(x), ay = std::abs(y);
  const bool lower = ax + ay > 1.0;
  const double s = lower ? 1.0 - ay : ax, t = lower ? 1.0 - ax : ay, r = s + t;
  const double phi = r > 0.0 ? 0.5 * pi_double * t / r : 0.0;
  const double z = 1.0 - r * r, ring = std::sqrt(1.0 - z * z);
  return {std::copysign(ring * std::cos(phi), x), std::copysign(ring * std::sin(phi), y),
          lower ? -z : z};
}

// Solid angle per area of the square.
double solid_angle_at(Environment::Mapping mapping, double v) {
  return mapping == Environment::Mapping::LatLong
             ? 2.0 * pi_double * pi_double * std::sin(pi_double * v)
             : 4.0 * pi_double;
}

// A map that is black but for one texel, away from the square's edges.
struct Spot {
  Environment::Mapping mapping;
  int width, height, x, y;
  glm::vec3 color{1.0f};

  // Of bilinear interpolation.
  double weight(double u, double v) const {
    const auto hat = [](double d) { return std::max(0.0, 1.0 - std::abs(d)); };
    return hat(u * width - 0.5 - x) * hat(v * height - 0.5 - y);
  }
  // The integral of f(direction) over the light it sends, in the map's frame.
  template <class F>
  double integral(F f) const {
    constexpr int steps = 200;
    double sum = 0.0;
    for (int j = 0; j < steps; ++j) {
      for (int i = 0; i < steps; ++i) {
        const double u = (x - 0.5 + 2.0 * (i + 0.5) / steps) / width;
        const double v = (y - 0.5 + 2.0 * (j + 0.5) / steps) / height;
        sum += weight(u, v) * solid_angle_at(mapping, v) * f(direction_at(mapping, u, v));
      }
    }
    return sum * 4.0 / (double(steps) * steps * width * height);
  }
};

constexpr Environment::Mapping lat_long = Environment::Mapping::LatLong;
constexpr Environment::Mapping octahedral = Environment::Mapping::EqualAreaOctahedral;

const Spot spots[] = {{lat_long, 16, 8, 5, 2},
                      {lat_long, 16, 8, 11, 4},
                      {octahedral, 16, 16, 9, 5},
                      {octahedral, 16, 16, 3, 12}};

class EnvironmentMaps : public TestWithImages {
 protected:
  Environment environment(const Spot& spot, const glm::mat3& to_world = glm::mat3(1.0f)) const {
    Environment e(glm::vec3(8.0f, 4.0f, 2.0f));
    e.mapping = spot.mapping;
    e.to_world = to_world;
    e.file = exr("spot", spot.width, spot.height, [&](int x, int y) {
      return x == spot.x && y == spot.y ? spot.color : glm::vec3(0.0f);
    });
    return e;
  }

  static glm::mat3 turned(float degrees, glm::vec3 axis) {
    return glm::mat3(glm::rotate(glm::mat4(1.0f), glm::radians(degrees), axis));
  }
};

// A square through the origin, facing along `normal`.
SceneDescription plane(const Material& material, glm::vec3 normal, glm::vec3 eye) {
  SceneDescription d;
  d.name = "plane";
  const glm::vec3 a = glm::normalize(glm::cross(normal, glm::vec3(0.3f, 0.8f, -0.5f)));
  add_rectangle(d, {0, 0, 0}, a, glm::cross(glm::normalize(normal), a), add_material(d, material));
  look_straight(d, eye, {0, 0, 0}, 1e-3f, 8, 8);
  return d;
}

// The camera looks along the middle of texels.
TEST_F(EnvironmentMaps, ShowEachTexelInItsDirection) {
  const auto color = [](int x, int y) {
    return glm::vec3(float(x + 1) / 8.0f, float(y + 1) / 16.0f, float((x * y) % 5) / 4.0f);
  };
  const glm::mat3 placements[] = {glm::mat3(1.0f), turned(35.0f, {1, 2, 3}),
                                  glm::mat3(2.0f) * turned(-80.0f, {0, 1, 1}),
                                  glm::mat3(glm::scale(glm::mat4(1.0f), {1, -1, 1}))};
  for (const auto& [mapping, side] : {std::pair{lat_long, 8}, {octahedral, 6}}) {
    for (const glm::mat3& to_world : placements) {
      SceneDescription d;
      d.environment = glm::vec3(1.0f, 2.0f, 3.0f);
      d.environment->mapping = mapping;
      d.environment->to_world = to_world;
      d.environment->file = exr("colors", side, 6, color);
      for (int y = 0; y < 6; ++y) {
        for (int x = 0; x < side; ++x) {
          const glm::vec3 local(direction_at(mapping, (x + 0.5) / side, (y + 0.5) / 6.0));
          look_straight(d, {0, 0, 0}, to_world * local, 1.0f, 4, 4);
          const Image image = rendered(build(d), {.spp = 1, .depth = 1});
          for (int c = 0; c < 3; ++c) {
            ASSERT_NEAR(image.at(1, 2)[c], float(c + 1) * color(x, y)[c], 2e-3f)
                << x << ' ' << y << ' ' << c;
          }
        }
      }
    }
  }
}

TEST_F(EnvironmentMaps, LightAPlaneAsTheirIrradianceSays) {
  for (const Spot& spot : spots) {
    const glm::vec3 local(
        direction_at(spot.mapping, (spot.x + 0.5) / spot.width, (spot.y + 0.5) / spot.height));
    for (const glm::mat3& to_world :
         {glm::mat3(1.0f), turned(50.0f, {1, -2, 1}), -turned(20.0f, {0, 1, 0})}) {
      const glm::vec3 centre = to_world * local;
      // Above the plane as a whole, and in part.
      for (const glm::vec3 tilt : {glm::vec3(0.3f, 0.1f, -0.2f), glm::vec3(5.0f, 1.0f, 0.5f)}) {
        const glm::vec3 normal = glm::normalize(centre + tilt);
        const glm::dvec3 n(glm::transpose(to_world) * normal);
        const double expected =
            double(albedo) / pi_double *
            spot.integral([&](const glm::dvec3& w) { return std::max(0.0, glm::dot(w, n)); });
        SceneDescription d = plane(DiffuseMaterial{glm::vec3(albedo)}, normal, 3.0f * normal);
        d.environment = environment(spot, to_world);
        const Scene scene = build(std::move(d));
        SCOPED_TRACE(std::to_string(&spot - spots));
        for (const int depth : {1, 2}) {
          expect_mean(observe(scene, {.spp = 64, .depth = depth}).mean, 8.0 * expected, 1e-3);
        }
        expect_mean(observe(scene, {.spp = 64}, 2).mean, 2.0 * expected, 1e-3);
      }
    }
  }
}

// Light sampling, BSDF sampling and both: metals of which each does best with another.
TEST_F(EnvironmentMaps, LightMetalsAsQuadratureSays) {
  for (const float alpha : {0.2f, 0.5f, 0.9f}) {
    ConductorMaterial metal;
    metal.alpha = glm::vec2(alpha);
    for (const Spot& spot : spots) {
      const glm::vec3 centre(
          direction_at(spot.mapping, (spot.x + 0.5) / spot.width, (spot.y + 0.5) / spot.height));
      const glm::vec3 normal(0, 0, 1);
      // Frames around z make no difference to an isotropic metal. Let the spot be above.
      const glm::vec3 up = glm::normalize(centre + glm::vec3(0.4f, 0.2f, 0.1f));
      const glm::vec3 x = glm::normalize(glm::cross(up, glm::vec3(0.1f, 1.0f, 0.3f)));
      const glm::mat3 to_local = glm::transpose(glm::mat3(x, glm::cross(up, x), up));
      const glm::vec3 wo = glm::normalize(glm::vec3(-0.3f, 0.4f, 0.8f));
      SceneDescription d = plane(metal, normal, 3.0f * wo);
      d.environment = environment(spot, to_local);
      const Scene scene = build(std::move(d));
      const auto bsdf = load_metal(scene.data().materials, std::int32_t(0));
      std::array<double, 3> expected{};
      for (std::size_t c = 0; c < 3; ++c) {
        expected[c] = spot.integral([&](const glm::dvec3& w) {
          const glm::vec3 wi = to_local * glm::vec3(w);
          return wi.z > 0.0f ? double(eval(bsdf, wo, wi).f_cos[int(c)]) : 0.0;
        });
      }
      SCOPED_TRACE(std::to_string(alpha) + ' ' + std::to_string(&spot - spots));
      expect_mean(observe(scene, {.spp = 64}, 0).mean, 8.0 * expected[0], 2e-3);
      expect_mean(observe(scene, {.spp = 64}, 1).mean, 4.0 * expected[1], 2e-3);
    }
  }
}

// Textured emission ------------------------------------------------------------------------------

class TexturedEmission : public TestWithImages {
 protected:
  // Half sizes 0.5 and 0.3 over the origin, two up, facing down. Textured: only paths find it.
  SceneDescription lamp_over(const Material& material, bool textured_lamp, bool sphere,
                             glm::vec3 eye) const {
    SceneDescription d;
    d.name = "lamp";
    add_rectangle(d, {0, 0, 0}, {0, 0, 3}, {3, 0, 0}, add_material(d, material));
    add_texture(d, texture_of(exr("constant", 2, 2, [](int, int) { return glm::vec3(0.5f); })));
    const ColorInput radiance =
        textured_lamp ? textured(0, glm::vec3(10.0f)) : ColorInput(glm::vec3(5.0f));
    const int black = add_material(d, DiffuseMaterial{glm::vec3(0.0f)});
    if (sphere) {
      builtin::add_sphere(d, {0.3f, 2, 0.2f}, 0.6f, black, Emission{radiance});
    } else {
      add_rectangle(d, {0, 2, 0}, {0.5f, 0, 0}, {0, 0, 0.3f}, black, Emission{radiance});
    }
    look_straight(d, eye, {0, 0, 0}, 1e-3f, 8, 8);
    return d;
  }
};

TEST_F(TexturedEmission, IsSeenAsItsTexelsFromItsSide) {
  const auto texels = [](int x, int y) { return glm::vec3(float(x), float(y), 1.0f); };
  for (const bool two_sided : {false, true}) {
    SceneDescription d;
    add_texture(d, texture_of(exr("texels", 4, 4, texels)));
    add_rectangle(d, {0, 0, 0}, {1, 0, 0}, {0, 1, 0},
                  add_material(d, DiffuseMaterial{glm::vec3(0.0f)}),
                  Emission{textured(0, glm::vec3(2.0f, 3.0f, 4.0f)), two_sided});
    set_uvs(d, 0);
    look_straight(d, {0, 0, 1}, {0, 0, 0}, 2.0f, 4, 4);
    const Image front = rendered(build(d), {.spp = 4, .depth = 1});
    look_straight(d, {0, 0, -1}, {0, 0, 0}, 2.0f, 4, 4);
    const Image back = rendered(build(d), {.spp = 4, .depth = 1});
    for (int y = 0; y < 4; ++y) {
      for (int x = 0; x < 4; ++x) {
        const glm::vec3 expected = glm::vec3(2.0f, 3.0f, 4.0f) * texels(x, y);
        for (int c = 0; c < 3; ++c) {
          ASSERT_FLOAT_EQ(front.at(x, y)[c], expected[c]);
          ASSERT_FLOAT_EQ(back.at(3 - x, y)[c], two_sided ? expected[c] : 0.0f);
        }
      }
    }
  }
}

// Light sampling of the constant lamp and paths that find the textured one by chance agree, for
// every model.
TEST_F(TexturedEmission, OfAConstantTextureLightsAsAConstantEmitter) {
  ConductorMaterial metal;
  metal.alpha = glm::vec2(0.3f);
  CoatedMaterial coated;
  coated.alpha = 0.3f;
  DielectricMaterial glass, sheet;
  glass.alpha = sheet.alpha = glm::vec2(0.3f);
  sheet.thin = true;
  PrincipledMaterial plastic, clear;
  plastic.coat = 0.5f;
  plastic.coat_alpha = 0.2f;
  clear.transmission = 0.8f;
  const Material materials[] = {DiffuseMaterial{glm::vec3(albedo)},
                                DiffuseMaterial{glm::vec3(albedo), 30.0f},
                                DiffuseTransmissionMaterial{glm::vec3(0.3f), glm::vec3(0.6f)},
                                metal,
                                coated,
                                glass,
                                sheet,
                                plastic,
                                clear};
  for (const Material& material : materials) {
    for (const bool sphere : {false, true}) {
      // From above, and from below where light passes.
      for (const glm::vec3 eye : {glm::vec3(-1, 2, 0), glm::vec3(0.3f, -2, 0.2f)}) {
        const auto mean = [&](bool textured_lamp) {
          const Scene scene = build(lamp_over(material, textured_lamp, sphere, eye));
          return observe(scene, {.spp = 64, .depth = 1, .seeds = 24}).mean;
        };
        const Moments constant = mean(false), found = mean(true);
        SCOPED_TRACE(std::to_string(&material - materials) + (sphere ? " sphere" : " rectangle") +
                     (eye.y < 0.0f ? " below" : " above"));
        EXPECT_GT(equal_means(constant, found, 2e-5 * constant.mean), level)
            << constant.mean << " +- " << std::sqrt(constant.mean_variance()) << ", " << found.mean
            << " +- " << std::sqrt(found.mean_variance());
        EXPECT_TRUE(eye.y < 0.0f || found.mean > 0.0);
      }
    }
  }
}

// Two texels light as two lamps; form factors as in test_path.cpp.
TEST_F(TexturedEmission, OfTwoTexelsLightsAsTwoLamps) {
  SceneDescription one, two;
  for (SceneDescription* d : {&one, &two}) {
    add_rectangle(*d, {0, 0, 0}, {0, 0, 3}, {3, 0, 0},
                  add_material(*d, DiffuseMaterial{glm::vec3(albedo)}));
    add_material(*d, DiffuseMaterial{glm::vec3(0.0f)});
    look_straight(*d, {-1, 2, 0}, {0, 0, 0}, 1e-3f, 8, 8);
  }
  add_texture(one, texture_of(exr("two", 2, 1, [](int x, int) { return glm::vec3(x ? 7 : 2); })));
  add_rectangle(one, {1, 1.5f, 0}, {1, 0, 0}, {0, 0, 0.5f}, 1, Emission{textured(0)});
  set_uvs(one, 1);
  add_rectangle(two, {0.5f, 1.5f, 0}, {0.5f, 0, 0}, {0, 0, 0.5f}, 1, Emission{glm::vec3(2.0f)});
  add_rectangle(two, {1.5f, 1.5f, 0}, {0.5f, 0, 0}, {0, 0, 0.5f}, 1, Emission{glm::vec3(7.0f)});
  const Plan plan{.spp = 128, .depth = 1, .seeds = 24};
  const Moments a = observe(build(std::move(one)), plan).mean;
  const Moments b = observe(build(std::move(two)), plan).mean;
  EXPECT_GT(equal_means(a, b, 2e-5 * b.mean), level) << a.mean << ' ' << b.mean;
}

// Lenses and orthographic cameras ----------------------------------------------------------------

// A small black square that shines at distance `z` before a camera that looks along +z.
SceneDescription lamp_before_camera(float z, float half_size) {
  SceneDescription d;
  d.name = "lamp before a camera";
  add_rectangle(d, {0, 0, z}, {0, half_size, 0}, {half_size, 0, 0},
                add_material(d, DiffuseMaterial{glm::vec3(0.0f)}), Emission{glm::vec3(5.0f)});
  d.camera.fov_degrees = 53.1301024f;  // as wide as half the distance to either side
  d.film.width = d.film.height = 24;
  return d;
}

// A lens of radius r, sharp at f, sees at distance z what lies within r |1 - z / f| of the
// pinhole's point there, uniformly. Each point of it sees the lamp's area over that of the image.
TEST(Lens, SpreadsALampOverTheCircleOfConfusion) {
  for (const float focus : {6.0f, 3.0f}) {
    const float z = 4.0f, radius = 3.6f, half_size = 0.3f;
    SceneDescription d = lamp_before_camera(z, half_size);
    d.camera.lens_radius = radius;
    d.camera.focal_distance = focus;
    const Scene scene = build(std::move(d));
    Moments mean, spread;
    for (int seed = 0; seed < 16; ++seed) {
      const Image image = rendered(scene, {.spp = 64, .depth = 1}, seed);
      const double pixel = double(z) / 24.0;
      const double reach = double(radius) * std::abs(1.0 - double(z / focus)) +
                           std::sqrt(2.0) * double(half_size) + pixel / std::sqrt(2.0);
      double sum = 0.0, moment = 0.0;
      for (int y = 0; y < 24; ++y) {
        for (int x = 0; x < 24; ++x) {
          const double dx = (x - 11.5) * pixel, dy = (y - 11.5) * pixel;
          const double value = double(image.at(x, y)[0]), r2 = dx * dx + dy * dy;
          ASSERT_TRUE(r2 < reach * reach || value == 0.0) << x << ' ' << y;
          sum += value, moment += value * r2;
        }
      }
      mean.add(sum / (24.0 * 24.0));
      // Rounding to the middles of pixels adds pixel^2 / 6 (Sheppard 1898).
      spread.add(moment / sum - pixel * pixel / 6.0);
    }
    const double lamp = double(2.0f * half_size), window = double(z);
    expect_mean(mean, 5.0 * lamp * lamp / (window * window));
    const double circle = double(radius) * (1.0 - double(z / focus));
    expect_mean(spread, 0.5 * circle * circle + lamp * lamp / 6.0, 3e-3);
  }
}

TEST(Lens, IsSharpWhereItIsInFocus) {
  SceneDescription d = lamp_before_camera(4.0f, 0.5f);  // from pixel 9 to 15
  const Image pinhole = rendered(build(d), {.spp = 16, .depth = 1});
  d.camera.lens_radius = 0.5f;
  d.camera.focal_distance = 4.0f;
  const Image lens = rendered(build(d), {.spp = 16, .depth = 1});
  for (int y = 0; y < 24; ++y) {
    for (int x = 0; x < 24; ++x) {
      const bool lit = x >= 9 && x < 15 && y >= 9 && y < 15;
      ASSERT_NEAR(pinhole.at(x, y)[0], lit ? 5.0f : 0.0f, 1e-4f) << x << ' ' << y;
      ASSERT_NEAR(lens.at(x, y)[0], pinhole.at(x, y)[0], 1e-4f) << x << ' ' << y;
    }
  }
}

// pi r^2 of the image's area, at any distance.
TEST(Orthographic, SeesASphereAtItsSize) {
  for (const float distance : {1.5f, 40.0f}) {
    for (const bool wide : {false, true}) {
      SceneDescription d;
      const glm::vec3 centre(0.3f, 0.2f, -0.1f);
      builtin::add_sphere(d, centre, 0.8f, add_material(d, DiffuseMaterial{glm::vec3(0.0f)}),
                          Emission{glm::vec3(5.0f)});
      const glm::vec3 away = glm::normalize(glm::vec3(1, 2, 2));
      look_straight(d, centre + distance * away, centre, 2.5f, wide ? 24 : 16, 16);
      const Scene scene = build(std::move(d));
      const double area = 2.5 * 2.5 * (wide ? 1.5 : 1.0);
      const double radius = double(0.8f);
      expect_mean(observe(scene, {.spp = 16, .depth = 1, .seeds = 32}).mean,
                  5.0 * pi_double * radius * radius / area);
      const Image image = rendered(scene, {.spp = 16, .depth = 1});
      for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
          const double pixel = 2.5 / 16.0;
          const double r = std::hypot((x + 0.5 - 0.5 * image.width) * pixel, (y - 7.5) * pixel);
          const float value = image.at(x, y)[0];
          ASSERT_TRUE(r < radius + pixel || value == 0.0f) << x << ' ' << y;
          ASSERT_TRUE(r > radius - pixel || value == 5.0f) << x << ' ' << y;
        }
      }
    }
  }
}

// A shift by a whole number of pixels moves the image by as many: the scene to the left for a shift
// to the right.
TEST(Orthographic, IsShiftedInUnitsOfTheShorterSide) {
  SceneDescription d = lamp_before_camera(4.0f, 0.5f);
  d.camera.projection = CameraDescription::Projection::Orthographic;
  d.camera.extent = 3.0f;  // 8 pixels per unit
  d.camera.shift = glm::vec2(4.0f / 24.0f, 2.0f / 24.0f);
  const Image image = rendered(build(d), {.spp = 4, .depth = 1});
  for (int y = 0; y < 24; ++y) {
    for (int x = 0; x < 24; ++x) {
      const bool lit = x >= 4 && x < 12 && y >= 10 && y < 18;
      ASSERT_NEAR(image.at(x, y)[0], lit ? 5.0f : 0.0f, 1e-4f) << x << ' ' << y;
    }
  }
}

}  // namespace
}  // namespace lockstep::test_render_lights
