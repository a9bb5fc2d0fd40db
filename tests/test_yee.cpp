// Yee's perceptual difference: limits known by hand, and the counts of perceptualdiff.
#include "experiments/metrics/yee.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <random>

#ifndef LOCKSTEP_SHARED_DIR
#error "define LOCKSTEP_SHARED_DIR"
#endif

namespace lockstep::test_yee {
namespace {

float linear(int code) {
  const double v = code / 255.0;
  return float(v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4));
}

Image constant(int width, int height, int r, int g, int b) {
  Image image(width, height, 3);
  for (std::size_t i = 0; i < image.pixels.size(); i += 3) {
    image.pixels[i] = linear(r);
    image.pixels[i + 1] = linear(g);
    image.pixels[i + 2] = linear(b);
  }
  return image;
}

Image grey(int width, int height, int code) { return constant(width, height, code, code, code); }

Image noise(int width, int height, unsigned seed) {
  std::mt19937 random(seed);
  Image image(width, height, 3);
  for (float& v : image.pixels) v = linear(int(random() % 256));
  return image;
}

TEST(Yee, FindsNothingInEqualImages) {
  const Image image = noise(40, 30, 1);
  const YeeDifference difference = yee_difference(image, image);
  EXPECT_EQ(difference.pixels, 0u);
  for (float value : difference.failing.pixels) EXPECT_EQ(value, 0.0f);
}

TEST(Yee, FindsNothingBelowHalfACode) {
  const Image image = grey(20, 20, 128);
  Image test = image;
  for (float& v : test.pixels) v *= 1.0005f;  // 128.03
  EXPECT_EQ(yee_difference(image, test, {.luminance_only = true}).pixels, 0u);
}

TEST(Yee, FindsEveryPixelBlackAgainstGreyOrWhite) {
  for (int code : {128, 255}) {
    const YeeDifference difference = yee_difference(grey(50, 30, 0), grey(50, 30, code));
    EXPECT_EQ(difference.pixels, 1500u);
    for (float value : difference.failing.pixels) EXPECT_EQ(value, 1.0f);
  }
}

// The luminance of a grey, 100 cd/m^2 (code / 255)^2.2, and the least visible difference at the
// mean of two: between log10 = -0.0184 and 1.9 it is 10^((0.249 log10 + 0.65)^2.7 - 0.72).
TEST(Yee, ConstantImagesDifferFromTheThresholdOn) {
  const auto luminance = [](int code) { return 100.0 * std::pow(code / 255.0, 2.2); };
  const int p = 120;
  int found = 0, expected = 0;
  for (int q = p; q < p + 20; ++q) {
    const double adaptation = 0.5 * (luminance(p) + luminance(q));
    const double threshold =
        std::pow(10.0, std::pow(0.249 * std::log10(adaptation) + 0.65, 2.7) - 0.72);
    expected += luminance(q) - luminance(p) > threshold;
    // So wide that no band's threshold is much higher than others', which rounding would show.
    found +=
        yee_difference(grey(1024, 2, p), grey(1024, 2, q), {.luminance_only = true}).pixels == 2048;
  }
  EXPECT_EQ(found, expected);
  EXPECT_GT(found, 0);
  EXPECT_LT(found, 20);
}

TEST(Yee, ColourCountsWhereItIsBright) {
  // Of nearly equal luminance for Adobe RGB's weights 0.297, 0.627 and 0.075, exchanged as
  // perceptualdiff does: blue counts as much as red should.
  const Image p = constant(16, 16, 120, 120, 150), q = constant(16, 16, 120, 133, 120);
  EXPECT_EQ(yee_difference(p, q).pixels, 256u);
  EXPECT_EQ(yee_difference(p, q, {.luminance_only = true}).pixels, 0u);
  EXPECT_EQ(yee_difference(p, q, {.colour_factor = 0.0f}).pixels, 0u);
  // A display of a tenth of the luminance leaves less than 10 cd/m^2: colours are not told apart.
  EXPECT_EQ(yee_difference(p, q, {.luminance = 10.0f}).pixels, 0u);
}

TEST(Yee, IsSymmetric) {
  const Image p = noise(50, 40, 2);
  Image q = p;
  std::mt19937 random(3);
  for (float& v : q.pixels) v *= 0.6f + 0.4f * float(random() % 1000) / 1000.0f;
  const std::size_t pixels = yee_difference(p, q).pixels;
  EXPECT_EQ(yee_difference(q, p).pixels, pixels);
  EXPECT_GT(pixels, 0u);
}

TEST(Yee, MasksErrorsInBusySurroundings) {
  const int size = 64;
  Image calm = grey(size, size, 120), busy = calm;
  std::mt19937 random(4);
  for (std::size_t i = 0; i < calm.pixels.size(); i += 3) {
    const float v = linear(20 + int(random() % 200));
    for (std::size_t c = 0; c < 3; ++c) busy.pixels[i + c] = v;
  }
  // A disturbance by so many codes wherever the eye could compare it with its surroundings.
  const auto found = [&](const Image& image, int codes) {
    Image test = image;
    for (int y = 4; y < size; y += 8) {
      for (int x = 4; x < size; x += 8) {
        const float v = linear(120 + codes);
        for (int c = 0; c < 3; ++c) test.at(x, y)[c] += v - linear(120);
      }
    }
    return yee_difference(image, test, {.luminance_only = true}).pixels;
  };
  std::size_t in_calm = 0, in_busy = 0;
  for (int codes = 2; codes < 60; codes += 2) {
    in_calm += found(calm, codes);
    in_busy += found(busy, codes);
  }
  EXPECT_GT(in_calm, 0u);
  EXPECT_LT(in_busy, in_calm);
}

TEST(Yee, TakesImagesOfAnySize) {
  for (const auto& [width, height] : {std::pair{1, 1}, {1, 300}, {300, 1}, {2, 2}, {7, 5}}) {
    const YeeDifference difference =
        yee_difference(noise(width, height, 5), noise(width, height, 6));
    EXPECT_LE(difference.pixels, std::size_t(width * height));
    EXPECT_EQ(difference.failing.pixels.size(), std::size_t(width * height));
  }
  EXPECT_EQ(yee_difference(grey(1, 1, 0), grey(1, 1, 255)).pixels, 1u);
}

struct Golden {
  const char *reference, *test;
  YeeSettings settings;
  double pixels;
};

class YeeGolden : public testing::TestWithParam<Golden> {};

TEST_P(YeeGolden, AgreesWithPerceptualdiff) {
  const std::string folder = LOCKSTEP_SHARED_DIR "/metrics/";
  const Golden& golden = GetParam();
  if (!std::filesystem::exists(folder + golden.reference)) {
    GTEST_SKIP() << "skipped: no " << folder << golden.reference;
  }
  const YeeDifference difference = yee_difference(
      read_image(folder + golden.reference), read_image(folder + golden.test), golden.settings);
  RecordProperty("pixels", std::to_string(difference.pixels));
  EXPECT_NEAR(double(difference.pixels), golden.pixels, std::max(1.0, 0.001 * golden.pixels));
}

constexpr YeeSettings kDefaults;
constexpr YeeSettings kLuminance{.field_of_view = 27.0f, .luminance_only = true};

INSTANTIATE_TEST_SUITE_P(
    Images, YeeGolden,
    testing::Values(Golden{"cornell_ref.png", "cornell_random_64.png", kDefaults, 7921},
                    Golden{"cornell_ref.png", "cornell_random_64.png", kLuminance, 2},
                    Golden{"cornell_ref.png", "cornell_shared_64.png", kDefaults, 4077},
                    Golden{"cornell_ref.png", "cornell_shared_64.png", kLuminance, 0},
                    Golden{"killeroo_ref.png", "killeroo_random_16.png", kDefaults, 6740},
                    Golden{"killeroo_ref.png", "killeroo_random_16.png", kLuminance, 78},
                    Golden{"killeroo_ref.png", "killeroo_shared_16.png", kDefaults, 1170},
                    Golden{"killeroo_ref.png", "killeroo_shared_16.png", kLuminance, 1007},
                    Golden{"killeroo_ref.png", "killeroo_zsobol_16.png", kDefaults, 684},
                    Golden{"killeroo_ref.png", "killeroo_zsobol_16.png", kLuminance, 2}));

}  // namespace
}  // namespace lockstep::test_yee
