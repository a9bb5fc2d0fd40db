// Renders of surfaces with holes: what is seen and lit through them.
#include "tests/t_square.h"

#include <gtest/gtest.h>

namespace lockstep::test_render_opacity {
namespace {

using builtin::add_material;
using builtin::add_rectangle;

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

}  // namespace
}  // namespace lockstep::test_render_opacity
