// Real scenes against pbrt-v4's renders of the same files, where both lie beside the project.
//
// Noise is told from bias by independent renders: the product of two renders' errors in a block has
// the square of their common error as its mean, whatever their noise. Fireflies stay in: one in a
// block spoils that block of one render, and its product with the others' small errors counts
// little; they widen what the test must allow, which it measures from its own blocks.
#include "experiments/metrics/block_error.h"
#include "tests/t_scenes.h"
#include "tests/t_statistics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#ifndef LOCKSTEP_SHARED_DIR
#error "define LOCKSTEP_SHARED_DIR"
#endif

namespace lockstep::test_references {
namespace {

struct Reference {
  const char* scene;
  const char* image;
  int depth;
  int spp;  // of all renders: for a standard error of the mean well below half a per cent
  // What large blocks may be off by, each by itself, in all renders.
  double large_block = 0.05;
  // Of the mean of a channel: more between saturated walls, which look otherwise in pbrt's spectra
  // than in RGB once light has met them twice.
  double color = 0.02;
};

constexpr int renders = 4;

// What the mean luminance may be off by, and the root of the mean square over small blocks, noise
// taken off.
constexpr double mean_tolerance = 0.02, block_tolerance = 0.05;

// With noise at its worst the test still fails where small blocks are off by this.
constexpr double bluntest = 0.09;

double pixel_luminance(const float* p) {
  return 0.2126 * double(p[0]) + 0.7152 * double(p[1]) + 0.0722 * double(p[2]);
}

double luminance_mean(const Image& image) {
  return 0.2126 * channel_mean(image, 0) + 0.7152 * channel_mean(image, 1) +
         0.0722 * channel_mean(image, 2);
}

// (a - b) / (b + 0.01 m) of each block's mean luminances, as block_relative_rmse has them, without
// pixels that the reference has above ten times its mean m: mirror images of small lights, whose
// noise would be all that is compared.
std::vector<double> block_errors(const Image& image, const Image& reference, int side) {
  const double mean = luminance_mean(reference);
  const int columns = (image.width + side - 1) / side, rows = (image.height + side - 1) / side;
  std::vector<double> a(size_t(columns) * size_t(rows)), b(a.size()), pixels(a.size());
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const auto block = size_t(y / side * columns + x / side);
      pixels[block] += 1.0;
      if (pixel_luminance(reference.at(x, y)) > 10.0 * mean) continue;
      a[block] += pixel_luminance(image.at(x, y));
      b[block] += pixel_luminance(reference.at(x, y));
    }
  }
  for (size_t i = 0; i < a.size(); ++i) a[i] = (a[i] - b[i]) / (b[i] + 0.01 * mean * pixels[i]);
  return a;
}

// The mean square over small blocks, by products of different renders' errors; allowed are three
// standard errors of it: with other seeds one correct program in a hundred would fail a scene.
void expect_small_blocks(const Image& expected, const std::vector<Image>& images) {
  std::vector<double> sum, squares;
  for (const Image& image : images) {
    const std::vector<double> errors = block_errors(image, expected, kErrorBlock);
    sum.resize(errors.size());
    squares.resize(errors.size());
    for (size_t i = 0; i < errors.size(); ++i) {
      sum[i] += errors[i];
      squares[i] += errors[i] * errors[i];
    }
  }
  Moments products;
  for (size_t i = 0; i < sum.size(); ++i) {
    products.add((sum[i] * sum[i] - squares[i]) / (renders * (renders - 1)));
  }
  const double noise = 3.0 * std::sqrt(products.mean_variance());
  const double allowed = block_tolerance * block_tolerance + noise;
  testing::Test::RecordProperty("block_bias",
                                std::to_string(std::sqrt(std::max(0.0, products.mean))));
  testing::Test::RecordProperty("block_bias_allowed", std::to_string(std::sqrt(allowed)));
  EXPECT_LT(products.mean, allowed)
      << "blocks of 16 x 16 pixels are off by " << std::sqrt(products.mean);
  EXPECT_LT(std::sqrt(allowed), bluntest) << "too few samples to tell";
}

