// FLIP against values worked out by hand, and against those of the authors' program.
#include "experiments/metrics/flip.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <random>

#ifndef LOCKSTEP_SHARED_DIR
#error "define LOCKSTEP_SHARED_DIR"
#endif

namespace lockstep::test_flip {
namespace {

Image constant(int width, int height, float value) {
  Image image(width, height, 3);
  for (float& v : image.pixels) v = value;
  return image;
}

Image noise(int width, int height, unsigned seed, float largest = 1.0f) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform(0.0f, largest);
  Image image(width, height, 3);
  for (float& v : image.pixels) v = uniform(random);
  return image;
}

double ldr(const Image& reference, const Image& test) {
  return mean_of_map(flip_ldr_map(reference, test));
}

double hdr(const Image& reference, const Image& test) {
  return mean_of_map(flip_hdr_map(reference, test));
}

// CIELAB of a linear colour relative to the white of Rec. 709, in double precision.
struct Lab {
  double l, a, b;
};
Lab lab_of(double r, double g, double b) {
  const auto curve = [](double t) {
    return t > 216.0 / 24389.0 ? std::cbrt(t) : (24389.0 / 27.0 * t + 16.0) / 116.0;
  };
  // Rows of the matrix from RGB to XYZ; white's XYZ are their sums.
  const double x = curve((0.4123864 * r + 0.3575915 * g + 0.1804505 * b) / 0.9504284);
  const double y = curve(0.2126368 * r + 0.7151830 * g + 0.0721802 * b);
  const double z = curve((0.0193306 * r + 0.1191972 * g + 0.9503726 * b) / 1.0889004);
  return {116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)};
}

// FLIP's colour difference of two constant images, where no feature helps (Andersson et al. 2020).
double constant_flip(const Lab& p, const Lab& q) {
  const auto distance = [](const Lab& u, const Lab& v) {
    const double a = 0.01 * (u.l * u.a - v.l * v.a), b = 0.01 * (u.l * u.b - v.l * v.b);
    return std::pow(std::abs(u.l - v.l) + std::hypot(a, b), 0.7);
  };
  const double largest = distance(lab_of(0, 1, 0), lab_of(0, 0, 1));
  const double turn = 0.4 * largest, d = distance(p, q);
  return d < turn ? 0.95 * d / turn : 0.95 + 0.05 * (d - turn) / (largest - turn);
}

TEST(Flip, OfEqualImagesIsZero) {
  const Image image = noise(33, 21, 1, 3.0f);
  EXPECT_EQ(ldr(image, image), 0.0);
  EXPECT_EQ(hdr(image, image), 0.0);
}

TEST(Flip, OfTwoGreysIsTheirColourDifference) {
  for (const auto& [p, q] : {std::pair{0.2, 0.21}, {0.05, 0.5}, {0.0, 1.0}, {0.002, 0.006}}) {
    const double expected = constant_flip(lab_of(p, p, p), lab_of(q, q, q));
    EXPECT_NEAR(ldr(constant(30, 17, float(p)), constant(30, 17, float(q))), expected, 2e-5)
        << p << " and " << q;
  }
}

TEST(Flip, OfTwoColoursIsTheirColourDifference) {
  Image p(25, 25, 3), q(25, 25, 3);
  for (int i = 0; i < 25 * 25; ++i) {
    p.pixels[std::size_t(3 * i)] = 0.6f;
    q.pixels[std::size_t(3 * i + 1)] = 0.3f;
    q.pixels[std::size_t(3 * i + 2)] = 0.9f;
  }
  EXPECT_NEAR(ldr(p, q), constant_flip(lab_of(0.6, 0, 0), lab_of(0, 0.3, 0.9)), 2e-5);
}

TEST(Flip, OfBlackAndWhiteIsNearOne) {
  const double value = ldr(constant(16, 16, 0.0f), constant(16, 16, 1.0f));
  EXPECT_NEAR(value, constant_flip(lab_of(0, 0, 0), lab_of(1, 1, 1)), 2e-5);
  EXPECT_GT(value, 0.95);
  EXPECT_LT(value, 1.0);
}

TEST(Flip, IsSymmetric) {
  const Image p = noise(40, 30, 2), q = noise(40, 30, 3);
  EXPECT_NEAR(ldr(p, q), ldr(q, p), 1e-6);
}

TEST(Flip, IsMirroredWithTheImages) {
  const Image p = noise(301, 150, 4), q = noise(301, 150, 5);  // tiles end elsewhere
  const auto mirrored = [](const Image& image) {
    Image result(image.width, image.height, image.channels);
    for (int y = 0; y < image.height; ++y) {
      for (int x = 0; x < image.width; ++x) {
        std::copy_n(image.at(image.width - 1 - x, image.height - 1 - y), image.channels,
                    result.at(x, y));
      }
    }
    return result;
  };
  const Image expected = mirrored(flip_ldr_map(p, q));
  const Image map = flip_ldr_map(mirrored(p), mirrored(q));
  for (std::size_t i = 0; i < map.pixels.size(); ++i) {
    ASSERT_NEAR(map.pixels[i], expected.pixels[i], 1e-4) << i;
  }
}

