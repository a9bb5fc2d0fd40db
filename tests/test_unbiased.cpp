// Samplers are unbiased: their mean over many seeds is that of plain Monte Carlo, in every pixel.
//
// Pixels of a shared sequence are correlated, so a seed, not a pixel, is one observation. Each
// pixel's mean luminance is compared by Welch's t-test with a reference of independent seeds,
// corrected for the number of pixels and runs; then the image's mean, which sees what is too small
// for single pixels. Combining by weight is documented as biased and is not tested here.
#include "tests/t_scenes.h"
#include "tests/t_statistics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace lockstep {
namespace {

constexpr int width = 24, height = 18, depth = 3;

// Luminance statistics over seeds: of every pixel, and of the image's mean.
struct Observed {
  std::vector<Moments> pixels = std::vector<Moments>(size_t(width) * size_t(height));
  Moments image;
};

void observe(Observed& o, const Image& image) {
  double sum = 0.0;
  for (std::size_t i = 0; i < o.pixels.size(); ++i) {
    const float* p = &image.pixels[3 * i];
    const double y = 0.2126 * double(p[0]) + 0.7152 * double(p[1]) + 0.0722 * double(p[2]);
    o.pixels[i].add(y);
    sum += y;
  }
  o.image.add(sum / double(o.pixels.size()));
}

Observed run(const Scene& scene, std::string_view sampler, int spp, std::uint32_t first_seed,
             int seeds) {
  const SamplerSpec spec = parse_sampler(sampler);
  RenderSettings s;
  s.spp = spp;
  s.depth = depth;
  s.roulette_depth = 2;
  s.threads = 2;
  Observed o;
  for (int i = 0; i < seeds; ++i) {
    s.seed = first_seed + std::uint32_t(i);
    observe(o, render(scene, spec, s).image);
  }
  return o;
}

struct Case {
  const char* sampler;
  int spp, seeds;
};

const Case cases[] = {
    {"random", 1, 512},
    {"random", 4, 256},
    {"owen", 1, 512},
    {"owen", 4, 256},
    {"cpt", 1, 512},
    {"cpt", 4, 256},
    {"cpt:sequence=random", 4, 256},
    {"rcs", 2, 512},
    {"rcs", 4, 256},
    {"rcs:offset=fresh,sequence=random", 4, 256},
    {"rcs:c=100,t=0", 4, 256},
    {"rcs:c=0.5,filter=none,pilot=2", 4, 256},
    {"rcs:weight=0.3", 4, 256},
    {"rcs:weight=0.3,offset=fresh", 4, 256},
    {"rcs:offset=fresh", 4, 256},
    {"rcs:weight=1,offset=fresh", 4, 256},
};
const double level = sidak(significance, double(2 * std::size(cases)));

void expect_same(const Observed& test, const Observed& reference, const char* what) {
  double least = 1.0;
  std::size_t at = 0;
  for (std::size_t i = 0; i < test.pixels.size(); ++i) {
    const double rounding = 1e-6 * reference.pixels[i].mean;
    const double p = equal_means(test.pixels[i], reference.pixels[i], rounding);
    if (p < least) least = p, at = i;
  }
  EXPECT_GT(least, sidak(level, 2.0 * double(test.pixels.size())))
      << what << " at pixel (" << at % width << ", " << at / width << "): " << test.pixels[at].mean
      << " against " << reference.pixels[at].mean;
  EXPECT_GT(equal_means(test.image, reference.image, 1e-6 * reference.image.mean), 0.5 * level)
      << what << ", mean of the image: " << test.image.mean << " against " << reference.image.mean;
}

Scene small(SceneDescription description) {
  return build(resized(std::move(description), width, height));
}

Observed reference_of(const Scene& scene) { return run(scene, "random", 128, 0x40000000u, 72); }

void compare_all(const Scene& scene, const Observed& reference) {
  for (const Case& c : cases) {
    expect_same(run(scene, c.sampler, c.spp, 1, c.seeds), reference, c.sampler);
  }
}

TEST(Unbiased, EverySamplerOnDiffuseWalls) {
  const Scene scene = small(builtin::make_cornell());
  const Observed reference = reference_of(scene);
  compare_all(scene, reference);

  // The comparison can tell: four per cent more light is found.
  SceneDescription brighter = builtin::make_cornell();
  for (Shape& shape : brighter.shapes) {
    if (shape.emission) shape.emission->radiance *= 1.04f;
  }
  const Observed test = run(small(std::move(brighter)), "owen", 4, 1, 256);
  EXPECT_LT(equal_means(test.image, reference.image), 0.5 * level);
}

TEST(Unbiased, EverySamplerOnMetal) {
  const Scene scene = small(builtin::make_spheres());
  compare_all(scene, reference_of(scene));
}

}  // namespace
}  // namespace lockstep
