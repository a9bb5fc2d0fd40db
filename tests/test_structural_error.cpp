// Low-pass RMSE, SSIM and the spectrum of errors on images with known answers.
#include "experiments/metrics/structural_error.h"

#include "core/srgb.h"
#include "experiments/metrics/block_error.h"
#include "experiments/metrics/error_spectrum.h"
#include "experiments/metrics/separable_filter.h"
#include "experiments/metrics/squared_error.h"
#include "experiments/output/display_image.h"
#include "experiments/output/fast_power.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace lockstep::test_structural_error {
namespace {

constexpr std::pair<int, int> kOddSizes[] = {{1, 1}, {1, 300}, {300, 1}, {7, 5}, {11, 12}};

Image constant(int width, int height, float value) {
  Image image(width, height, 3);
  for (float& v : image.pixels) v = value;
  return image;
}

// Grey noise of mean `mean` and standard deviation `deviation`.
Image grey_noise(int width, int height, float mean, float deviation, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<float> normal(mean, deviation);
  Image image(width, height, 3);
  for (std::size_t i = 0; i < image.pixels.size(); i += 3) {
    image.pixels[i] = image.pixels[i + 1] = image.pixels[i + 2] = normal(random);
  }
  return image;
}

// mean + amplitude cos(2 pi (fx x + fy y)) in all channels.
Image wave(int width, int height, double fx, double fy, double amplitude, double mean = 0.0) {
  Image image(width, height, 3);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const double value = mean + amplitude * std::cos(2.0 * std::numbers::pi * (fx * x + fy * y));
      for (int c = 0; c < 3; ++c) image.at(x, y)[c] = float(value);
    }
  }
  return image;
}

TEST(SeparableFilter, IsTheSumOverAllPairsOfWeights) {
  const std::vector<float> across = {0.1f, -0.2f, 0.5f, 0.3f, 0.05f}, down = {0.7f, 0.2f, -0.4f};
  std::mt19937 random(1);
  Image image(37, 150, 2);  // more rows than a strip has
  for (float& v : image.pixels) v = float(random() % 1000) / 1000.0f;
  const Image result = separable_filter(image, across, down);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      double sum[2] = {};
      for (int j = -1; j <= 1; ++j) {
        for (int i = -2; i <= 2; ++i) {
          const double weight =
              double(across[std::size_t(i + 2)]) * double(down[std::size_t(j + 1)]);
          const float* pixel = image.at(std::clamp(x + i, 0, 36), std::clamp(y + j, 0, 149));
          for (int c = 0; c < 2; ++c) sum[c] += weight * double(pixel[c]);
        }
      }
      for (int c = 0; c < 2; ++c) ASSERT_NEAR(result.at(x, y)[c], sum[c], 1e-6) << x << ' ' << y;
    }
  }
}

TEST(FastPower, IsWithinItsBounds) {
  for (double x = 1e-10; x < 1e10; x *= 1.0103) {
    const float value = float(x);
    const double expected = std::log2(double(value));
    EXPECT_NEAR(fast_log2(value), expected, 2e-7 * std::max(1.0, std::abs(expected))) << x;
    for (const float p : {0.0f, 1.0f / 3.0f, 1.0f / 2.4f, 0.7f, 1.0f}) {
      const double power = std::pow(double(value), double(p));
      EXPECT_NEAR(fast_power(value, p), power, 2e-6 * power) << x << " ^ " << p;
    }
  }
  for (double x = -126.0; x < 127.0; x += 0.0137) {
    const double expected = std::exp2(double(float(x)));
    EXPECT_NEAR(fast_exp2(float(x)), expected, 2e-7 * expected) << x;
  }
  EXPECT_EQ(fast_power(0.0f, 0.7f), 0.0f);
  EXPECT_EQ(fast_power(-1.0f, 0.7f), 0.0f);
}

TEST(DisplayImage, CodesAreThoseThatFilesHold) {
  std::vector<float> linear;
  for (int code = 0; code < 256; ++code) linear.push_back(linear_from_srgb(float(code) / 255.0f));
  linear.insert(linear.end(), {-1.0f, 7.0f});
  std::vector<std::uint8_t> codes(linear.size());
  display_codes(linear.data(), int(linear.size()), codes.data());
  for (int code = 0; code < 256; ++code) EXPECT_EQ(codes[std::size_t(code)], code);
  EXPECT_EQ(codes[256], 0);
  EXPECT_EQ(codes[257], 255);
}

TEST(DisplayImage, ColourMapsGetBrighter) {
  Image map(101, 1, 1);
  for (int x = 0; x <= 100; ++x) *map.at(x, 0) = float(x) / 100.0f;
  for (const Image& colours : {magma(map), viridis(map)}) {
    const Image luma = display_luma(colours);
    for (int x = 1; x <= 100; ++x) EXPECT_GT(*luma.at(x, 0), *luma.at(x - 1, 0)) << x;
    EXPECT_LT(*luma.at(0, 0), 0.1f);
    EXPECT_GT(*luma.at(100, 0), 0.8f);
  }
}

