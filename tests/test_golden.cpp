// One small scene of each format against its golden image, a long render kept beside it: what a
// reader and the renderer make of a file stays what it was.
//
// Where an image changes on purpose, make it again, here that of pbrt, and look at it:
//   cd tests/golden
//   lockstep render scene.pbrt -o long.exr --sampler owen --spp 65536 --depth 5 --seed 1000
//     --resolution 24x18
//   oiiotool --nosoftwareattrib long.exr --eraseattrib ".*" -d half -o pbrt.exr
// Its seed is none of the test's.
#include "tests/t_scenes.h"
#include "tests/t_statistics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#ifndef LOCKSTEP_GOLDEN_DIR
#error "define LOCKSTEP_GOLDEN_DIR"
#endif

namespace lockstep::test_golden {
namespace {

constexpr int formats = 5;
constexpr int seeds = 16, spp = 64;
constexpr int golden_width = 24, golden_height = 18;

// Half floats have 11 significant bits.
constexpr double half_rounding = 1.0 / 2048.0;

double luminance(const float* p) {
  return 0.2126 * double(p[0]) + 0.7152 * double(p[1]) + 0.0722 * double(p[2]);
}

std::vector<double> luminances(const Image& image) {
  std::vector<double> values;
  for (std::size_t i = 0; i < image.pixels.size(); i += 3) {
    values.push_back(luminance(&image.pixels[i]));
  }
  return values;
}

double mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double v : values) sum += v;
  return sum / double(values.size());
}

// Statistics over seeds: of every pixel's luminance, and of the image's mean.
struct Observed {
  std::vector<Moments> pixels = std::vector<Moments>(golden_width * golden_height);
  Moments image;
};

Observed observe(const Scene& scene) {
  RenderSettings s;
  s.spp = spp;
  s.depth = 5;
  s.threads = 1;
  Observed o;
  for (int seed = 0; seed < seeds; ++seed) {
    s.seed = std::uint32_t(seed);
    const RenderResult result = render(scene, parse_sampler("owen"), s);
    EXPECT_EQ(result.stats.nonfinite, 0u);
    const std::vector<double> values = luminances(result.image);
    for (std::size_t i = 0; i < values.size(); ++i) o.pixels[i].add(values[i]);
    o.image.add(mean(values));
  }
  return o;
}

// How far luminances lie apart among a pixel and its neighbours.
double contrast(const std::vector<double>& image, int x, int y) {
  double low = 1e30, high = 0.0;
  for (int j = std::max(y - 1, 0); j <= std::min(y + 1, golden_height - 1); ++j) {
    for (int i = std::max(x - 1, 0); i <= std::min(x + 1, golden_width - 1); ++i) {
      low = std::min(low, image[std::size_t(j * golden_width + i)]);
      high = std::max(high, image[std::size_t(j * golden_width + i)]);
    }
  }
  return high - low;
}

void expect_mean(const Moments& m, double golden, double floor, double level,
                 const std::string& what) {
  EXPECT_GT(mean_is(m, golden, floor), level)
      << what << ": " << m.mean << " +- " << std::sqrt(m.mean_variance()) << ", golden " << golden;
}

// Half of what a test may spend is for its pixels, half for the mean.
void expect_equal(const Observed& observed, const std::vector<double>& golden) {
  const double level = 0.5 * sidak(significance, formats);
  const double pixel_level = sidak(level, double(golden.size()));
  // What covers less of a pixel than this may be missed by all samples, and is not in the variance.
  const double unseen = -std::log(pixel_level) / (seeds * spp);
  double least = 2.0, least_floor = 0.0;
  std::size_t at = 0;
  for (std::size_t i = 0; i < golden.size(); ++i) {
    const int x = int(i) % golden_width, y = int(i) / golden_width;
    const double floor = half_rounding * golden[i] + unseen * contrast(golden, x, y);
    const double p = mean_is(observed.pixels[i], golden[i], floor);
    if (p < least) least = p, least_floor = floor, at = i;
  }
  expect_mean(observed.pixels[at], golden[at], least_floor, pixel_level,
              "pixel (" + std::to_string(at % golden_width) + ", " +
                  std::to_string(at / golden_width) + ")");
  // Rounding of single pixels goes either way: little of it is left in the mean.
  const double expected = mean(golden);
  expect_mean(observed.image, expected, half_rounding * expected / std::sqrt(double(golden.size())),
              level, "mean of the image");
}

class Golden : public testing::TestWithParam<const char*> {};

TEST_P(Golden, ImageIsMatched) {
  const std::string folder = LOCKSTEP_GOLDEN_DIR "/", format = GetParam();
  const Image golden = read_image(folder + format + ".exr");
  ASSERT_EQ(golden.width, golden_width);
  ASSERT_EQ(golden.height, golden_height);
  const SceneDescription description = read_scene(folder + "scene." + format);
  const Scene scene = build(resized(description, golden.width, golden.height));
  expect_equal(observe(scene), luminances(golden));
}

INSTANTIATE_TEST_SUITE_P(Formats, Golden, testing::Values("pbrt", "xml", "gltf", "obj", "ply"),
                         [](const auto& p) { return std::string(p.param); });

}  // namespace
}  // namespace lockstep::test_golden
