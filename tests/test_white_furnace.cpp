// Materials that lose nothing are invisible in an environment of radiance 1.
#include "tests/t_images.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <cmath>

namespace lockstep::test_white_furnace {
namespace {

using builtin::add_material;
using builtin::add_rectangle;
using builtin::add_sphere;

constexpr double pi_double = 3.14159265358979323846;

// A body of a material that loses nothing is invisible in an environment of radiance 1.
class WhiteFurnace : public TestWithImages {
 protected:
  SceneDescription description(const Material& material, bool mesh, bool map) const {
    SceneDescription d;
    d.name = "white furnace";
    const int white = add_material(d, material);
    if (mesh) {
      builtin::add_mesh(d, builtin::icosphere(2), white);
    } else {
      add_sphere(d, {0, 0, 0}, 1.0f, white);
    }
    look_straight(d, {0, 0, 3}, {0, 0, 0}, 2.1f, 8, 8);
    d.environment = glm::vec3(1.0f);
    if (map) {
      d.environment->mapping = Environment::Mapping::LatLong;
      d.environment->file = exr("ones", 8, 4, [](int, int) { return glm::vec3(1.0f); });
    }
    return d;
  }

  template <class F>
  void for_each_body(const Material& material, F f) const {
    for (const bool mesh : {false, true}) {
      for (const bool map : {false, true}) {
        SCOPED_TRACE(std::string(mesh ? "mesh" : "sphere") + (map ? ", map" : ", constant"));
        f(build(description(material, mesh, map)));
      }
    }
  }
  // `lost`: the share of the light that may be missing.
  void expect_invisible(const Material& material, const Plan& plan, double lost = 0.0) const {
    for_each_body(material, [&](const Scene& scene) {
      expect_every_pixel(observe(scene, plan), 1.0, 1e-4 + lost);
    });
  }
};

TEST_F(WhiteFurnace, OfLambertsModel) {
  for (const int depth : {1, 3}) {
    expect_invisible(DiffuseMaterial{glm::vec3(1.0f)}, {.spp = 16, .depth = depth, .seeds = 12});
  }
}

// Without a real part of the index all is reflected.
TEST_F(WhiteFurnace, OfAMirror) {
  ConductorMaterial mirror;
  mirror.eta = glm::vec3(0.0f);
  mirror.k = glm::vec3(1.0f);
  mirror.alpha = glm::vec2(0.0f);
  expect_invisible(mirror, {.spp = 4, .depth = 1, .seeds = 4});
}

// What single scattering at alpha 0.8 loses is put back.
TEST_F(WhiteFurnace, OfRoughMetalIsWholeWhereCompensated) {
  ConductorMaterial metal;
  metal.eta = glm::vec3(0.0f);
  metal.k = glm::vec3(1.0f);
  metal.alpha = glm::vec2(0.8f);
  for (const bool compensated : {false, true}) {
    SceneDescription d = description(metal, false, false);
    d.compensate_microfacets = compensated;
    const Observed o = observe(build(d), {.spp = 64, .depth = 1, .seeds = 4});
    if (compensated) {
      EXPECT_NEAR(o.mean.mean, 1.0, 0.01);
    } else {
      EXPECT_LT(o.mean.mean, 0.9);
    }
  }
}

// The same of rough glass on the way in and out, of a sheet, and of a coat and what is under it.
TEST_F(WhiteFurnace, OfRoughGlassAndCoatsIsWholeWhereCompensated) {
  DielectricMaterial glass, sheet;
  glass.alpha = sheet.alpha = glm::vec2(0.5f);
  sheet.thin = true;
  CoatedMaterial coat;
  coat.diffuse = glm::vec3(1.0f);
  coat.alpha = 0.5f;
  PrincipledMaterial clear;
  clear.alpha = 0.5f;
  clear.transmission = 1.0f;
  for (const Material& material :
       {Material(glass), Material(sheet), Material(coat), Material(clear)}) {
    SCOPED_TRACE(material.model.index());
    for (const bool compensated : {false, true}) {
      SceneDescription d = description(material, false, false);
      d.compensate_microfacets = compensated;
      const Observed o = observe(build(d), {.spp = 64, .depth = 128, .seeds = 4});
      if (compensated) {
        EXPECT_NEAR(o.mean.mean, 1.0, 0.01);
      } else {
        EXPECT_LT(o.mean.mean, 0.97);
      }
    }
  }
}

// Smooth surfaces lose nothing: the option leaves the scene as it is.
TEST_F(WhiteFurnace, OfSmoothGlassNeedsNoCompensation) {
  SceneDescription d = description(DielectricMaterial{}, false, false);
  const std::uint64_t without = build(d).fingerprint();
  d.compensate_microfacets = true;
  const Scene scene = build(d);
  EXPECT_EQ(scene.fingerprint(), without);
  EXPECT_FALSE(scene.features() & bit(Feature::Compensation));
  EXPECT_EQ(scene.data().materials.boundary_albedo, nullptr);
}

// Every sample that leaves has weight 1, and total reflection keeps some in a polyhedron for long.
TEST_F(WhiteFurnace, OfSmoothGlass) {
  DielectricMaterial glass;
  for (const float eta : {1.1f, 1.5f, 2.4f}) {
    glass.eta = eta;
    SCOPED_TRACE(eta);
    for_each_body(glass, [](const Scene& scene) {
      for (const float x : rendered(scene, {.spp = 16, .depth = 1000}).pixels) {
        ASSERT_NEAR(x, 1.0f, 1e-4f);
      }
    });
  }
}

TEST_F(WhiteFurnace, OfAThinSheetOfGlass) {
  DielectricMaterial glass;
  glass.thin = true;
  for (const float alpha : {0.0f, 0.1f}) {
    glass.alpha = glm::vec2(alpha);
    // A rough sheet loses what one facet sends to another.
    expect_invisible(glass, {.spp = 16, .depth = 64, .seeds = 12}, alpha > 0.0f ? 0.03 : 0.0);
  }
}

// A simulation of chords in a sphere, which knows of no directions but their angle with the normal,
// gives this mean of the image: the sphere keeps 0.938 of the light.
TEST_F(WhiteFurnace, OfRoughGlassUpToWhatOneFacetSendsToAnother) {
  DielectricMaterial glass;
  glass.alpha = glm::vec2(0.1f);
  for_each_body(glass, [](const Scene& scene) {
    const Observed o = observe(scene, {.spp = 64, .depth = 64, .seeds = 12});
    const bool mesh = scene.triangle_count() > 0;
    EXPECT_NEAR(o.mean.mean, 0.956, mesh ? 5e-3 : 2e-3);
  });
}

// What absorbs too little to be seen inside absorbs nothing outside, where light comes from
// infinitely far away.
TEST_F(WhiteFurnace, OfRoughGlassThatHardlyAbsorbs) {
  DielectricMaterial glass;
  glass.alpha = glm::vec2(0.5f);
  for (const bool map : {false, true}) {
    const Plan plan{.spp = 16, .depth = 16};
    glass.absorption = glm::vec3(0.0f);
    const Image clear = rendered(build(description(glass, false, map)), plan);
    glass.absorption = glm::vec3(1e-6f);
    const Image dim = rendered(build(description(glass, false, map)), plan);
    for (std::size_t i = 0; i < dim.pixels.size(); ++i) {
      ASSERT_NEAR(dim.pixels[i], clear.pixels[i], 1e-4f) << i / 3 << (map ? " map" : " constant");
    }
  }
}

TEST_F(WhiteFurnace, OfDiffuseTransmission) {
  for (const float r : {0.0f, 0.3f, 0.6f}) {
    SCOPED_TRACE(r);
    // Inside, a share r of the light goes on at every hit: 0.6^32 = 1e-7 is lost.
    expect_invisible(DiffuseTransmissionMaterial{glm::vec3(r), glm::vec3(1.0f - r)},
                     {.spp = 16, .depth = 32, .seeds = 16});
  }
}

// Models that lose some light, the more the rougher they are, gain none.
TEST_F(WhiteFurnace, OfOtherWhiteModelsGainsNothing) {
  std::vector<Material> materials{DiffuseMaterial{glm::vec3(1.0f), 30.0f}};
  for (const float alpha : {0.02f, 0.3f, 0.8f}) {
    ConductorMaterial metal;
    metal.eta = glm::vec3(0.0f), metal.k = glm::vec3(1.0f);
    metal.alpha = {alpha, 0.1f};
    CoatedMaterial coated;
    coated.diffuse = glm::vec3(1.0f);
    coated.alpha = alpha;
    materials.insert(materials.end(), {metal, coated});
    for (const int lobes : {0, 1, 2, 4, 5, 6}) {
      PrincipledMaterial principled;
      principled.alpha = alpha;
      principled.metallic = lobes & 1 ? 1.0f : 0.0f;
      principled.transmission = lobes & 2 ? 1.0f : 0.0f;
      principled.coat = lobes & 4 ? 0.7f : 0.0f;
      materials.emplace_back(principled);
    }
  }
  for (const Material& material : materials) {
    SCOPED_TRACE(&material - materials.data());
    const Scene scene = build(description(material, false, false));
    const Observed o = observe(scene, {.spp = 16, .depth = 24, .seeds = 8});
    for (const Moments& m : o.pixels) {
      ASSERT_TRUE(m.mean < 1.0001 || mean_is(m, 1.0, 1e-4) > sidak(level, 64)) << m.mean;
    }
    EXPECT_GT(o.mean.mean, 0.5);
  }
}

// The back of an opaque sphere is inside, where nothing arrives, so each of these is a furnace at
// one interaction; face on, Oren and Nayar's model has no groove's other side to see: L = rho A L.
TEST(RoughDiffuse, FaceOnHasItsFirstCoefficient) {
  for (const float sigma : {10.0f, 20.0f, 60.0f}) {
    SceneDescription d;
    add_rectangle(d, {0, 0, 0}, {4, 0, 0}, {0, 4, 0},
                  add_material(d, DiffuseMaterial{glm::vec3(0.7f), sigma}));
    look_straight(d, {0, 0, 3}, {0, 0, 0}, 1.0f, 8, 8);
    d.environment = glm::vec3(2.0f);
    const double s2 = std::pow(double(sigma) * pi_double / 180.0, 2.0);
    const double a = 1.0 - 0.5 * s2 / (s2 + 0.33);
    for (const int depth : {1, 2}) {
      expect_every_pixel(observe(build(d), {.depth = depth}), 2.0 * double(0.7f) * a);
    }
  }
}

}  // namespace
}  // namespace lockstep::test_white_furnace