TEST(BlockError, IsOfBlockMeansRelativeToTheReference) {
  // Four blocks of 16 x 16; the test is 20 % too bright in one and, with noise of mean 0, right in
  // the others: sqrt(0.25 (0.2 / 1.01)^2).
  const Image reference = constant(32, 32, 2.0f);
  Image test = reference;
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 32; ++x) {
      for (int c = 0; c < 3; ++c) {
        test.at(x, y)[c] = x < 16 && y < 16 ? 2.4f : (x + y) % 2 ? 3.0f : 1.0f;
      }
    }
  }
  EXPECT_NEAR(block_relative_rmse(reference, test), 0.5 * 0.2 / 1.01, 1e-6);
  EXPECT_NEAR(luminance_ratio(reference, test), 1.05, 1e-6);
}

TEST(BlockError, CountsSmallerBlocksByTheirPixels) {
  const Image reference = constant(20, 16, 1.0f);  // a block of 16 columns, one of 4
  Image test = reference;
  for (int y = 0; y < 16; ++y) {
    for (int x = 16; x < 20; ++x) {
      for (int c = 0; c < 3; ++c) test.at(x, y)[c] = 1.5f;
    }
  }
  EXPECT_NEAR(block_relative_rmse(reference, test), std::sqrt(0.2) * 0.5 / 1.01, 1e-6);
}

TEST(BlockError, OfBlackImages) {
  const Image black = constant(16, 16, 0.0f), grey = constant(16, 16, 1.0f);
  EXPECT_EQ(block_relative_rmse(black, black), 0.0);
  EXPECT_FALSE(std::isfinite(block_relative_rmse(black, grey)));
  EXPECT_FALSE(std::isfinite(luminance_ratio(black, grey)));
}

TEST(SquaredError, MseIsTheSquareOfRmse) {
  const Image p = grey_noise(20, 10, 0.5f, 0.2f, 1), q = grey_noise(20, 10, 0.5f, 0.2f, 2);
  EXPECT_NEAR(mse(p, q), rmse(p, q) * rmse(p, q), 1e-12);
  EXPECT_NEAR(mse(p, q), 2 * 0.04, 0.02);
}

TEST(SquaredError, SmapeIsRelativeToBoth) {
  Image p = constant(2, 1, 0.0f), q = p;
  p.at(0, 0)[0] = 1.0f;
  q.at(0, 0)[0] = 3.0f;  // 2 / 4.01 in one of six values
  EXPECT_NEAR(smape(p, q), 2.0 / 4.01 / 6.0, 1e-12);
  EXPECT_EQ(smape(p, q), smape(q, p));
  EXPECT_EQ(smape(p, p), 0.0);
}

TEST(LowPassRmse, OfAnOffsetIsTheOffset) {
  for (const auto& [width, height] : kOddSizes) {
    const Image image = grey_noise(width, height, 0.5f, 0.1f, 3);
    Image test = image;
    for (float& v : test.pixels) v += 0.25f;
    EXPECT_NEAR(low_pass_rmse(image, test), 0.25, 1e-5);
    EXPECT_EQ(low_pass_rmse(image, image), 0.0);
  }
}

TEST(LowPassRmse, OfACheckerboardIsNearZero) {
  const Image reference = constant(96, 96, 0.5f);
  Image test = reference;
  for (int y = 0; y < 96; ++y) {
    for (int x = 0; x < 96; ++x) {
      for (int c = 0; c < 3; ++c) test.at(x, y)[c] += (x + y) % 2 ? 0.1f : -0.1f;
    }
  }
  EXPECT_NEAR(rmse(reference, test), 0.1, 1e-6);
  EXPECT_LT(low_pass_rmse(reference, test), 0.002);
}

TEST(LowPassRmse, LowersWhiteNoiseByTheKernelsEnergy) {
  // The variance falls by the sum of squares of the weights, 1 / (4 pi sigma^2) with sigma = 4.
  const Image reference = constant(512, 512, 0.0f);
  const Image test = grey_noise(512, 512, 0.0f, 1.0f, 4);
  const double expected = 1.0 / std::sqrt(4.0 * std::numbers::pi * 16.0);
  EXPECT_NEAR(low_pass_rmse(reference, test), expected, 0.06 * expected);
}

TEST(Ssim, OfEqualImagesIsOne) {
  for (const auto& [width, height] : kOddSizes) {
    const Image image = grey_noise(width, height, 0.5f, 0.2f, 5);
    EXPECT_EQ(ssim(image, image), 1.0);
  }
}

