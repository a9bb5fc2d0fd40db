// Renders of single materials compared with closed forms.
#include "tests/t_images.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <cmath>

namespace lockstep::test_render_materials {
namespace {

using builtin::add_material;
using builtin::add_rectangle;
using builtin::add_sphere;

constexpr double pi_double = 3.14159265358979323846;

// Slabs and sheets -------------------------------------------------------------------------------

double normal_reflectance(double eta) { return std::pow((eta - 1.0) / (eta + 1.0), 2.0); }

// Unpolarised, from outside (Born and Wolf 1999, section 1.5.2).
double fresnel_reflectance(double cos_i, double eta) {
  const double cos_t = std::sqrt(1.0 - (1.0 - cos_i * cos_i) / (eta * eta));
  const double s = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
  const double p = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
  return 0.5 * (s * s + p * p);
}

int black(SceneDescription& d) { return add_material(d, DiffuseMaterial{glm::vec3(0.0f)}); }

constexpr float wall_radiance = 3.0f;

// A black wall in z = `z` that shines towards +z or, if turned, towards -z.
void add_wall(SceneDescription& d, float z, bool turned = false) {
  const glm::vec3 a(50, 0, 0), b(0, 50, 0);
  add_rectangle(d, {0, 0, z}, turned ? b : a, turned ? a : b, black(d),
                Emission{glm::vec3(wall_radiance)});
}

// A slab of glass between z = 0 and z = -thickness, seen along its normal.
SceneDescription slab(const DielectricMaterial& glass, float thickness) {
  SceneDescription d;
  d.name = "slab";
  const int m = add_material(d, glass);
  add_rectangle(d, {0, 0, 0}, {50, 0, 0}, {0, 50, 0}, m);
  add_rectangle(d, {0, 0, -thickness}, {0, 50, 0}, {50, 0, 0}, m);
  look_straight(d, {0, 0, 1}, {0, 0, 0}, 1.0f, 8, 8);
  return d;
}

// T = (1 - R)^2 a / (1 - R^2 a^2) of the light passes and R + R a T is reflected, where a = exp(-
// sigma d) is left after one crossing: the geometric series of reflections inside.
TEST(Slab, PassesAndReflectsTheSumOfAllReflectionsInside) {
  DielectricMaterial glass;
  glass.eta = 2.5f;
  glass.absorption = {0.0f, 0.4f, 1.5f};
  const float thickness = 0.7f;
  SceneDescription behind = slab(glass, thickness), before = behind;
  add_wall(behind, -3.0f);
  add_wall(before, 2.0f, true);
  const Scene through = build(std::move(behind)), back = build(std::move(before));
  const double r = normal_reflectance(2.5);
  for (int c = 0; c < 3; ++c) {
    const double a = std::exp(-double(glass.absorption[c]) * double(thickness));
    const double t = (1.0 - r) * (1.0 - r) * a / (1.0 - r * r * a * a);
    const Plan plan{.spp = 32, .depth = 30};
    expect_mean(observe(through, plan, c).mean, double(wall_radiance) * t);
    expect_mean(observe(back, plan, c).mean, double(wall_radiance) * (r + r * a * t));
  }
}

TEST(Slab, ScalesWhatItReflectsAndWhatItPasses) {
  DielectricMaterial glass;
  glass.eta = 2.0f;
  glass.reflectance = glm::vec3(1.0f, 0.5f, 0.0f);
  glass.transmittance = glm::vec3(0.8f, 1.0f, 0.5f);
  SceneDescription d = slab(glass, 1.0f);
  add_wall(d, -3.0f);
  const Scene scene = build(std::move(d));
  for (int c = 0; c < 3; ++c) {
    const double r = double(glass.reflectance.value[c]) / 9.0;
    const double t = double(glass.transmittance.value[c]) * 8.0 / 9.0;
    expect_mean(observe(scene, {.spp = 64, .depth = 30}, c).mean,
                double(wall_radiance) * t * t / (1.0 - r * r));
  }
}

// Russian roulette must not take what refraction takes from radiance for darkness.
TEST(Slab, KeepsItsMeanUnderRoulette) {
  SceneDescription d = slab(DielectricMaterial{.eta = 2.0f}, 1.0f);
  add_wall(d, -3.0f);
  const Scene scene = build(std::move(d));
  RenderSettings s = settings_of({.spp = 256, .depth = 40});
  s.roulette_depth = 1;
  const RenderResult r = render(scene, parse_sampler("owen"), s);
  const double t = 8.0 / 9.0 * 8.0 / 9.0 / (1.0 - 1.0 / 81.0);
  EXPECT_NEAR(mean_of(r.image), double(wall_radiance) * t, 1e-2);
  // Weights stay 1: no path ends by chance, each reflected one but for those inside by leaving.
  s.roulette_depth = 1000;
  EXPECT_EQ(render(scene, parse_sampler("owen"), s).stats.rays.bounce, r.stats.rays.bounce);
}

// R + T^2 R / (1 - R^2) = 2 R / (1 + R), with R under the angle of view.
TEST(Sheet, PassesAndReflectsTheSumOfAllReflectionsInside) {
  DielectricMaterial glass;
  glass.thin = true;
  glass.absorption = glm::vec3(9.0f);  // of a sheet: none
  for (const float degrees : {0.0f, 40.0f, 75.0f}) {
    const double angle = double(degrees) * pi_double / 180.0;
    const double r = fresnel_reflectance(std::cos(angle), 1.5);
    for (const bool through : {false, true}) {
      SCOPED_TRACE(std::to_string(degrees) + (through ? " passed" : " reflected"));
      SceneDescription d;
      add_rectangle(d, {0, 0, 0}, {2, 0, 0}, {0, 2, 0}, add_material(d, glass));
      through ? add_wall(d, -1.0f) : add_wall(d, 2.0f, true);
      const glm::vec3 eye(float(std::sin(angle)), 0.0f, float(std::cos(angle)));
      look_straight(d, eye, {0, 0, 0}, 0.1f, 8, 8);
      const double share = through ? (1.0 - r) / (1.0 + r) : 2.0 * r / (1.0 + r);
      expect_mean(observe(build(std::move(d)), {.spp = 32, .depth = 2}).mean,
                  double(wall_radiance) * share);
    }
  }
}

// Light that leaves the denser medium spreads over a larger solid angle: (1 - R) L / eta^2. The
// wall is no larger than what a ray refracted by Snell's law needs to meet it.
TEST(Boundary, RefractsAndDividesRadianceByTheSquareOfTheIndex) {
  for (const float eta : {1.5f, 0.8f}) {
    for (const float degrees : {0.0f, 30.0f, 50.0f}) {
      SCOPED_TRACE(std::to_string(eta) + ", " + std::to_string(degrees));
      const double angle = double(degrees) * pi_double / 180.0;
      const double sin_t = std::sin(angle) / double(eta);
      SceneDescription d;
      add_rectangle(d, {0, 0, 0}, {2, 0, 0}, {0, 2, 0}, add_material(d, DielectricMaterial{eta}));
      const auto shift = float(-sin_t / std::sqrt(1.0 - sin_t * sin_t));
      add_rectangle(d, {shift, 0, -1}, {0.004f, 0, 0}, {0, 0.004f, 0}, black(d),
                    Emission{glm::vec3(wall_radiance)});
      const glm::vec3 eye(float(std::sin(angle)), 0.0f, float(std::cos(angle)));
      look_straight(d, eye, {0, 0, 0}, 0.002f, 8, 8);
      const double r = fresnel_reflectance(std::cos(angle), double(eta));
      expect_mean(observe(build(std::move(d)), {.spp = 32}).mean,
                  double(wall_radiance) * (1.0 - r) / double(eta * eta));
    }
  }
}

// A point light under water over a grey ground: both the way to the ground and the shadow ray are
// dimmed. Media without a boundary to see leave no noise.
TEST(Absorption, DimsCameraPathsAndShadowRays) {
  DielectricMaterial water;
  water.eta = 1.0f;
  water.absorption = {0.0f, 0.3f, 1.2f};
  const float depth = 1.5f, height = 0.8f;
  SceneDescription d = slab(water, 40.0f);
  add_rectangle(d, {0, 0, -depth}, {9, 0, 0}, {0, 9, 0},
                add_material(d, DiffuseMaterial{glm::vec3(0.5f)}));
  d.lights = {PointLight{{0, 0, -depth + height}, glm::vec3(2.0f)}};
  look_straight(d, {0, 0, 1}, {0, 0, 0}, 1e-3f, 4, 4);
  const Image image = rendered(build(std::move(d)), {.spp = 1, .depth = 2});
  for (int c = 0; c < 3; ++c) {
    const double a = std::exp(-double(water.absorption[c]) * double(depth + height));
    const double expected = 0.5 / pi_double * 2.0 / double(height * height) * a;
    EXPECT_NEAR(channel_mean(image, c), expected, 1e-4 * expected);
  }
}

// Rough glass too knows in which medium it sends light: a lamp in its interior is dimmed by the way
// there, whether light sampling or chance finds it.
TEST(Absorption, DimsLightFromWithin) {
  DielectricMaterial glass;
  glass.alpha = glm::vec2(0.4f);
  glass.absorption = {0.0f, 0.5f, 2.0f};
  const float distance = 1.5f;
  SceneDescription d = slab(glass, 40.0f);
  // All ways to a small lamp under the point in view are of one length.
  add_rectangle(d, {0, 0, -distance}, {0.02f, 0, 0}, {0, 0.02f, 0}, black(d),
                Emission{glm::vec3(1000.0f)});
  look_straight(d, {0.5f, 0, 1}, {0, 0, 0}, 1e-3f, 4, 4);
  const Scene scene = build(std::move(d));
  const Plan plan{.spp = 64, .depth = 1, .seeds = 32};
  const double clear = observe(scene, plan, 0).mean.mean;
  ASSERT_GT(clear, 0.1);
  for (const int c : {1, 2}) {
    const double a = std::exp(-double(glass.absorption[c]) * double(distance));
    EXPECT_NEAR(observe(scene, plan, c).mean.mean / clear, a, 1e-3 * a);
  }
}

class Matched : public TestWithImages {};

// Bodies of index 1 and sheets of it let all light through as it came.
TEST_F(Matched, MediaAreInvisible) {
  SceneDescription d;
  d.environment.emplace();
  d.environment->mapping = Environment::Mapping::LatLong;
  d.environment->file = exr("sky", 64, 32, [](int x, int y) {
    return glm::vec3(0.5f + 0.4f * std::sin(float(x)), float(y % 3), 1.0f);
  });
  d.camera.camera_to_world = builtin::look_at({0, 0, 3}, {0, 0, 0});
  d.camera.fov_degrees = 60.0f;
  const Image expected = rendered(build(resized(d, 16, 16)), {.spp = 4, .depth = 1});
  for (const bool thin : {false, true}) {
    DielectricMaterial nothing;
    nothing.eta = 1.0f;
    nothing.thin = thin;
    SceneDescription with = d;
    const int m = add_material(with, nothing);
    add_sphere(with, {0.5f, 0, 0}, 0.8f, m);
    builtin::add_mesh(with, builtin::icosphere(1), m);
    const Image found = rendered(build(resized(with, 16, 16)), {.spp = 4, .depth = 8});
    for (std::size_t i = 0; i < found.pixels.size(); ++i) {
      ASSERT_NEAR(found.pixels[i], expected.pixels[i], 2e-4f) << i / 3;
    }
  }
}

// Mixes and sides --------------------------------------------------------------------------------

// A square in z = 0, facing +z, in an environment of radiance 2: a diffuse one shows twice its
// albedo.
SceneDescription square(int material_of_square, std::vector<Material> materials) {
  SceneDescription d;
  d.name = "square";
  d.materials = std::move(materials);
  add_rectangle(d, {0, 0, 0}, {2, 0, 0}, {0, 2, 0}, material_of_square);
  look_straight(d, {0, 0, 3}, {0, 0, 0}, 1.0f, 8, 8);
  d.environment = glm::vec3(2.0f);
  return d;
}

DiffuseMaterial grey(float reflectance) { return {glm::vec3(reflectance)}; }

TEST(Mix, HasTheMeanOfItsPartsAlbedos) {
  for (const float amount : {0.0f, 0.2f, 0.9f, 1.0f}) {
    // 0.1 and 0.5; that and 1 by a quarter.
    const std::vector<Material> materials{grey(0.1f), grey(0.5f), MixMaterial{0, 1, amount},
                                          grey(1.0f), MixMaterial{2, 3, 0.25f}};
    const double mix = 0.1 + 0.4 * double(amount), nested = 0.75 * mix + 0.25;
    for (const char* sampler : {"owen", "cpt"}) {
      SCOPED_TRACE(sampler + (' ' + std::to_string(amount)));
      const Plan plan{.sampler = sampler, .spp = 32};
      expect_every_pixel(observe(build(square(2, materials)), plan), 2.0 * mix);
      expect_every_pixel(observe(build(square(4, materials)), plan), 2.0 * nested);
    }
  }
}

// Parts of other kinds: a share of the light passes a sheet, the rest is reflected diffusely.
TEST(Mix, OfGlassAndADiffuseMaterial) {
  DielectricMaterial sheet;
  sheet.thin = true;
  sheet.eta = 1.0f;
  SceneDescription d = square(2, {grey(0.4f), sheet, MixMaterial{0, 1, 0.3f}});
  d.environment.reset();
  add_rectangle(d, {0, 0, 5}, {0, 9, 0}, {9, 0, 0}, 0, Emission{glm::vec3(1.0f)});  // unseen light
  add_wall(d, -1.0f);
  SceneDescription alone = d;
  alone.shapes[0].material = 0;
  const Plan plan{.spp = 64, .depth = 1, .seeds = 32};
  const double diffuse = observe(build(std::move(alone)), plan).mean.mean;
  EXPECT_GT(diffuse, 0.1);
  expect_mean(observe(build(std::move(d)), plan).mean, 0.7 * diffuse + 0.3 * double(wall_radiance),
              2e-3);
}

TEST(OneSided, HasABlackBackAndAnOrdinaryFront) {
  Material material = grey(0.6f);
  material.two_sided = false;
  for (const bool back : {false, true}) {
    SceneDescription d = square(0, {material});
    if (back) look_straight(d, {0, 0, -3}, {0, 0, 0}, 1.0f, 8, 8);
    for (const int depth : {1, 3}) {
      const Observed o = observe(build(d), {.depth = depth, .seeds = 4});
      expect_every_pixel(o, back ? 0.0 : 2.0 * double(0.6f));
    }
    d.materials[0].two_sided = true;
    expect_every_pixel(observe(build(d), {.seeds = 4}), 2.0 * double(0.6f));
  }
}

// It still is in the way of light, from both sides.
TEST(OneSided, CastsShadows) {
  Material material = grey(0.6f);
  material.two_sided = false;
  for (const bool turned : {false, true}) {
    SceneDescription d = square(0, {grey(0.5f), material});
    const glm::vec3 a(1, 0, 0), b(0, 1, 0);
    add_rectangle(d, {0, 3, 3}, turned ? b : a, turned ? a : b, 1);
    d.environment.reset();
    d.lights = {PointLight{{0, 6, 6}, glm::vec3(50.0f)}};
    EXPECT_EQ(observe(build(d), {.seeds = 1}).mean.mean, 0.0);
  }
}

}  // namespace
}  // namespace lockstep::test_render_materials
