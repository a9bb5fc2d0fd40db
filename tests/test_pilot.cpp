// The pilot of rcs: how it and the image are combined, and that their keys differ.
#include "tests/t_cornell.h"

#include <gtest/gtest.h>

namespace lockstep::test_pilot {
namespace {

// c = 0 keeps every pixel on the shared sequence, as cpt is.
TEST(Render, PilotAndImageAreAddedBySampleCounts) {
  const Scene scene = small_cornell();
  const Image all = render(scene, parse_sampler("rcs:c=0,pilot=2"), small_render(8)).image;
  const Image pilot = render(scene, parse_sampler("rcs:pilot=2"), small_render(2)).image;
  const Image coherent = render(scene, parse_sampler("cpt"), small_render(6)).image;
  for (std::size_t i = 0; i < all.pixels.size(); ++i) {
    const double expected =
        (2.0 * double(pilot.pixels[i]) + 6.0 * double(coherent.pixels[i])) / 8.0;
    ASSERT_NEAR(double(all.pixels[i]), expected, 1e-5 * (1.0 + expected));
  }
}

TEST(Render, CombineByWeightInterpolates) {
  const Scene scene = small_cornell();
  const RenderResult r =
      render(scene, parse_sampler("rcs:c=0,pilot=2,combine=weight"), small_render(8));
  EXPECT_TRUE(same_bytes(r.image, render(scene, parse_sampler("cpt"), small_render(6)).image));
  // From t = 0 and a huge c on, w = 1 wherever neighbours differ at all.
  const RenderResult full =
      render(scene, parse_sampler("rcs:c=1e9,t=0,pilot=2,combine=weight"), small_render(8));
  const Image pilot = render(scene, parse_sampler("rcs:pilot=2"), small_render(2)).image;
  for (int y = 0; y < 50; ++y) {
    for (int x = 0; x < 70; ++x) {
      if (*full.weights->at(x, y) == 1.0f) {
        ASSERT_EQ(full.image.at(x, y)[0], pilot.at(x, y)[0]);
      }
    }
  }
}

// Were R's keys C's, R would be the image that C's sequence gives where no pixel shares it.
TEST(Render, ThePilotHasKeysOfItsOwn) {
  const Scene scene = small_cornell();
  for (const auto& [pilot, image] :
       {std::pair{"rcs:pilot=2", "owen"}, {"rcs:pilot=2,sequence=random", "random"}}) {
    const Image a = render(scene, parse_sampler(pilot), small_render(2)).image;
    const Image b = render(scene, parse_sampler(image), small_render(2)).image;
    std::size_t lit = 0, equal = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
      if (b.pixels[i] <= 0.0f || b.pixels[i] > 10.0f) continue;  // black, or the lamp itself
      ++lit;
      equal += a.pixels[i] == b.pixels[i];
    }
    EXPECT_GT(lit, 5000u);
    EXPECT_LT(double(equal), 0.001 * double(lit)) << image;
  }
}

}  // namespace
}  // namespace lockstep::test_pilot
