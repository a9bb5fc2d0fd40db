// Weight maps against values worked out by hand.
#include "samplers/weight_map.h"

#include "core/hash.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace lockstep::test_weight_map {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

// A grey image from its rows.
Image grey(int width, const std::vector<float>& values) {
  Image image(width, int(values.size()) / width);
  for (std::size_t i = 0; i < values.size(); ++i) {
    std::fill_n(&image.pixels[i * 3], 3, values[i]);
  }
  return image;
}

std::vector<float> channel(const Image& image, int c) {
  std::vector<float> values;
  for (std::size_t i = size_t(c); i < image.pixels.size(); i += size_t(image.channels)) {
    values.push_back(image.pixels[i]);
  }
  return values;
}

std::vector<float> weights(const Image& image, float c, float t) {
  const Image w = make_weights(image, {c, t, WeightFilter::None});
  EXPECT_EQ(w.channels, 1);
  EXPECT_EQ(w.width, image.width);
  EXPECT_EQ(w.height, image.height);
  return w.pixels;
}

using Values = std::vector<float>;

TEST(RelativeDifference, IsZeroBetweenEqualPixels) {
  for (const float value : {0.0f, 1e-30f, 0.5f, 1e30f}) {
    const Image image = grey(3, Values(9, value));
    for (int i = 0; i < 9; ++i) EXPECT_EQ(relative_difference(image, i % 3, i / 3), 0.0f);
  }
  EXPECT_EQ(relative_difference(grey(1, {3.0f}), 0, 0), 0.0f);
}

TEST(RelativeDifference, IsOneBetweenBlackAndAnyLight) {
  const Image image = grey(4, {0, 0, 1e-20f, 0});
  EXPECT_EQ(relative_difference(image, 0, 0), 0.0f);
  EXPECT_EQ(relative_difference(image, 1, 0), 1.0f);
  EXPECT_EQ(relative_difference(image, 2, 0), 1.0f);
  EXPECT_EQ(relative_difference(image, 3, 0), 1.0f);
}

TEST(RelativeDifference, TakesTheLargestOverChannelsAndNeighbours) {
  Image image = grey(3, Values(9, 2.0f));
  image.at(2, 2)[1] = 1.0f;  // green: |2 - 1| / 2
  EXPECT_EQ(relative_difference(image, 1, 1), 0.5f);
  EXPECT_EQ(relative_difference(image, 2, 2), 0.5f);
  EXPECT_EQ(relative_difference(image, 0, 0), 0.0f);  // two pixels away
  image.at(0, 1)[2] = 8.0f;                           // blue: |2 - 8| / 8
  EXPECT_EQ(relative_difference(image, 1, 1), 0.75f);
  EXPECT_EQ(relative_difference(image, 2, 2), 0.5f);
}

TEST(RelativeDifference, SeesAllEightNeighbours) {
  for (int i = 0; i < 9; ++i) {
    Values values(9, 1.0f);
    values[size_t(i)] = 4.0f;
    EXPECT_EQ(relative_difference(grey(3, values), 1, 1), 0.75f) << i;
  }
}

TEST(RelativeDifference, StaysInsideTheImage) {
  // Row ends must not meet the next row's beginning.
  const Image image = grey(3, {1, 1, 5, 1, 1, 5, 1, 1, 5});
  for (int y = 0; y < 3; ++y) {
    EXPECT_EQ(relative_difference(image, 0, y), 0.0f);
    EXPECT_EQ(relative_difference(image, 1, y), 0.8f);
    EXPECT_EQ(relative_difference(image, 2, y), 0.8f);
  }
}

TEST(WeightMap, IsCTimesTheDifferenceFromTheThresholdOn) {
  const Image image = grey(5, {1, 1, 2, 2, 2});  // d = 0, .5, .5, 0, 0
  EXPECT_EQ(weights(image, 1.0f, 0.0f), (Values{0, 0.5f, 0.5f, 0, 0}));
  EXPECT_EQ(weights(image, 0.5f, 0.25f), (Values{0, 0.25f, 0.25f, 0, 0}));
  EXPECT_EQ(weights(image, 1.0f, 0.5f), (Values{0, 0.5f, 0.5f, 0, 0}));  // d = t counts
  EXPECT_EQ(weights(image, 1.0f, std::nextafter(0.5f, 1.0f)), Values(5, 0.0f));
}