// A mean square over hundreds of blocks lets one be off by half: light that is missing in one place
// shows here. It is missing in every render, where fireflies are in some: the smallest error counts
// if all have its sign.
void expect_large_blocks(const Image& expected, const std::vector<Image>& images,
                         double tolerance) {
  constexpr int side = 48;
  std::vector<double> low, high;
  for (const Image& image : images) {
    const std::vector<double> errors = block_errors(image, expected, side);
    low.resize(errors.size(), HUGE_VAL);
    high.resize(errors.size(), -HUGE_VAL);
    for (size_t i = 0; i < errors.size(); ++i) {
      low[i] = std::min(low[i], errors[i]);
      high[i] = std::max(high[i], errors[i]);
    }
  }
  double largest = 0.0;
  for (size_t i = 0; i < low.size(); ++i) {
    const double common = std::max({low[i], -high[i], 0.0});
    EXPECT_LT(common, tolerance) << "block " << i << " of " << side << " x " << side;
    largest = std::max(largest, common);
  }
  testing::Test::RecordProperty("large_block_error", std::to_string(largest));
}

class References : public testing::TestWithParam<Reference> {};

TEST_P(References, AreMatched) {
  const std::string folder = std::string(LOCKSTEP_SHARED_DIR) + "/scenes/";
  const Reference& r = GetParam();
  if (!std::filesystem::exists(folder + r.image) || !std::filesystem::exists(folder + r.scene)) {
    GTEST_SKIP() << "skipped: no " << folder << r.image;
  }
  const Image expected = read_image(folder + r.image);
  const Scene scene = build(resized(read_scene(folder + r.scene), expected.width, expected.height));
  RenderSettings s;
  s.spp = r.spp / renders;
  s.depth = r.depth;
  s.threads = 2;
  std::vector<Image> images;
  double luminance = 0.0, colors[3] = {};
  for (s.seed = 3; s.seed < 3 + renders; ++s.seed) {
    const RenderResult result = render(scene, parse_sampler("owen"), s);
    EXPECT_EQ(result.stats.nonfinite, 0u);
    luminance += luminance_mean(result.image) / renders;
    for (int c = 0; c < 3; ++c) colors[c] += channel_mean(result.image, c) / renders;
    images.push_back(result.image);
  }
  RecordProperty("luminance_ratio", std::to_string(luminance / luminance_mean(expected)));
  EXPECT_NEAR(luminance / luminance_mean(expected), 1.0, mean_tolerance);
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(colors[c] / channel_mean(expected, c), 1.0, r.color) << "channel " << c;
  }
  expect_small_blocks(expected, images);
  expect_large_blocks(expected, images, r.large_block);
}

INSTANTIATE_TEST_SUITE_P(
    Pbrt, References,
    testing::Values(
        Reference{"killeroo-quad/killeroo-quad.pbrt", "killeroo-quad/reference-depth1.exr", 1, 64,
                  0.01},
        Reference{"killeroo-quad/killeroo-quad.pbrt", "killeroo-quad/reference-depth5.exr", 5, 64,
                  0.01},
        Reference{"cornell-box/scene-v4.pbrt", "cornell-box/reference-pbrt.exr", 65, 48, 0.1, 0.05},
        Reference{"veach-mis/scene-v4.pbrt", "veach-mis/reference-pbrt.exr", 3, 128},
        Reference{"staircase2/scene-v4.pbrt", "staircase2/reference-pbrt.exr", 65, 48},
        Reference{"veach-ajar/scene-v4.pbrt", "veach-ajar/reference-pbrt.exr", 13, 96},
        Reference{"classroom/scene-v4.pbrt", "classroom/reference-pbrt.exr", 17, 48},
        Reference{"veach-bidir/scene-v4.pbrt", "veach-bidir/reference-pbrt.exr", 7, 128}),
    [](const auto& p) {
      std::string name = p.param.scene;
      name = name.substr(0, name.find('/')) + "Depth" + std::to_string(p.param.depth);
      std::erase(name, '-');
      return name;
    });

}  // namespace
}  // namespace lockstep::test_references