TEST(Flip, ClampsWhatADisplayCannotShow) {
  Image p = noise(20, 20, 6), q = noise(20, 20, 7);
  Image bright = p, dark = q;
  p.at(3, 4)[0] = 1.0f;
  bright.at(3, 4)[0] = 50.0f;
  q.at(9, 9)[1] = 0.0f;
  dark.at(9, 9)[1] = -2.0f;
  EXPECT_EQ(ldr(p, q), ldr(bright, dark));
}

TEST(Flip, PunishesBlotchesMoreThanFineNoise) {
  const int size = 128;
  const Image reference = constant(size, size, 0.3f);
  Image fine = reference, coarse = reference;
  std::mt19937 random(8);
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      const float sign = random() & 1 ? 0.06f : -0.06f;
      for (int c = 0; c < 3; ++c) {
        fine.at(x, y)[c] += sign;
        coarse.at(x, y)[c] += (x / 16 + y / 16) % 2 ? 0.06f : -0.06f;
      }
    }
  }
  EXPECT_GT(ldr(reference, coarse), 1.3 * ldr(reference, fine));
}

TEST(Flip, LargerPixelsMakeNoiseMoreVisible) {
  const Image reference = constant(64, 64, 0.3f);
  Image test = noise(64, 64, 9);
  for (float& v : test.pixels) v = 0.2f + 0.2f * v;
  EXPECT_GT(mean_of_map(flip_ldr_map(reference, test, 20.0f)),
            1.2 * mean_of_map(flip_ldr_map(reference, test, 67.0f)));
}

TEST(Flip, TakesImagesOfAnySize) {
  for (const auto& [width, height] : {std::pair{1, 1}, {1, 300}, {300, 1}, {7, 5}, {17, 129}}) {
    const Image p = noise(width, height, 10), q = noise(width, height, 11);
    for (const Image& map : {flip_ldr_map(p, q), flip_hdr_map(p, q)}) {
      ASSERT_EQ(map.width, width);
      ASSERT_EQ(map.height, height);
      ASSERT_EQ(map.channels, 1);
      for (float value : map.pixels) ASSERT_TRUE(value >= 0.0f && value <= 1.0f) << value;
    }
  }
}

TEST(HdrFlip, ExposuresShowBrightestAndMedianJustBelowWhite) {
  // The ACES curve reaches 0.85 at x: 0.36 (2.51 - 0.85 * 2.43) x^2 + ... = 0.
  const double a = 0.36 * (2.51 - 0.85 * 2.43), b = 0.6 * (0.03 - 0.85 * 0.59), c = -0.85 * 0.14;
  const double x = (-b + std::sqrt(b * b - 4.0 * a * c)) / (2.0 * a);
  Image image = constant(5, 5, 0.25f);
  for (int i = 0; i < 3; ++i) image.at(2, 2)[i] = 40.0f;
  const Exposures exposures = flip_exposures(image);
  EXPECT_NEAR(exposures.start, std::log2(x / 40.0), 1e-4);
  EXPECT_NEAR(exposures.stop, std::log2(x / 0.25), 1e-4);
  EXPECT_EQ(exposures.count, 8);  // log2(160) = 7.3
}

TEST(HdrFlip, TakesTheMedianOfWhatIsNotBlack) {
  Image image = constant(4, 4, 0.0f);
  for (int i = 0; i < 3; ++i) {
    image.at(0, 0)[i] = 1.0f;
    image.at(1, 0)[i] = 2.0f;
    image.at(2, 0)[i] = 16.0f;
  }
  const Exposures exposures = flip_exposures(image);
  EXPECT_NEAR(exposures.stop - exposures.start, 3.0, 1e-5);
  const Exposures black = flip_exposures(constant(4, 4, 0.0f));
  EXPECT_EQ(black.start, 0.0f);
  EXPECT_EQ(black.stop, 0.0f);
  EXPECT_EQ(black.count, 2);
  EXPECT_GT(hdr(constant(4, 4, 0.0f), constant(4, 4, 1.0f)), 0.5);
}

TEST(HdrFlip, SeesDifferencesAboveDisplayWhite) {
  const Image reference = constant(24, 24, 20.0f), test = constant(24, 24, 30.0f);
  EXPECT_EQ(ldr(reference, test), 0.0);
  EXPECT_GT(hdr(reference, test), 0.02);
}

TEST(HdrFlip, IsTheSameForBrighterImages) {
  const Image p = noise(32, 32, 12), q = noise(32, 32, 13);
  Image brighter_p = p, brighter_q = q;
  for (float& v : brighter_p.pixels) v *= 64.0f;
  for (float& v : brighter_q.pixels) v *= 64.0f;
  EXPECT_NEAR(hdr(p, q), hdr(brighter_p, brighter_q), 1e-5);
}