TEST(WeightMap, IsAtMostOne) {
  const Image image = grey(5, {1, 1, 2, 2, 2});
  EXPECT_EQ(weights(image, 2.0f, 0.0f), (Values{0, 1, 1, 0, 0}));
  EXPECT_EQ(weights(image, 3.0f, 0.0f), (Values{0, 1, 1, 0, 0}));
  EXPECT_EQ(weights(image, 1e38f, 0.0f), (Values{0, 1, 1, 0, 0}));
  EXPECT_EQ(weights(image, infinity, 0.0f), (Values{0, 1, 1, 0, 0}));
}

TEST(WeightMap, ExtremeParametersShareAllOrNothing) {
  const Image image = grey(3, {0, 1, 7});
  EXPECT_EQ(weights(image, 0.0f, 0.0f), Values(3, 0.0f));
  EXPECT_EQ(weights(image, 4.0f, infinity), Values(3, 0.0f));
  EXPECT_EQ(weights(image, infinity, infinity), Values(3, 0.0f));
  EXPECT_EQ(weights(grey(3, Values(9, 1.0f)), infinity, 0.0f), Values(9, 0.0f));
  EXPECT_EQ(weights(grey(3, Values(9, 0.0f)), infinity, 0.0f), Values(9, 0.0f));
}

TEST(PilotFilter, NoneLeavesTheImageAlone) {
  const Image image = grey(3, {1, 2, 3, 4, 5, 6, 7, 8, 9});
  EXPECT_EQ(filter_pilot(image, WeightFilter::None).pixels, image.pixels);
}

TEST(PilotFilter, GaussianIsFiveWideWithUnitSigma) {
  // The response to a single light pixel is the kernel; rows and columns separate.
  Values delta(81, 0.0f);
  delta[4 * 9 + 4] = 1.0f;
  const Image out = filter_pilot(grey(9, delta), WeightFilter::Gaussian);
  const double g[] = {1.0, std::exp(-0.5), std::exp(-2.0)};
  const double total = g[0] + 2.0 * g[1] + 2.0 * g[2];
  for (int y = 0; y < 9; ++y) {
    for (int x = 0; x < 9; ++x) {
      const int dx = std::abs(x - 4), dy = std::abs(y - 4);
      const double expected = dx > 2 || dy > 2 ? 0.0 : g[dx] * g[dy] / (total * total);
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(out.at(x, y)[c], expected, 1e-7) << x << ' ' << y;
    }
  }
}

TEST(PilotFilter, GaussianIsNormalisedAtTheBorder) {
  Values delta(25, 0.0f);
  delta[0] = 1.0f;
  const Image out = filter_pilot(grey(5, delta), WeightFilter::Gaussian);
  const double side = 1.0 + std::exp(-0.5) + std::exp(-2.0);  // what a corner keeps of the kernel
  EXPECT_NEAR(out.at(0, 0)[0], 1.0 / (side * side), 1e-6);
  EXPECT_NEAR(out.at(1, 0)[0], std::exp(-0.5) / ((side + std::exp(-0.5)) * side), 1e-6);
  const Image flat = filter_pilot(grey(5, Values(25, 3.0f)), WeightFilter::Gaussian);
  for (const float value : flat.pixels) EXPECT_NEAR(value, 3.0f, 1e-6f);
}

TEST(PilotFilter, MedianTakesTheMiddleOfNine) {
  const Image image = grey(3, {9, 1, 8, 2, 7, 3, 6, 4, 5});
  EXPECT_EQ(filter_pilot(image, WeightFilter::Median).at(1, 1)[0], 5.0f);
}

TEST(PilotFilter, MedianTakesTheLowerMiddleAtTheBorder) {
  const Values expected{2, 3, 3,   // corners: 2nd of 4; edges: 3rd of 6
                        4, 5, 5,   //
                        5, 6, 6};  //
  const Image image = grey(3, {1, 2, 3, 4, 5, 6, 7, 8, 9});
  EXPECT_EQ(channel(filter_pilot(image, WeightFilter::Median), 0), expected);
}

TEST(PilotFilter, MedianRemovesAFireflyFromEachChannelByItself) {
  Image image = grey(3, Values(9, 1.0f));
  image.at(1, 1)[0] = 1e6f;
  image.at(0, 0)[1] = 0.0f;
  const Image out = filter_pilot(image, WeightFilter::Median);
  for (const float value : out.pixels) EXPECT_EQ(value, 1.0f);
  const Image w = make_weights(image, {4.0f, 0.0f, WeightFilter::Median});
  EXPECT_EQ(w.pixels, Values(9, 0.0f));
}

