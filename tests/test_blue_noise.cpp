// The blue-noise mask, and the offsets that pixels take from it.
#include "samplers/blue_noise_mask.h"
#include "tests/t_samples.h"

#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <random>
#include <set>

namespace lockstep::test_blue_noise {
namespace {

constexpr int side = blue_noise_side;
constexpr int cells = side * side;
static_assert(side == 64);

using Field = std::vector<double>;  // side x side values

// The power at every frequency: |sum over cells of x exp(-2 pi i f.p)|^2 / cells, rows first.
Field power_spectrum(const Field& field) {
  using Complex = std::complex<double>;
  std::array<Complex, side> wave;
  for (int i = 0; i < side; ++i) {
    wave[std::size_t(i)] = std::polar(1.0, -2.0 * std::numbers::pi * i / side);
  }
  std::vector<Complex> rows(cells), all(cells);
  for (int y = 0; y < side; ++y) {
    for (int f = 0; f < side; ++f) {
      Complex sum = 0.0;
      for (int x = 0; x < side; ++x) {
        sum += field[std::size_t(y * side + x)] * wave[std::size_t(f * x % side)];
      }
      rows[std::size_t(y * side + f)] = sum;
    }
  }
  Field power(cells);
  for (int f = 0; f < side; ++f) {
    for (int g = 0; g < side; ++g) {
      Complex sum = 0.0;
      for (int y = 0; y < side; ++y) {
        sum += rows[std::size_t(y * side + f)] * wave[std::size_t(g * y % side)];
      }
      power[std::size_t(g * side + f)] = std::norm(sum) / cells;
    }
  }
  return power;
}

// The mean power between two radii, the constant left out, over that of white noise with the same
// variance, which has it at every frequency.
double relative_power(const Field& field, double from, double to) {
  Moments values, ring;
  for (const double x : field) values.add(x);
  const Field power = power_spectrum(field);
  for (int g = 0; g < side; ++g) {
    for (int f = 0; f < side; ++f) {
      const double radius = std::hypot(std::min(f, side - f), std::min(g, side - g));
      if (radius > 0.0 && radius >= from && radius < to) ring.add(power[std::size_t(g * side + f)]);
    }
  }
  return ring.mean / values.variance();
}

constexpr double nyquist = side / 2;

Field ranks() {
  Field field;
  for (int i = 0; i < cells; ++i) field.push_back(double(blue_noise_mask[i]));
  return field;
}

TEST(BlueNoiseMask, HasEveryRankOnce) {
  const std::set<std::uint32_t> all(blue_noise_mask, blue_noise_mask + cells);
  EXPECT_EQ(int(all.size()), cells);
  EXPECT_EQ(*all.rbegin(), std::uint32_t(cells - 1));
}

// On the torus, so the mask tiles: a seam would have power at low frequencies along both axes.
TEST(BlueNoiseMask, HasATenthOfWhiteNoisesPowerAtTheLowestQuarterOfFrequencies) {
  EXPECT_LT(relative_power(ranks(), 0.0, nyquist / 4), 0.1);
  EXPECT_GT(relative_power(ranks(), 0.75 * nyquist, nyquist), 1.2);  // where it went
}

TEST(BlueNoiseMask, WhiteNoiseWouldFail) {
  Field noise = ranks();
  std::mt19937 random(3);
  std::shuffle(noise.begin(), noise.end(), random);
  EXPECT_NEAR(relative_power(noise, 0.0, nyquist / 4), 1.0, 0.3);
  EXPECT_NEAR(relative_power(noise, 0.75 * nyquist, nyquist), 1.0, 0.1);
}

// So does every threshold of it: masks dither at each grey.
TEST(BlueNoiseMask, EveryLevelIsSpread) {
  for (const double share : {0.05, 0.1, 0.25, 0.5, 0.75, 0.9}) {
    Field ones;
    for (const double rank : ranks()) ones.push_back(rank < share * cells ? 1.0 : 0.0);
    const double radius = nyquist * std::sqrt(std::min(share, 1.0 - share));
    EXPECT_LT(relative_power(ones, 0.0, 0.5 * radius), 0.15) << share;
  }
}

// Offsets of an image: shared points taken away from the pixels' own.
Field offsets(int pair, int x0, int y0, std::vector<float> Values::*axis) {
  const SamplerState state = state_of("bluenoise:mix=xor", 7, {192, 192, 16});
  const Values shared = draw(state_of("cpt", 7, {192, 192, 16}), 0, pair, 3, 1);
  const Values own = draw_block(state, x0, y0, side, pair, 3);
  Field field;
  const auto zero = std::uint32_t((shared.*axis)[0] * 0x1p24f);
  for (const float x : own.*axis) field.push_back(double(std::uint32_t(x * 0x1p24f) ^ zero));
  return field;
}

TEST(BlueNoiseOffset, IsTheMaskMovedForEachPairAndAxis) {
  std::set<std::vector<std::uint32_t>> all;
  for (const int pair : {0, 1, 5}) {
    for (const auto axis : {&Values::u, &Values::v}) {
      const Field here = offsets(pair, 0, 0, axis);
      std::vector<std::uint32_t> rank;
      for (const double x : here) rank.push_back(std::uint32_t(x) >> (24 - blue_noise_bits));
      EXPECT_EQ(std::set<std::uint32_t>(rank.begin(), rank.end()).size(), std::size_t(cells));
      all.insert(rank);
      EXPECT_LT(relative_power(here, 0.0, nyquist / 4), 0.1);
      // Moved as a whole: beside each other on the torus lie the ranks that do in the mask.
      const auto first = std::find(blue_noise_mask, blue_noise_mask + cells, rank[0]);
      const int move = int(first - blue_noise_mask);
      for (int i = 0; i < cells; ++i) {
        const int x = (i % side + move % side) % side, y = (i / side + move / side) % side;
        ASSERT_EQ(rank[std::size_t(i)], blue_noise_mask[y * side + x]);
      }
    }
  }
  EXPECT_EQ(all.size(), 6u);
}

// Pairs and axes are moved independently: were they not, offsets that follow each other would make
// some paths more likely than others.
TEST(BlueNoiseOffset, MovesOfPairsAndAxesAreIndependentOverSeeds) {
  std::vector<int> cell_of(cells);
  for (int i = 0; i < cells; ++i) cell_of[blue_noise_mask[i]] = i;
  SamplerState state = state_of("bluenoise");
  const auto move = [&](std::uint32_t seed, int pair) {
    state.seed = pcg3d(seed, 0u, 0x1ec5u).x;  // as renders have them
    const auto offset = BlueNoiseOffset::offset(state, 0u, 0u, pair);
    const int x = cell_of[offset.x >> 20], y = cell_of[offset.y >> 20];
    return std::array{x % side, x / side, y % side, y / side};
  };
  for (const int step : {1, 2, 4, 8}) {
    std::array<std::vector<std::uint32_t>, 5> joint;
    for (auto& counts : joint) counts.resize(std::size_t(cells));
    for (std::uint32_t seed = 0; seed < 1 << 16; ++seed) {
      const auto a = move(seed, 1), b = move(seed, 1 + step);
      for (std::size_t i = 0; i < 4; ++i) ++joint[i][std::size_t(a[i] * side + b[i])];
      ++joint[4][std::size_t(a[0] * side + a[2])];
    }
    for (const auto& counts : joint) EXPECT_GT(evenness(counts), sidak(significance, 20)) << step;
  }
}

// From tile to tile only what lies below the rank's digits changes.
TEST(BlueNoiseOffset, TilesWithPlacesOfItsOwnBelowTheRank) {
  const Field here = offsets(1, 0, 0, &Values::u), there = offsets(1, side, 2 * side, &Values::u);
  std::vector<float> jitter;
  int same = 0;
  for (int i = 0; i < cells; ++i) {
    const auto a = std::uint32_t(here[std::size_t(i)]), b = std::uint32_t(there[std::size_t(i)]);
    ASSERT_EQ(a >> 12, b >> 12);
    same += a == b ? 1 : 0;
    jitter.push_back(float(a & 0xfffu) * 0x1p-12f);
  }
  EXPECT_LT(same, 10);
  EXPECT_GT(evenness_of(jitter, 64), significance);
}

}  // namespace
}  // namespace lockstep::test_blue_noise