TEST(Ssim, OfTwoGreysComparesTheirMeans) {
  // Nothing varies: (2 p q + C1) / (p^2 + q^2 + C1).
  const float p = 0.3f, q = 0.6f;
  const double expected = (2.0 * 0.3 * 0.6 + 1e-4) / (0.09 + 0.36 + 1e-4);
  for (const auto& [width, height] : kOddSizes) {
    EXPECT_NEAR(ssim(constant(width, height, linear_from_srgb(p)),
                     constant(width, height, linear_from_srgb(q))),
                expected, 1e-4);
  }
}

TEST(Ssim, OfOppositeTexturesIsNegative) {
  Image p(64, 64, 3), q(64, 64, 3);
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      for (int c = 0; c < 3; ++c) {
        p.at(x, y)[c] = linear_from_srgb((x + y) % 2 ? 0.7f : 0.3f);
        q.at(x, y)[c] = linear_from_srgb((x + y) % 2 ? 0.3f : 0.7f);
      }
    }
  }
  // Variances 0.04, covariance -0.04, equal means.
  EXPECT_NEAR(ssim(p, q), (-0.08 + 9e-4) / (0.08 + 9e-4), 1e-3);
}

TEST(Ssim, FallsWithNoise) {
  const Image reference = wave(64, 64, 0.05, 0.03, 0.2, 0.4);
  double last = 1.0;
  for (float deviation : {0.01f, 0.03f, 0.1f}) {
    const Image noise = grey_noise(64, 64, 0.0f, deviation, 6);
    Image test = reference;
    for (std::size_t i = 0; i < test.pixels.size(); ++i) test.pixels[i] += noise.pixels[i];
    const double value = ssim(reference, test);
    EXPECT_LT(value, last - 0.01);
    last = value;
  }
}

TEST(Spectrum, OfWhiteNoiseIsItsVariance) {
  const Image reference = constant(240, 200, 1.0f);
  const Image test = grey_noise(240, 200, 3.0f, 0.5f, 7);
  const ErrorSpectrum spectrum = error_spectrum(reference, test, 20);
  ASSERT_EQ(spectrum.rings.size(), 20u);
  EXPECT_NEAR(spectrum.white, 0.25, 0.01);
  for (std::size_t i = 0; i < spectrum.rings.size(); ++i) {
    // A ring has about 240 * 200 pi / 4 (2 i + 1) / 400 frequencies, half of them independent; the
    // power at each has a standard deviation of its mean.
    const double independent = 240.0 * 200.0 * std::numbers::pi / 4.0 * (2.0 * double(i) + 1) / 800;
    EXPECT_NEAR(spectrum.rings[i].power, 0.25, 0.25 * 4.5 / std::sqrt(independent)) << i;
  }
}

TEST(Spectrum, OfAWaveIsOneRing) {
  for (const auto& [width, height] : {std::pair{80, 80}, {81, 57}, {64, 300}, {101, 67}}) {
    const double fx = 11.0 / width, fy = 9.0 / height;
    const ErrorSpectrum spectrum =
        error_spectrum(constant(width, height, 2.0f), wave(width, height, fx, fy, 0.3), 32);
    double total = 0.0, at_wave = 0.0;
    for (const SpectrumRing& ring : spectrum.rings) {
      total += ring.power;
      if (std::abs(ring.frequency - std::hypot(fx, fy)) < 1.0 / 128.0) at_wave += ring.power;
    }
    EXPECT_GT(at_wave, 0.999 * total) << width;
    EXPECT_GT(total, 0.01);
  }
}

TEST(Spectrum, OfBlurredNoiseIsRed) {
  const Image reference = constant(128, 96, 0.0f);
  const std::vector<float> weights = gaussian_weights(1.5f, 6);
  const Image test = separable_filter(grey_noise(128, 96, 0.0f, 1.0f, 10), weights, weights);
  const ErrorSpectrum spectrum = error_spectrum(reference, test);
  ASSERT_EQ(spectrum.rings.size(), 32u);
  EXPECT_GT(spectrum.rings[2].power, 5.0 * spectrum.white);
  EXPECT_LT(spectrum.rings[24].power, 0.05 * spectrum.white);
}

TEST(Spectrum, ObeysParseval) {
  // The mean power over all frequencies but zero, times their number, is the sum of squares of a
  // wave; so is that of one ring, which has those up to 1/2, where the wave is among them.
  const int width = 48, height = 36;
  double frequencies = 0.0;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const double f = std::hypot(double(std::min(x, width - x)) / width,
                                  double(std::min(y, height - y)) / height);
      frequencies += f > 0.0 && f <= 0.5;
    }
  }
  const Image reference = constant(width, height, 0.0f);
  for (const auto& [columns, rows] : {std::pair{0, 7}, {5, 7}, {24, 0}, {20, 16}}) {
    const Image test = wave(width, height, double(columns) / width, double(rows) / height, 1.0);
    const double squares = mse(reference, test) * width * height;
    const ErrorSpectrum spectrum = error_spectrum(reference, test, 1);
    const bool in_ring = columns != 20;  // a diagonal's frequency is 0.61
    EXPECT_NEAR(spectrum.white * (width * height - 1), squares, 1e-4 * squares) << columns;
    EXPECT_NEAR(spectrum.rings[0].power * frequencies, in_ring ? squares : 0.0, 1e-4 * squares)
        << columns;
  }
}