TEST(WeightMap, TakesDifferencesAfterTheFilter) {
  // A light pixel in the middle of 5x5 reaches the corner with exp(-4) of its peak, but every
  // pixel's filtered neighbour towards the middle is larger by exp(.5), exp(1) or exp(1.5).
  Values delta(25, 0.0f);
  delta[12] = 1.0f;
  const Image image = grey(5, delta);
  const Image w = make_weights(image, {0.5f, 0.0f, WeightFilter::Gaussian});
  const Image filtered = filter_pilot(image, WeightFilter::Gaussian);
  const double a = filtered.at(0, 0)[0], b = filtered.at(1, 1)[0];
  EXPECT_NEAR(*w.at(0, 0), 0.5 * (b - a) / b, 1e-6);
}

// Automatic weights -----------------------------------------------------------------------------

Values auto_weights(const Image& pilot, const Image& variance, double ratio) {
  const Image w = make_auto_weights(pilot, variance, ratio);
  EXPECT_EQ(w.channels, 1);
  EXPECT_EQ(w.width, pilot.width);
  EXPECT_EQ(w.height, pilot.height);
  return w.pixels;
}

TEST(AutoWeights, WithoutNoiseAllIsShared) {
  const Image pilot = grey(4, {0, 1, 5, 1e30f, 2, 0, 0, 1e-20f});
  for (const double ratio : {0.0, 1.0, 1e9}) {
    EXPECT_EQ(auto_weights(pilot, grey(4, Values(8, 0.0f)), ratio), Values(8, 0.0f));
  }
  EXPECT_EQ(auto_weights(pilot, grey(4, Values(8, 3.0f)), 0.0), Values(8, 0.0f));
}

TEST(AutoWeights, WhereNoiseIsSeenNothingIsShared) {
  for (const float level : {0.0f, 0.01f, 1.0f, 100.0f}) {
    const float deviation = 0.02f * (level + 0.01f);
    const Image variance = grey(3, Values(9, deviation * deviation));
    EXPECT_EQ(auto_weights(grey(3, Values(9, level)), variance, 1.0), Values(9, 1.0f)) << level;
  }
}

// Contrast over one per cent, in flat images: sqrt(ratio * variance) / (level + 0.01) / 0.01.
TEST(AutoWeights, AreTheContrastOfNoiseBelowTheThreshold) {
  const Image pilot = grey(3, Values(9, 0.99f));
  for (const double contrast : {0.001, 0.0025, 0.009}) {
    for (const double ratio : {0.25, 1.0, 3.0}) {
      const Image variance = grey(3, Values(9, float(contrast * contrast / ratio)));
      for (const float w : auto_weights(pilot, variance, ratio)) {
        EXPECT_NEAR(w, 100.0 * contrast, 1e-5);
      }
    }
  }
}

TEST(AutoWeights, TheNoisiestChannelCounts) {
  Image variance(3, 3);
  for (int i = 0; i < 9; ++i) variance.pixels[size_t(3 * i + 1)] = 1e-5f;
  const Values one = auto_weights(grey(3, Values(9, 0.99f)), variance, 1.0);
  const Values all = auto_weights(grey(3, Values(9, 0.99f)), grey(3, Values(9, 1e-5f)), 1.0);
  EXPECT_EQ(one, all);
  EXPECT_NEAR(all[4], 100.0 * std::sqrt(1e-5), 1e-4);
}

// With noise, without light: contrasts are taken to the darkest grey that is seen.
TEST(AutoWeights, GrowWithNoiseAndFallWithLight) {
  Values previous(16, -1.0f);
  for (const double ratio : {0.0, 1e-8, 1e-6, 1e-4, 1e-2, 1.0, 100.0, 1e12}) {
    Image variance = grey(4, Values(16, 1e-4f));
    variance.at(2, 1)[0] = 0.5f;
    const Values w = auto_weights(grey(4, Values(16, 0.5f)), variance, ratio);
    for (std::size_t i = 0; i < w.size(); ++i) EXPECT_GE(w[i], previous[i]) << ratio;
    previous = w;
  }
  EXPECT_EQ(previous, Values(16, 1.0f));
  float before = 2.0f;
  for (const float level : {0.0f, 0.1f, 1.0f, 10.0f, 1e6f}) {
    const Image variance = grey(3, Values(9, 1e-8f));
    const float w = auto_weights(grey(3, Values(9, level)), variance, 1.0)[4];
    EXPECT_LT(w, before) << level;
    before = w;
  }
}

