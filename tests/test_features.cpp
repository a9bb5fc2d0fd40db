// Kernels without the code that a scene does not need: chosen where they fit, and the same images.
#include "packets/feature_sets.h"
#include "packets/kernel.h"
#include "tests/t_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <random>
#include <set>

namespace lockstep::test_features {
namespace {

Scene small(const char* name, Isa isa) { return build(resized(read_scene(name), 37, 23), isa); }

struct Expected {
  const char* scene;
  FeatureMask kernel;
};
constexpr Expected by_scene[] = {
    {"cornell", quad_lit}, {"meadow", sky_lit}, {"reef", interior}, {"spheres", all_features}};

TEST(Features, ScenesRunOnTheSmallestKernelThatServesThem) {
  for (const Isa isa : available_isas()) {
    for (const auto& [scene, features] : by_scene) {
      const FeatureMask present = small(scene, isa).features();
      const Kernel& kernel = find_kernel(isa, 0, present);
      EXPECT_EQ(kernel.features, features) << scene;
      EXPECT_EQ(kernel.width, default_width(isa));
      EXPECT_EQ(present & ~kernel.features, 0u) << scene;
      // Widths other than the default one have the general kernel only.
      for (const int width : {1, 4, 8, 16}) {
        if (width == default_width(isa)) continue;
        EXPECT_EQ(find_kernel(isa, width, present).features, all_features);
      }
    }
  }
}

// Sets of features, ever smaller ones among them, find a kernel that has them all, and none that
// has more than needed.
TEST(Features, NoKernelLacksAFeature) {
  const FeatureMask sets[] = {quad_lit, sky_lit, interior, all_features};
  for (const Isa isa : available_isas()) {
    std::minstd_rand random(1);
    for (int i = 0; i < 1 << 14; ++i) {
      FeatureMask present = FeatureMask(random()) & all_features;
      for (int halvings = i % 6; halvings > 0; --halvings) present &= FeatureMask(random() >> 3);
      const FeatureMask found = find_kernel(isa, 0, present).features;
      ASSERT_EQ(present & ~found, 0u);
      for (const FeatureMask set : sets) {
        if ((present & ~set) == 0) {
          ASSERT_LE(std::popcount(found), std::popcount(set));
        }
      }
    }
  }
}

TEST(Features, SpecialisedKernelsGiveTheSameBytes) {
  for (const Isa isa : available_isas()) {
    for (const char* name : {"cornell", "meadow", "reef"}) {
      const Scene scene = small(name, isa);
      for (const char* sampler : {"owen", "rcs"}) {
        RenderSettings s;
        s.seed = 8;
        s.spp = 5;
        s.depth = 4;
        s.roulette_depth = 2;
        s.threads = 2;
        s.isa = isa;
        ASSERT_TRUE(s.specialized);
        const RenderResult special = render(scene, parse_sampler(sampler), s);
        s.specialized = false;
        const RenderResult general = render(scene, parse_sampler(sampler), s);
        EXPECT_TRUE(same_bytes(special.image, general.image)) << name << ' ' << sampler;
        EXPECT_EQ(special.stats.rays.bounce, general.stats.rays.bounce);
        EXPECT_EQ(special.stats.rays.shadow, general.stats.rays.shadow);
        EXPECT_GT(mean_of(special.image), 0.0) << "black images say little";
      }
    }
  }
}

TEST(Features, PresentAndAbsentOnesTogetherAreAll) {
  const std::vector<std::string> all = feature_names(all_features);
  EXPECT_EQ(all.size(), feature_count);
  EXPECT_EQ(std::set(all.begin(), all.end()).size(), feature_count);
  for (const auto& [scene, kernel] : by_scene) {
    const FeatureMask present = small(scene, choose_isa()).features();
    EXPECT_NE(present, 0u);
    std::vector<std::string> names = feature_names(present);
    const auto absent = feature_names(all_features & ~present);
    names.insert(names.end(), absent.begin(), absent.end());
    EXPECT_TRUE(std::is_permutation(names.begin(), names.end(), all.begin(), all.end())) << scene;
  }
}

TEST(Features, AreThoseOfTheScene) {
  using enum Feature;
  const auto features = [](SceneDescription d) { return build(std::move(d)).features(); };
  const FeatureMask cornell = features(builtin::make_cornell());
  EXPECT_TRUE(cornell & bit(Diffuse) && cornell & bit(QuadLights));
  EXPECT_FALSE(cornell & feature_set(Spheres, Conductor, Coated, Environment, TriangleLights,
                                     SphereLights, LightChoice));
  SceneDescription more = builtin::make_cornell();
  builtin::add_sphere(more, {0, 1, 0}, 0.1f, builtin::add_material(more, ConductorMaterial{}));
  EXPECT_EQ(features(more), cornell | feature_set(Spheres, Conductor));
  more.environment = glm::vec3(0.1f);
  EXPECT_EQ(features(more), cornell | feature_set(Spheres, Conductor, Environment, LightChoice));
}

}  // namespace
}  // namespace lockstep::test_features