TEST(Spectrum, IsOfLuminance) {
  const Image reference = constant(32, 32, 0.0f);
  const Image noise = grey_noise(32, 32, 0.0f, 1.0f, 8);
  const double white = error_spectrum(reference, noise, 1).rings[0].power;
  const double weights[] = {0.2126, 0.7152, 0.0722};
  for (std::size_t c = 0; c < 3; ++c) {
    Image test = reference;
    for (std::size_t i = c; i < test.pixels.size(); i += 3) test.pixels[i] = noise.pixels[i];
    EXPECT_NEAR(error_spectrum(reference, test, 1).rings[0].power, weights[c] * weights[c] * white,
                1e-5);
  }
}

TEST(Spectrum, TakesImagesOfAnySize) {
  for (const auto& [width, height] : kOddSizes) {
    const ErrorSpectrum spectrum =
        error_spectrum(constant(width, height, 0.0f), grey_noise(width, height, 0.0f, 1.0f, 9), 16);
    EXPECT_TRUE(std::isfinite(spectrum.white));
    EXPECT_EQ(spectrum.rings.empty(), width * height == 1);
    for (const SpectrumRing& ring : spectrum.rings) {
      EXPECT_TRUE(std::isfinite(ring.power) && ring.power >= 0.0);
    }
  }
  const ErrorSpectrum offset = error_spectrum(constant(9, 9, 0.0f), constant(9, 9, 3.0f), 4);
  for (const SpectrumRing& ring : offset.rings) EXPECT_NEAR(ring.power, 0.0, 1e-12);
}

TEST(Spectrum, LeavesOutWhatMakesSidesSlow) {
  // 131 is prime; 130 = 2 * 5 * 13.
  const Image noise = grey_noise(131, 6, 0.0f, 1.0f, 13);
  Image shorter(130, 6, 3);
  for (int y = 0; y < 6; ++y) std::copy_n(noise.at(0, y), 3 * 130, shorter.at(0, y));
  const ErrorSpectrum all = error_spectrum(constant(131, 6, 0.0f), noise, 8);
  const ErrorSpectrum part = error_spectrum(constant(130, 6, 0.0f), shorter, 8);
  EXPECT_EQ(all.white, part.white);
  ASSERT_EQ(all.rings.size(), part.rings.size());
  for (std::size_t i = 0; i < all.rings.size(); ++i) {
    EXPECT_EQ(all.rings[i].power, part.rings[i].power);
  }
}

TEST(Spectrum, RingsWithoutAFrequencyAreLeftOut) {
  // 8 x 8 pixels have frequencies from 1/8 on: none in the first three of 16 rings to 1/2.
  const ErrorSpectrum spectrum =
      error_spectrum(constant(8, 8, 0.0f), grey_noise(8, 8, 0.0f, 1.0f, 11), 16);
  ASSERT_FALSE(spectrum.rings.empty());
  EXPECT_NEAR(spectrum.rings[0].frequency, 4.5 / 32.0, 1e-12);
  EXPECT_LT(spectrum.rings.size(), 16u);
}

TEST(Spectrum, AveragesPowerNotErrors) {
  // Opposite errors: their mean is none, the mean of their powers is that of either.
  const Image reference = constant(32, 32, 0.0f);
  const Image noise = grey_noise(32, 32, 0.0f, 1.0f, 12);
  Image opposite = noise;
  for (float& v : opposite.pixels) v = -v;
  const ErrorSpectrum one = error_spectrum(reference, noise);
  ErrorSpectrum mean;
  average_in(mean, one, 1);
  average_in(mean, error_spectrum(reference, opposite), 2);
  average_in(mean, error_spectrum(reference, reference), 3);
  ASSERT_EQ(mean.rings.size(), one.rings.size());
  EXPECT_NEAR(mean.white, one.white * 2.0 / 3.0, 1e-6);
  for (std::size_t i = 0; i < one.rings.size(); ++i) {
    EXPECT_EQ(mean.rings[i].frequency, one.rings[i].frequency);
    EXPECT_NEAR(mean.rings[i].power, one.rings[i].power * 2.0 / 3.0, 1e-5) << i;
  }
}

}  // namespace
}  // namespace lockstep::test_structural_error