TEST(NeighbourVariance, IsTheNoiseOfFlatImages) {
  Image pilot(64, 64);
  for (std::size_t i = 0; i < pilot.pixels.size(); ++i) {
    // Uniform noise of width 0.3 on a high level: variance 0.3^2 / 12.
    pilot.pixels[i] = 1000.0f + 0.3f * unit_float(pcg3d(std::uint32_t(i), 5u, 9u).x);
  }
  const Image v = variance_of_neighbours(pilot);
  const double sum = std::accumulate(v.pixels.begin(), v.pixels.end(), 0.0);
  EXPECT_NEAR(sum / double(v.pixels.size()), 0.3 * 0.3 / 12.0, 0.0075 * 0.05);
}

TEST(NeighbourVariance, SeesEdgesAndNothingElse) {
  const Values row{1, 1, 1, 1, 3, 3, 3, 3};
  const Image v = variance_of_neighbours(grey(8, row));
  for (int x : {0, 1, 2, 5, 6, 7}) EXPECT_EQ(v.at(x, 0)[0], 0.0f) << x;
  EXPECT_NEAR(v.at(3, 0)[0], 4.0 / 3.0, 1e-6);  // of 1, 1, 3
  EXPECT_EQ(variance_of_neighbours(grey(1, {5})).pixels[0], 0.0f);
}

// What a pilot with a firefly, an overflow or no light at all may hold.
TEST(AutoWeights, LieInTheUnitIntervalWhateverThePilot) {
  constexpr float huge = std::numeric_limits<float>::max();
  const float levels[] = {0.0f, 1e-30f, 1.0f, 1e30f, huge};
  const float variances[] = {0.0f, 1e-40f, 1e-20f, 1.0f, huge, infinity};
  for (const float level : levels) {
    for (const float variance : variances) {
      for (const double ratio : {0.0, 1e-300, 1.0, 1e300}) {
        Image v = grey(5, Values(25, 1e-3f));
        Image p = grey(5, Values(25, 0.5f));
        std::fill_n(v.at(2, 2), 3, variance);
        std::fill_n(p.at(2, 2), 3, level);
        for (const float w : auto_weights(p, v, ratio)) {
          EXPECT_TRUE(w >= 0.0f && w <= 1.0f)
              << w << ' ' << level << ' ' << variance << ' ' << ratio;
        }
      }
    }
  }
}

TEST(WeightMap, LiesInTheUnitIntervalWhateverThePilot) {
  for (const float level :
       {0.0f, 1e-40f, 1.0f, 1e30f, std::numeric_limits<float>::max(), infinity}) {
    for (const WeightFilter filter :
         {WeightFilter::None, WeightFilter::Gaussian, WeightFilter::Median}) {
      Image p = grey(5, Values(25, 0.5f));
      std::fill_n(p.at(2, 2), 3, level);
      const Image map = make_weights(p, {4.0f, 0.02f, filter});
      for (const float w : map.pixels) EXPECT_TRUE(w >= 0.0f && w <= 1.0f) << w << ' ' << level;
    }
  }
}

TEST(ShareOfZeros, CountsThem) {
  Image w(2, 2, 1);
  w.pixels = {0.0f, 1.0f, 0.0f, 1e-30f};
  EXPECT_DOUBLE_EQ(share_of_zeros(w), 0.5);
  w.pixels = {1.0f, 1.0f, 1.0f, 1.0f};
  EXPECT_DOUBLE_EQ(share_of_zeros(w), 0.0);
  EXPECT_DOUBLE_EQ(share_of_zeros(make_weights(grey(2, Values(4, 1.0f)), {})), 1.0);
  EXPECT_DOUBLE_EQ(share_of_zeros(Image()), 0.0);
}

TEST(MeanWeight, IsTheMean) {
  Image w(2, 2, 1);
  w.pixels = {0.0f, 1.0f, 0.5f, 0.25f};
  EXPECT_DOUBLE_EQ(mean_weight(w), 0.4375);
  EXPECT_DOUBLE_EQ(mean_weight(Image()), 0.0);
}

}  // namespace
}  // namespace lockstep::test_weight_map