TEST(HdrFlip, TellsTheExposureOfTheLargestError) {
  // The brightest pixels differ most where the first exposure shows them, the others far later.
  Image reference = constant(200, 24, 0.01f);
  for (int y = 0; y < 24; ++y) {
    for (int x = 150; x < 200; ++x) {
      for (int c = 0; c < 3; ++c) reference.at(x, y)[c] = 100.0f;
    }
  }
  Image test = reference;
  for (float& v : test.pixels) v *= 1.3f;
  const HdrFlip flip = FlipReference(reference).hdr_map(test);
  EXPECT_GT(*flip.exposure.at(20, 12), 0.5f);
  EXPECT_EQ(*flip.exposure.at(180, 12), 0.0f);
}

TEST(FlipReference, GivesTheSameBitsHoweverMuchIsKept) {
  const Image reference = noise(150, 70, 14, 40.0f), test = noise(150, 70, 15, 40.0f);
  const Image ldr = flip_ldr_map(reference, test), hdr = flip_hdr_map(reference, test);
  const std::size_t side = 5 * 4 * 4 * kFlipTileWidth * kFlipTileHeight;  // of four tiles
  for (const std::size_t bytes : {side / 2, side, 3 * side, 100 * side}) {
    const FlipReference kept(reference, kPixelsPerDegree, bytes);
    EXPECT_EQ(kept.ldr_map(test).pixels, ldr.pixels) << bytes;
    EXPECT_EQ(kept.hdr_map(test).map.pixels, hdr.pixels) << bytes;
  }
}

TEST(Flip, HasTheSameBitsForAnyNumberOfThreads) {
  const Image p = noise(300, 140, 16, 8.0f), q = noise(300, 140, 17, 8.0f);
  const auto with_threads = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return flip_hdr_map(p, q).pixels;
  };
  EXPECT_EQ(with_threads(1), with_threads(4));
}

struct Golden {
  const char *reference, *test;
  bool high_range;
  double mean, largest;  // largest 0 where it is not known
};

class FlipGolden : public testing::TestWithParam<Golden> {};

TEST_P(FlipGolden, AgreesWithTheAuthorsProgram) {
  const std::string folder = LOCKSTEP_SHARED_DIR "/metrics/";
  const Golden& golden = GetParam();
  if (!std::filesystem::exists(folder + golden.reference)) {
    GTEST_SKIP() << "skipped: no " << folder << golden.reference;
  }
  const Image reference = read_image(folder + golden.reference);
  const Image test = read_image(folder + golden.test);
  const Image map =
      golden.high_range ? flip_hdr_map(reference, test) : flip_ldr_map(reference, test);
  RecordProperty("mean", std::to_string(mean_of_map(map)));
  EXPECT_NEAR(mean_of_map(map), golden.mean, 1e-5);
  if (golden.largest > 0.0) {
    EXPECT_NEAR(*std::max_element(map.pixels.begin(), map.pixels.end()), golden.largest, 1e-4);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Images, FlipGolden,
    testing::Values(Golden{"cornell_ref.png", "cornell_random_64.png", false, 0.054393, 0},
                    Golden{"cornell_ref.png", "cornell_shared_64.png", false, 0.092815, 0},
                    Golden{"killeroo_ref.png", "killeroo_random_16.png", false, 0.100287, 0},
                    Golden{"killeroo_ref.png", "killeroo_shared_16.png", false, 0.130010, 0},
                    Golden{"killeroo_ref.png", "killeroo_zsobol_16.png", false, 0.043501, 0},
                    Golden{"hdr-noise_ref.exr", "hdr-noise_test.exr", true, 0.061868, 0.943223},
                    Golden{"hdr-smooth_ref.exr", "hdr-smooth_test.exr", true, 0.071338, 0.159553}));

TEST(HdrFlipGolden, ExposuresAreThoseOfTheAuthorsProgram) {
  const std::string folder = LOCKSTEP_SHARED_DIR "/metrics/";
  if (!std::filesystem::exists(folder + "hdr-noise_ref.exr")) {
    GTEST_SKIP() << "skipped: no " << folder;
  }
  const Exposures noisy = flip_exposures(read_image(folder + "hdr-noise_ref.exr"));
  EXPECT_NEAR(noisy.start, -7.824084, 2e-5);
  EXPECT_NEAR(noisy.stop, 9.373848, 2e-5);
  EXPECT_EQ(noisy.count, 18);
  const Exposures smooth = flip_exposures(read_image(folder + "hdr-smooth_ref.exr"));
  EXPECT_NEAR(smooth.start, -6.400715, 2e-5);
  EXPECT_NEAR(smooth.stop, 3.306914, 2e-5);
  EXPECT_EQ(smooth.count, 10);
}

}  // namespace
}  // namespace lockstep::test_flip
