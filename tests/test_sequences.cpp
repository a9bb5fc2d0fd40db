// What each sequence promises of its points: nets, strata, and agreement with published numbers.
// Everything here is exact and needs no significance.
#include "samplers/joe_kuo.h"
#include "samplers/pmj02_table.h"
#include "samplers/primes.h"
#include "tests/t_samples.h"

#include <boost/random/sobol.hpp>

#include <array>
#include <cmath>
#include <set>

namespace lockstep::test_sequences {
namespace {

const std::uint32_t seeds[] = {0, 1, 12345};
const std::uint32_t pixels[] = {0, 1, 511, 1000003};

// The first 2^bits points, and three of the aligned blocks behind them.
void expect_nets(const SamplerState& state, std::uint32_t pixel, int pair, int bits) {
  const std::uint32_t n = 1u << bits;
  for (const std::uint32_t block : {0u, 1u, 2u, 5u}) {
    ASSERT_TRUE(is_net(draw(state, pixel, pair, block * n, n), bits))
        << "seed " << state.seed << " pixel " << pixel << " pair " << pair << " block " << block
        << " of " << n;
  }
}

TEST(Owen, EveryAlignedBlockOfEveryPairIsANet) {
  for (const std::uint32_t seed : seeds) {
    for (const std::uint32_t pixel : pixels) {
      for (const int pair : {0, 1, 7, 4095}) {
        for (int bits = 0; bits <= 10; ++bits) {
          expect_nets(state_of("owen", seed), pixel, pair, bits);
        }
      }
    }
  }
}

TEST(Owen, OtherBlocksAndPointsAreNoNets) {
  // Guards all tests of nets: they can tell.
  EXPECT_FALSE(is_net(draw(state_of("owen"), 3, 2, 128, 256), 8));
  EXPECT_FALSE(is_net(draw(state_of("random"), 3, 2, 0, 16), 4));
}

// Sobol -----------------------------------------------------------------------------------------

TEST(Sobol, TheFirstPairIsANetInEveryAlignedBlock) {
  for (const std::uint32_t seed : seeds) {
    for (const std::uint32_t pixel : pixels) {
      for (int bits = 0; bits <= 10; ++bits) {
        expect_nets(state_of("sobol", seed), pixel, 0, bits);
      }
    }
  }
}

TEST(Sobol, EveryDimensionIsStratifiedInEveryAlignedBlock) {
  const SamplerState state = state_of("sobol", 3);
  for (int pair = 0; pair < 600; pair += pair < 32 ? 1 : 71) {
    for (const std::uint32_t n : {1u, 2u, 8u, 64u, 256u, 4096u}) {
      for (const std::uint32_t block : {0u, 1u, 6u}) {
        const Values points = draw(state, 77, pair, block * n, n);
        ASSERT_TRUE(is_stratified(points.u) && is_stratified(points.v)) << pair << ' ' << n;
      }
    }
  }
}

// The m of dimension d, from the published file new-joe-kuo-6.
TEST(Sobol, MatricesBeginWithThePublishedDirectionNumbers) {
  const std::vector<std::vector<std::uint32_t>> published = {
      {1},           {1, 3},           {1, 3, 1},       {1, 1, 1},        {1, 1, 3, 3},
      {1, 3, 5, 13}, {1, 1, 5, 5, 17}, {1, 1, 5, 5, 5}, {1, 1, 7, 11, 19}};
  for (std::size_t d = 0; d < published.size(); ++d) {
    for (std::size_t j = 0; j < published[d].size(); ++j) {
      const std::uint32_t column = joe_kuo_matrices[(d + 1) * 32 + j];
      EXPECT_EQ(reverse_bits(column), published[d][j] << (31 - j)) << d + 2 << ' ' << j;
    }
  }
}

TEST(Sobol, MatricesAreRegularAndUnlikeEachOther) {
  std::set<std::vector<std::uint32_t>> all;
  for (int d = 0; d < joe_kuo_dimensions; ++d) {
    const std::uint32_t* columns = joe_kuo_matrices + d * 32;
    for (int j = 0; j < 32; ++j) ASSERT_EQ(columns[j] >> j, 1u) << d;  // a triangle of ones
    all.emplace(columns, columns + 32);
  }
  EXPECT_EQ(int(all.size()), joe_kuo_dimensions);
}

// Another implementation, which goes through the points in the order of Gray's code.
TEST(Sobol, PointsAreThoseOfBoost) {
  const int dimensions = 1000;
  boost::random::sobol boost_points(dimensions);
  const SamplerState state = state_of("sobol");
  for (std::uint32_t n = 1; n < 300; ++n) {
    const std::uint32_t index = n ^ (n >> 1);
    for (int pair = 0; pair < dimensions / 2; ++pair) {
      const auto point = SobolSequence::prepare(state, index, pair);
      ASSERT_EQ(reverse_bits(point.x), std::uint32_t(boost_points() >> 32)) << index << ' ' << pair;
      ASSERT_EQ(reverse_bits(point.y), std::uint32_t(boost_points() >> 32)) << index << ' ' << pair;
    }
  }
}

// Linked pairs ----------------------------------------------------------------------------------

TEST(Linked, EveryAlignedBlockOfEveryPairIsANet) {
  for (const std::uint32_t pixel : pixels) {
    for (const int pair : {0, 1, 2, 3, 4095}) {
      for (int bits = 0; bits <= 11; ++bits) expect_nets(state_of("linked"), pixel, pair, bits);
    }
  }
}

// Of the ways to cut four dimensions into 2^bits intervals, those that hold one point each.
int filled_partitions(const SamplerState& state, std::uint32_t pixel, int one, int two, int bits) {
  const std::uint32_t n = 1u << bits;
  const Values a = draw(state, pixel, one, 0, n), b = draw(state, pixel, two, 0, n);
  int filled = 0;
  for (int i = 0; i <= bits; ++i) {
    for (int j = 0; i + j <= bits; ++j) {
      for (int k = 0; i + j + k <= bits; ++k) {
        const auto cell = [](float x, int digits) { return int(std::ldexp(x, digits)); };
        std::set<std::array<int, 4>> cells;
        for (std::size_t p = 0; p < n; ++p) {
          cells.insert(
              {cell(a.u[p], i), cell(a.v[p], j), cell(b.u[p], k), cell(b.v[p], bits - i - j - k)});
        }
        filled += cells.size() == n ? 1 : 0;
      }
    }
  }
  return filled;
}

TEST(Linked, TheFirstPairsFillMoreIntervalsTogetherThanPaddedOnesOnAverage) {
  const SamplerState linked = state_of("linked"), padded = state_of("owen");
  for (const auto& [one, two] : {std::pair{0, 1}, {0, 2}, {1, 2}}) {
    for (int bits = 3; bits <= 8; ++bits) {
      int all = 0;
      for (std::uint32_t pixel = 0; pixel < 8; ++pixel) {
        all += filled_partitions(padded, pixel, one, two, bits);
      }
      EXPECT_GT(8 * filled_partitions(linked, 5, one, two, bits), all) << one << two << ' ' << bits;
    }
  }
}

// Progressive multi-jittered (0, 2) points ------------------------------------------------------

TEST(Pmj02, TheFirstPowersOfTwoOfEveryPairAreNets) {
  for (const std::uint32_t seed : seeds) {
    const SamplerState state = state_of("pmj02", seed);
    for (const std::uint32_t pixel : pixels) {
      for (const int pair : {0, 1, 7, 15, 16, 17, 100, 4095}) {
        for (int bits = 0; bits <= 12; ++bits) {
          ASSERT_TRUE(is_net(draw(state, pixel, pair, 0, 1u << bits), bits)) << pair << ' ' << bits;
        }
      }
    }
  }
}

TEST(Pmj02, SamplesBehindTheTableAreNewNets) {
  const SamplerState state = state_of("pmj02");
  for (const int pair : {0, 20}) {
    const Values first = draw(state, 5, pair, 0, 256);
    for (const std::uint32_t block : {1u, 2u, 16u, 1000u}) {
      const std::uint32_t from = block * pmj02_points;
      for (const int bits : {4, 8, 12}) {
        EXPECT_TRUE(is_net(draw(state, 5, pair, from, 1u << bits), bits)) << block << ' ' << bits;
      }
      EXPECT_NE(draw(state, 5, pair, from, 256), first);
    }
  }
}

// Stratified ------------------------------------------------------------------------------------

// The number of points in each cell, but for those on an edge, which rounding may put on either
// side: one in a thousand.
std::vector<std::uint32_t> cells_of(const Values& points, int columns, int rows) {
  std::vector<std::uint32_t> cells(std::size_t(columns * rows));
  for (std::size_t i = 0; i < points.u.size(); ++i) {
    const double x = double(points.u[i]) * columns, y = double(points.v[i]) * rows;
    if (std::min(std::abs(x - std::round(x)), std::abs(y - std::round(y))) > 0x1p-12) {
      ++cells[std::size_t(y) * std::size_t(columns) + std::size_t(x)];
    }
  }
  return cells;
}

// columns x rows as the sequence promises: as square as can be, at least as many as samples.
TEST(Stratified, NoTwoPlannedSamplesShareACell) {
  struct Grid {
    std::uint32_t samples;
    int columns, rows;
  };
  for (const Grid& g : {Grid{1, 1, 1},
                        {2, 1, 2},
                        {3, 1, 3},
                        {4, 2, 2},
                        {5, 2, 3},
                        {6, 2, 3},
                        {7, 2, 4},
                        {9, 3, 3},
                        {12, 3, 4},
                        {16, 4, 4},
                        {64, 8, 8},
                        {100, 10, 10},
                        {250, 15, 17},
                        {256, 16, 16},
                        {1024, 32, 32},
                        {4096, 64, 64}}) {
    const SamplerState state = state_of("stratified", 5, {512, 512, g.samples});
    for (const std::uint32_t pixel : pixels) {
      for (const int pair : {0, 3}) {
        for (const std::uint32_t plan : {0u, 1u, 9u}) {
          const auto cells =
              cells_of(draw(state, pixel, pair, plan * g.samples, g.samples), g.columns, g.rows);
          ASSERT_LE(*std::max_element(cells.begin(), cells.end()), 1u) << g.samples;
        }
      }
    }
  }
}

TEST(Stratified, PixelsPairsAndPlansHaveOrdersOfTheirOwn) {
  const auto order = [](std::uint32_t pixel, int pair, std::uint32_t first) {
    const Values points = draw(state_of("stratified", 5, {512, 512, 64}), pixel, pair, first, 64);
    std::vector<int> cells;
    for (std::size_t i = 0; i < 64; ++i) {
      cells.push_back(int(points.v[i] * 8.0f) * 8 + int(points.u[i] * 8.0f));
    }
    return cells;
  };
  std::set<std::vector<int>> orders;
  for (std::uint32_t pixel = 0; pixel < 4; ++pixel) {
    for (int pair = 0; pair < 4; ++pair) {
      for (const std::uint32_t first : {0u, 64u, 128u}) orders.insert(order(pixel, pair, first));
    }
  }
  EXPECT_EQ(orders.size(), 48u);
}

// Halton ----------------------------------------------------------------------------------------

TEST(Halton, BasesAreTheFirstPrimes) {
  const std::uint32_t first[] = {2, 3, 5, 7, 11, 13, 17, 19, 23, 29};
  for (int i = 0; i < 10; ++i) EXPECT_EQ(halton_primes[i], first[i]);
  EXPECT_EQ(halton_primes[999], 7919u);
}

// Before the shift: 2^a 3^b points have one in every box that is 2^-a wide and 3^-b high, and
// aligned blocks of b^k points of base b one in every b^-k.
TEST(Halton, PointsAreStratifiedInTheirBases) {
  for (const std::uint32_t seed : seeds) {
    const SamplerState state = state_of("halton", seed);
    for (const auto& [columns, rows] : {std::pair{2, 3}, {4, 3}, {8, 9}, {16, 27}, {64, 27}}) {
      std::set<std::pair<int, int>> boxes;
      const std::uint32_t n = std::uint32_t(columns * rows);
      for (std::uint32_t i = 3 * n; i < 4 * n; ++i) {
        const auto p = HaltonSequence::prepare(state, i, 0);
        boxes.emplace(int(double(p.x) * 0x1p-32 * columns), int(double(p.y) * 0x1p-32 * rows));
      }
      EXPECT_EQ(int(boxes.size()), columns * rows);
    }
    for (int pair = 0; pair < 512; pair += 1 + pair / 4) {
      const std::uint32_t base = halton_primes[2 * pair];
      for (std::uint32_t n = base; n < 9000; n *= base) {
        std::vector<float> x;
        for (std::uint32_t i = 2 * n; i < 3 * n; ++i) {
          // From the middle of the last digit that a float keeps.
          x.push_back(unit_float(HaltonSequence::prepare(state, i, pair).x) + 0x1p-25f);
        }
        ASSERT_TRUE(is_stratified(x)) << base << ' ' << n;
      }
    }
  }
}

TEST(Halton, PixelsHaveItsPointsShifted) {
  const SamplerState state = state_of("halton");
  for (const int pair : {0, 5, 511, 512, 4095}) {
    const auto first = HaltonSequence::prepare(state, 0, pair);
    for (const std::uint32_t pixel : pixels) {
      const Values points = draw(state, pixel, pair, 0, 256);
      for (std::uint32_t i = 0; i < 256; ++i) {
        const auto p = HaltonSequence::prepare(state, i, pair);
        ASSERT_NEAR(ahead(points.u[i], points.u[0]), unit_float(p.x - first.x), 0x1p-23f);
        ASSERT_NEAR(ahead(points.v[i], points.v[0]), unit_float(p.y - first.y), 0x1p-23f);
      }
    }
  }
}

// Lattice ---------------------------------------------------------------------------------------

TEST(Lattice, BothAxesAreStratifiedInEveryAlignedBlock) {
  for (const std::uint32_t seed : seeds) {
    for (const int pair : {0, 1, 4095}) {
      for (const std::uint32_t n : {1u, 2u, 16u, 128u, 4096u}) {
        for (const std::uint32_t block : {0u, 1u, 5u}) {
          const Values points = draw(state_of("lattice", seed), 9, pair, block * n, n);
          ASSERT_TRUE(is_stratified(points.u) && is_stratified(points.v)) << n;
        }
      }
    }
  }
}

// No two of 2^m points are closer than 0.66 of what a triangular grid would allow.
TEST(Lattice, PointsKeepTheirDistance) {
  for (int bits = 2; bits <= 16; ++bits) {
    const std::uint32_t n = 1u << bits;
    double least = 1.0;
    for (std::uint32_t i = 1; i < n; ++i) {
      const double x = double(i) / n, y = double(i * LatticeSequence::generator % n) / n;
      least = std::min(least, std::hypot(std::min(x, 1.0 - x), std::min(y, 1.0 - y)));
    }
    EXPECT_GT(least, 0.655 * std::sqrt(2.0 / std::sqrt(3.0) / n)) << n;
  }
}

// The points are those of the lattice: differences to the first are multiples of (1, g) / n.
TEST(Lattice, PointsAreThoseOfItsGenerator) {
  for (const std::uint32_t n : {16u, 1024u}) {
    const Values points = draw(state_of("lattice"), 4, 2, 0, n);
    for (std::uint32_t k = 0; k < n; ++k) {
      const double x = double(ahead(points.u[k], points.u[0])) * n;
      const double y = double(ahead(points.v[k], points.v[0])) * n;
      const auto i = std::uint32_t(std::lround(x));
      ASSERT_NEAR(x, double(i), 1e-3);
      ASSERT_NEAR(std::remainder(y - double(i * LatticeSequence::generator % n), n), 0.0, 1e-3);
    }
  }
}

// Z-ordered Sobol -------------------------------------------------------------------------------

// A base-4 digit of the order holds two bits: with 2^s planned, blocks of 2^m stay together where
// s - m is even.
TEST(ZSobol, AlignedSamplesOfAPixelAreANet) {
  for (const int planned : {0, 1, 2, 4, 5, 8, 11}) {
    const SamplerState state = state_of("zsobol", 3, {512, 300, 1u << planned});
    for (const std::uint32_t pixel : {0u, 77u, 512u * 299u}) {
      for (const int pair : {0, 1, 4095}) {
        for (int bits = planned; bits >= 0; bits -= 2) expect_nets(state, pixel, pair, bits);
      }
    }
  }
}

TEST(ZSobol, AlignedBlocksOfPixelsAreANetTogether) {
  const int bits = 4;
  const SamplerState state = state_of("zsobol", 3, {64, 64, 1u << bits});
  for (const int side : {1, 2, 4, 8, 16, 32, 64}) {
    for (const auto& [x, y] : {std::pair{0, 0}, {64 - side, 64 - side}, {64 - side, 0}}) {
      for (const std::uint32_t plan : {0u, 1u}) {
        Values points;
        for (std::uint32_t k = 0; k < 1u << bits; ++k) {
          points.append(draw_block(state, x, y, side, 1, plan * (1u << bits) + k));
        }
        EXPECT_TRUE(is_net(points, bits + 2 * std::countr_zero(unsigned(side)))) << side;
      }
    }
  }
  // Guards the test: pixels beside each other in two blocks are no net.
  Values points;
  for (std::uint32_t k = 0; k < 1u << bits; ++k) points.append(draw_block(state, 1, 1, 2, 1, k));
  EXPECT_FALSE(is_net(points, bits + 2));
}

// Where indices have no room for the whole image, tiles are nets by themselves.
TEST(ZSobol, LargePlansKeepNetsWithinTiles) {
  const SamplerState state = state_of("zsobol", 3, {4096, 4096, 1u << 14});  // tiles of 2^9
  for (const std::uint32_t pixel : {0u, 4096u * 600u + 700u}) {
    expect_nets(state, pixel, 1, 14);
    EXPECT_NE(draw(state, pixel, 1, 0, 64), draw(state, pixel ^ 512u, 1, 0, 64));
  }
}

}  // namespace
}  // namespace lockstep::test_sequences
