// Samplers are unbiased: their mean over many seeds is the integral, in every pixel.
//
// Pixels of a shared sequence are correlated, so a seed, not a pixel, is one observation. Where
// there is a closed form each pixel's mean radiance is compared with it by a t-test; in a box with
// one lamp, lit indirectly, by Welch's t-test with plain Monte Carlo. Significance is corrected for
// the number of pixels and samplers; the image's mean is tested besides, as it shows what is too
// small for single pixels. Combining by weight is documented as biased and is not tested here.
//
// No scene has paths of unbounded weight, such as those near an edge of shining walls: their tails
// would make t-tests of hundreds of seeds reject correct code.
#include "tests/t_scenes.h"
#include "tests/t_statistics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lockstep::test_unbiased {
namespace {

constexpr int side = 8;

// Statistics over seeds: of every pixel, and of the image's mean.
struct Observed {
  std::vector<Moments> pixels = std::vector<Moments>(side * side);
  Moments image;
};

Observed run(const Scene& scene, std::string_view sampler, int spp, int depth,
             std::uint32_t first_seed, int seeds) {
  const SamplerSpec spec = parse_sampler(sampler);
  RenderSettings s;
  s.spp = spp;
  s.depth = depth;
  s.roulette_depth = 2;
  s.threads = 1;
  s.lanes = LaneLayout{4, 4, 1};
  Observed o;
  for (int i = 0; i < seeds; ++i) {
    s.seed = first_seed + std::uint32_t(i);
    const Image image = render(scene, spec, s).image;
    for (std::size_t p = 0; p < o.pixels.size(); ++p) o.pixels[p].add(double(image.pixels[3 * p]));
    o.image.add(channel_mean(image, 0));
  }
  return o;
}

struct Case {
  std::string sampler;
  int spp;
};

// Every preset with one, a power of two and another number of samples, and every way to leave the
// shared sequence, by as far as it may be.
std::vector<Case> cases() {
  std::vector<Case> all;
  for (const std::string& preset : sampler_names()) {
    for (const int spp : {1, 4, 5}) all.push_back({preset, spp});
  }
  for (const char* offset : {"constant", "bluenoise"}) {
    for (const char* mix : {"add", "xor"}) {
      const auto move = std::string("rcs:mix=") + mix + ",offset=" + offset + ",weight=";
      for (const char* w : {"0", "0.015625", "0.125", "0.5", "1"}) all.push_back({move + w, 4});
      all.push_back({move + "auto,pilot=2", 4});
      all.push_back({move + "map,c=0.5,filter=none,pilot=2", 4});
    }
  }
  for (const char* text :
       {"cpt:sequence=random", "rcs:weight=0.3,offset=fresh", "rcs:weight=0.3,offset=morton",
        "strata:weight=auto", "strata:share=tile,interleave=2", "rcs:c=100,t=0"}) {
    all.push_back({text, 4});
  }
  return all;
}

// `p_of(i)` for the pixels, and for the image where i is their number.
template <class F>
void expect_all(const Case& c, double level, const F& p_of) {
  const std::size_t pixels = side * side;
  double least = 1.0;
  std::size_t at = 0;
  for (std::size_t i = 0; i < pixels; ++i) {
    if (p_of(i) < least) least = p_of(i), at = i;
  }
  EXPECT_GT(least, sidak(0.5 * level, double(pixels)))
      << c.sampler << ' ' << c.spp << " spp, pixel (" << at % side << ", " << at / side << ")";
  EXPECT_GT(p_of(pixels), 0.5 * level) << c.sampler << ' ' << c.spp << " spp, mean of the image";
}

const Moments& part(const Observed& o, std::size_t i) {
  return i < o.pixels.size() ? o.pixels[i] : o.image;
}

void expect_closed_form(const Scene& scene, double expected, int depth) {
  const double level = sidak(significance, double(cases().size()));
  for (const Case& c : cases()) {
    const Observed test = run(scene, c.sampler, c.spp, depth, 1, 256);
    expect_all(c, level,
               [&](std::size_t i) { return mean_is(part(test, i), expected, 1e-4 * expected); });
  }
}

// The share of the half sky over a floor, by cosines, that a parallel rectangle [0, x] x [0, y] at
// height 1 above its corner takes (Lambert 1760).
double corner_factor(double x, double y) {
  const double a = std::sqrt(1.0 + x * x), b = std::sqrt(1.0 + y * y);
  return (x / a * std::atan(y / a) + y / b * std::atan(x / b)) / (2.0 * std::numbers::pi);
}

SceneDescription lamp_over_floor(float radiance) {
  SceneDescription d;
  d.name = "lamp over floor";
  const int grey = builtin::add_material(d, DiffuseMaterial{glm::vec3(0.5f)});
  builtin::add_rectangle(d, {0, 0, 0}, {0, 0, 9}, {9, 0, 0}, grey);
  builtin::add_rectangle(d, {1, 1, 0}, {1.5f, 0, 0}, {0, 0, 1}, grey,
                         Emission{glm::vec3(radiance)});
  look_closely(d, {0, 0.5f, 3}, {0, 0, 0});
  return d;
}

TEST(Unbiased, EverySamplerInTheLightOfALamp) {
  // The lamp's part of [-0.5, 2.5] x [-1, 1].
  const double expected = 0.5 * 2.0 * 2.0 * (corner_factor(0.5, 1.0) + corner_factor(2.5, 1.0));
  expect_closed_form(build(lamp_over_floor(2.0f)), expected, 1);
  // The test can tell: two per cent more light is found.
  const Observed more = run(build(lamp_over_floor(2.04f)), "owen", 4, 1, 1, 256);
  EXPECT_LT(mean_is(more.image, expected), 1e-9);
}

// Everywhere in a shining sphere of emission e and albedo a, L = e + a e + a^2 e + ...
TEST(Unbiased, EverySamplerInAShiningSphere) {
  constexpr float emission = 0.7f, albedo = 0.6f;
  SceneDescription d;
  d.name = "shining sphere";
  const int wall = builtin::add_material(d, DiffuseMaterial{glm::vec3(albedo)});
  builtin::add_sphere(d, {1, 2, 3}, 2.5f, wall, Emission{glm::vec3(emission)});
  std::get<Sphere>(d.shapes[0].geometry).emits_inwards = true;
  d.camera.camera_to_world = builtin::look_at({1.3f, 1.6f, 2.8f}, {5, 4, 1});
  double expected = 0.0;
  for (int i = 0; i <= 3; ++i) expected = expected * double(albedo) + double(emission);
  expect_closed_form(build(resized(std::move(d), side, side)), expected, 3);
}

TEST(Unbiased, EverySamplerInABoxWithALamp) {
  const Scene scene = build(resized(builtin::make_cornell(), side, side));
  const Observed reference = run(scene, "random", 256, 3, 0x40000000u, 64);
  const double level = sidak(significance, double(cases().size()));
  for (const Case& c : cases()) {
    const Observed test = run(scene, c.sampler, c.spp, 3, 1, 256);
    expect_all(c, level, [&](std::size_t i) {
      const Moments& known = part(reference, i);
      return equal_means(part(test, i), known, 1e-6 * known.mean);
    });
  }
}

}  // namespace
}  // namespace lockstep::test_unbiased
