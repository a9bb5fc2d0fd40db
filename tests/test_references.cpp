// Real scenes against pbrt-v4's renders of the same files, where both lie beside the project.
// Means are compared, and blocks of pixels, so that light has to be in its place too: the largest
// error of 8 x 6 blocks, and the root of the mean square over blocks of 16 x 16 pixels less what
// noise makes of it.
#include "experiments/metrics/block_error.h"
#include "tests/t_scenes.h"

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
  int spp;            // for a standard error of the mean well below a third of a per cent
  int reference_spp;  // of the reference
  // What blocks may differ by: more where noise is strong, and between saturated walls, which look
  // otherwise in pbrt's spectra than in RGB once light has met them twice.
  double tolerance = 0.05;
  // What the mean square over small blocks may leave, noise taken off.
  double small_blocks = 0.05;
};

constexpr int columns = 8, rows = 6;

double pixel_luminance(const float* p) {
  return 0.2126 * double(p[0]) + 0.7152 * double(p[1]) + 0.0722 * double(p[2]);
}

// Mean luminance of each block, row by row, without the pixels that the reference has above
// `limit`: mirror images of small lights, whose noise would be all that is compared.
std::vector<double> block_means(const Image& image, const Image& reference, double limit) {
  std::vector<double> sum(columns * rows), count(columns * rows);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      if (pixel_luminance(reference.at(x, y)) > limit) continue;
      const auto block = size_t(y * rows / image.height * columns + x * columns / image.width);
      sum[block] += pixel_luminance(image.at(x, y));
      count[block] += 1.0;
    }
  }
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] /= count[i];
  return sum;
}

// Without the pixels that the reference has above `limit`.
Image masked(Image image, const Image& reference, double limit) {
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      if (pixel_luminance(reference.at(x, y)) > limit) std::fill_n(image.at(x, y), 3, 0.0f);
    }
  }
  return image;
}

Image average(const Image& a, const Image& b) {
  Image result = a;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    result.pixels[i] = 0.5f * (a.pixels[i] + b.pixels[i]);
  }
  return result;
}

// The mean of two independent renders differs from the truth by half as much as they differ from
// each other, and the reference by as much less as it has more samples. What is left is bias, but
// for four standard errors of a mean square over so many blocks.
void expect_small_blocks(const Reference& r, const Image& expected, const Image& a,
                         const Image& b) {
  const double error = block_relative_rmse(expected, average(a, b));
  const double half = 0.5 * block_relative_rmse(a, b);
  const double noise = half * half * (1.0 + double(r.spp) / r.reference_spp);
  const double blocks = double(expected.width) * expected.height / (kErrorBlock * kErrorBlock);
  const double allowed = r.small_blocks * r.small_blocks + noise * (1 + 4 * std::sqrt(2 / blocks));
  const double bias = std::sqrt(std::max(0.0, error * error - noise));
  testing::Test::RecordProperty("block_bias", std::to_string(bias));
  EXPECT_LT(error * error, allowed)
      << "blocks of 16 x 16 pixels are off by " << bias << " and noise of " << std::sqrt(noise);
}

double luminance_mean(const Image& image) {
  return 0.2126 * channel_mean(image, 0) + 0.7152 * channel_mean(image, 1) +
         0.0722 * channel_mean(image, 2);
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
  s.spp = r.spp / 2;
  s.depth = r.depth;
  s.threads = 2;
  std::vector<Image> halves;
  for (const std::uint32_t seed : {3u, 4u}) {
    s.seed = seed;
    const RenderResult result = render(scene, parse_sampler("owen"), s);
    EXPECT_EQ(result.stats.nonfinite, 0u);
    halves.push_back(result.image);
  }
  const Image ours = average(halves[0], halves[1]);

  const double mean = luminance_mean(expected);
  EXPECT_NEAR(luminance_mean(ours), mean, 0.02 * mean);
  for (int c = 0; c < 3; ++c) {
    const double channel = channel_mean(expected, c);
    EXPECT_NEAR(channel_mean(ours, c), channel, r.tolerance * channel) << "channel " << c;
  }
  const double limit = 10.0 * mean;
  expect_small_blocks(r, masked(expected, expected, limit), masked(halves[0], expected, limit),
                      masked(halves[1], expected, limit));
  const std::vector<double> found = block_means(ours, expected, limit);
  const std::vector<double> theirs = block_means(expected, expected, limit);
  int compared = 0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (theirs[i] < 0.05 * mean) continue;
    ++compared;
    EXPECT_NEAR(found[i], theirs[i], r.tolerance * theirs[i])
        << "block " << i % columns << ", " << i / columns;
  }
  EXPECT_GE(compared, columns * rows / 2);
}

INSTANTIATE_TEST_SUITE_P(
    Pbrt, References,
    testing::Values(
        Reference{"killeroo-quad/killeroo-quad.pbrt", "killeroo-quad/reference-depth1.exr", 1, 64,
                  4096},
        Reference{"killeroo-quad/killeroo-quad.pbrt", "killeroo-quad/reference-depth5.exr", 5, 64,
                  4096},
        Reference{"cornell-box/scene-v4.pbrt", "cornell-box/reference-pbrt.exr", 65, 48, 1024,
                  0.15},
        Reference{"veach-mis/scene-v4.pbrt", "veach-mis/reference-pbrt.exr", 3, 256, 2048, 0.1},
        Reference{"staircase2/scene-v4.pbrt", "staircase2/reference-pbrt.exr", 65, 48, 1024, 0.04},
        Reference{"veach-ajar/scene-v4.pbrt", "veach-ajar/reference-pbrt.exr", 13, 128, 2048, 0.1},
        Reference{"classroom/scene-v4.pbrt", "classroom/reference-pbrt.exr", 17, 64, 1024, 0.07}),
    [](const auto& p) {
      std::string name = p.param.scene;
      name = name.substr(0, name.find('/')) + "Depth" + std::to_string(p.param.depth);
      std::erase(name, '-');
      return name;
    });

}  // namespace
}  // namespace lockstep::test_references
