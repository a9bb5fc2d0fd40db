// Pixel filters with negative lobes: what renders under them show of constants, ramps and edges,
// against the filter's own integrals.
#include "tests/t_square.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace lockstep::test_pixel_filters {
namespace {

constexpr int side = 8;           // pixels
constexpr float pixel = 0.0625f;  // of the square [-1, 1]^2, whose middle is seen

PixelFilter with_lobes(PixelFilter::Kind kind, float radius) {
  PixelFilter filter;
  filter.kind = kind;
  filter.radius = glm::vec2(radius);
  return filter;
}

const PixelFilter filters[] = {with_lobes(PixelFilter::Kind::Mitchell, 2.0f),
                               with_lobes(PixelFilter::Kind::Lanczos, 4.0f)};

// Mitchell's filter for B = C = 1/3, and sinc(x) sinc(x / 3), at x pixels from the centre.
double value(const PixelFilter& filter, double x) {
  const double t = std::abs(x);
  if (filter.kind == PixelFilter::Kind::Mitchell) {
    if (t < 1.0) return (7.0 * t * t * t - 12.0 * t * t + 16.0 / 3.0) / 6.0;
    return t < 2.0 ? (-7.0 / 3.0 * t * t * t + 12.0 * t * t - 20.0 * t + 32.0 / 3.0) / 6.0 : 0.0;
  }
  const double pi_t = 3.14159265358979 * t;
  if (t == 0.0) return 1.0;
  return t < 4.0 ? std::sin(pi_t) * std::sin(pi_t / 3.0) * 3.0 / (pi_t * pi_t) : 0.0;
}

// Share of the filter between its start and x.
double share_below(const PixelFilter& filter, double x) {
  constexpr int steps = 1 << 14;
  const double radius = double(filter.radius.x);
  double below = 0.0, all = 0.0;
  for (int i = 0; i < steps; ++i) {
    const double at = radius * ((2.0 * i + 1.0) / steps - 1.0);
    const double f = value(filter, at);
    all += f;
    if (at < x) below += f;
  }
  return below / all;
}

class PixelFilters : public TestWithImages {
 protected:
  // That every pixel's mean is the sky times this of its column.
  template <class F>
  static void expect_columns(SceneDescription d, const PixelFilter& filter, F expected) {
    look_straight(d, {0, 0, 3}, {0, 0, 0}, pixel * side, side, side);
    d.film.filter = filter;
    const Scene scene = build(std::move(d));
    EXPECT_TRUE(scene.features() & bit(Feature::FilterSigns));
    for (const char* sampler : {"random", "owen"}) {
      const Observed o = observe(scene, {.sampler = sampler, .spp = 64, .seeds = 32});
      for (int x = 0; x < side; ++x) {
        Moments column;  // rows are independent
        for (int y = 0; y < side; ++y) column.add(o.pixels[std::size_t(y * side + x)].mean);
        expect_mean(column, double(sky) * expected(x), 1e-3);
      }
    }
  }
};

TEST_F(PixelFilters, LeaveConstantsAsTheyAre) {
  for (const PixelFilter& filter : filters) {
    expect_columns(square(DiffuseMaterial{glm::vec3(0.5f)}), filter, [](int) { return 0.5; });
  }
}

// From 0 at x = -1/2 to 1 at x = 1/2.
TEST_F(PixelFilters, LeaveRampsAsTheyAre) {
  for (const PixelFilter& filter : filters) {
    SceneDescription d = square(DiffuseMaterial{textured(0)});
    ImageTexture ramp = texture_of(
        exr("ramp", 2, 1, [](int x, int) { return glm::vec3(float(x)); }), TextureFilter::Bilinear);
    ramp.wrap_u = TextureWrap::Clamp;
    add_texture(d, ramp);
    expect_columns(d, filter,
                   [](int x) { return 0.5 + double(pixel) * (double(x) + 0.5 - 0.5 * side); });
  }
}

// Left of x = 0 black, right of it white: darker than black and brighter than white next to it.
TEST_F(PixelFilters, OvershootAtEdges) {
  for (const PixelFilter& filter : filters) {
    SceneDescription d = square(DiffuseMaterial{textured(0)});
    add_texture(d, texture_of(exr("edge", 2, 1, [](int x, int) { return glm::vec3(float(x)); })));
    double least = 0.0;
    expect_columns(d, filter, [&](int x) {
      const double share = share_below(filter, double(x) + 0.5 - 0.5 * side);
      least = std::min(least, share);
      return share;
    });
    EXPECT_LT(least, -0.005);
  }
}

}  // namespace
}  // namespace lockstep::test_pixel_filters
