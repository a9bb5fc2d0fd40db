// The path integrator in furnaces: closed bodies in which every order of reflection is known, and
// Russian roulette in them. Random estimates are compared by t-tests over renders with independent
// seeds.
#include "tests/t_path.h"

#include <gtest/gtest.h>

namespace lockstep::test_path {
namespace {

using builtin::add_material;
using builtin::add_sphere;

TEST(Furnace, AWhiteConvexBodyUnderAWhiteSkyIsInvisible) {
  const Scene scene = build(builtin::make_furnace());
  for (const int depth : {1, 2, 8}) {
    for (const char* sampler : {"random", "cpt"}) {
      RenderSettings s;
      s.spp = 8;
      s.depth = depth;
      const Image image = render(scene, parse_sampler(sampler), s).image;
      for (const float x : image.pixels) ASSERT_NEAR(x, 1.0f, 2e-5f) << depth;
    }
  }
}

TEST(Furnace, AConvexBodyScattersOnceAtEveryDepth) {
  SceneDescription d = builtin::make_furnace();
  d.materials[0] = DiffuseMaterial{glm::vec3(0.8f, 0.5f, 0.0f)};
  d.environment = glm::vec3(2.0f, 3.0f, 4.0f);
  look_closely(d, {0, 0, 4}, {0, 0, 1});
  const Scene scene = build(std::move(d));
  for (const int depth : {1, 3}) {
    const PathPlan plan{.spp = 4, .depth = depth, .seeds = 2};
    EXPECT_NEAR(channel_means(scene, plan, 0).mean, 1.6, 1e-4);
    EXPECT_NEAR(channel_means(scene, plan, 1).mean, 1.5, 1e-4);
    EXPECT_EQ(channel_means(scene, plan, 2).mean, 0.0);
  }
}

// Everywhere inside a closed body of emission L and albedo a the radiance is L (1 + a + a^2 + ...),
// with one term more than interactions are lit.
double partial_sum(double emission, double albedo, int depth) {
  double sum = 0.0;
  for (int i = depth; i >= 0; --i) sum = sum * albedo + emission;
  return sum;
}

SceneDescription closed_sphere(float emission, float albedo) {
  SceneDescription d;
  d.name = "closed sphere";
  const int wall = add_material(d, DiffuseMaterial{glm::vec3(albedo)});
  add_sphere(d, {1, 2, 3}, 2.5f, wall, Emission{glm::vec3(emission)});
  std::get<Sphere>(d.shapes[0].geometry).emits_inwards = true;
  look_closely(d, {1.3f, 1.6f, 2.8f}, {5, 4, 1});
  return d;
}

TEST(Furnace, InsideASphereEveryDepthAddsATerm) {
  for (const float albedo : {0.0f, 0.5f, 0.9f}) {
    const Scene scene = build(closed_sphere(0.7f, albedo));
    for (const int depth : {1, 2, 3, 6}) {
      const PathPlan plan{.spp = 32, .depth = depth, .seeds = 16};
      // Uniform sampling of the sphere's area has no variance here, but for diffuse bounces.
      expect_mean(channel_means(scene, plan), partial_sum(0.7, double(albedo), depth), 1e-4);
    }
  }
}

TEST(Furnace, InsideABoxEveryDepthAddsATerm) {
  for (const bool split : {false, true}) {
    const Scene scene = build(closed_box(0.7f, 0.6f, split));
    EXPECT_EQ(scene.data().lights.count, split ? 12 : 6);
    for (const int depth : {1, 2, 3, 5}) {
      const PathPlan plan{.spp = 16, .depth = depth};
      expect_mean(channel_means(scene, plan), partial_sum(0.7, 0.6, depth));
    }
  }
}

TEST(Furnace, EverySamplerFindsTheSameSum) {
  const Scene scene = build(closed_box(0.7f, 0.6f));
  for (const char* sampler : {"owen", "cpt", "rcs", "rcs:weight=0.3", "rcs:offset=fresh"}) {
    const PathPlan plan{.sampler = sampler, .spp = 8, .depth = 3, .seeds = 64};
    expect_mean(channel_means(scene, plan), partial_sum(0.7, 0.6, 3));
  }
}

TEST(Roulette, KeepsTheMean) {
  const Scene box = build(closed_box(0.7f, 0.6f));
  for (const int roulette_depth : {1, 2, 4, 100}) {
    const PathPlan plan{.spp = 32, .depth = 8, .roulette_depth = roulette_depth, .seeds = 64};
    expect_mean(channel_means(box, plan), partial_sum(0.7, 0.6, 8));
  }
  for (const auto& make : {builtin::make_cornell, builtin::make_spheres}) {
    const Scene scene = build(resized(make(), 24, 18));
    const auto means = [&](int roulette_depth) {
      return channel_means(scene,
                           {.spp = 48, .depth = 5, .roulette_depth = roulette_depth, .seeds = 40});
    };
    const Moments without = means(100), with = means(1);
    EXPECT_GT(equal_means(with, without), level) << with.mean << ' ' << without.mean;
  }
}

TEST(Roulette, EndsPaths) {
  const Scene scene = build(closed_box(0.7f, 0.3f));
  RenderSettings s;
  s.depth = 1000;
  s.spp = 4;
  s.roulette_depth = 1;
  const RenderResult r = render(scene, parse_sampler("random"), s);
  EXPECT_LT(r.stats.rays.bounce, 2 * r.stats.paths);  // 0.3 / 0.7 of them are expected
  EXPECT_NEAR(mean_of(r.image), 0.7 / (1.0 - 0.3), 0.05);
}

// A black lamp of radius r in the middle of a hollow sphere of radius R and albedo a. With
// f = (r / R)^2 every point of the wall receives E = pi L f from the lamp, and sees the wall itself
// with a share 1 - f of its cosine-weighted hemisphere: order i adds a^i L f (1 - f)^(i - 1).
TEST(Depth, EachInteractionIsLitOnceMore) {
  for (const double r : {0.5, 1.2}) {
    SceneDescription d;
    d.name = "integrating sphere";
    add_sphere(d, {0, 0, 0}, 2, add_material(d, DiffuseMaterial{glm::vec3(0.8f)}));
    add_sphere(d, {0, 0, 0}, float(r), lamp(d), Emission{glm::vec3(3.0f)});
    look_closely(d, {-1.5f, 0.5f, 0}, {-1.6f, -0.5f, 1.2f});
    const Scene scene = build(std::move(d));
    const double f = r * r / 4.0;
    double expected = 0.0, term = 0.8 * 3.0 * f;
    for (int depth = 1; depth <= 6; ++depth) {
      expected += term;
      term *= 0.8 * (1.0 - f);
      if (depth == 5) continue;
      expect_mean(channel_means(scene, {.spp = 64, .depth = depth}), expected, 2e-3);
    }
  }
}

}  // namespace
}  // namespace lockstep::test_path
