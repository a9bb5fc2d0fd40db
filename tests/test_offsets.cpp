// How pixels leave a shared sequence: how far, in which direction, and what it leaves of its nets.
#include "tests/t_samples.h"

#include <bit>
#include <cmath>
#include <limits>
#include <set>

namespace lockstep::test_offsets {
namespace {

constexpr std::uint32_t many = 1 << 16;

// A point's coordinate as the integer that it is in units of 2^-24.
std::uint32_t digits_of(float x) { return std::uint32_t(x * 0x1p24f); }

SamplerState weighted(const std::string& text, float weight,
                      const SamplePlan& plan = {64, 64, 64}) {
  SamplerState state = state_of(text, 7, plan);
  state.weight = weight;
  return state;
}

// Every offset and both ways to mix it in.
std::vector<std::string> all_moves() {
  std::vector<std::string> all;
  for (const std::string& offset : offset_names()) {
    all.push_back("offset=" + offset);
    all.push_back("offset=" + offset + ",mix=xor");
  }
  return all;
}

// Weights ---------------------------------------------------------------------------------------

TEST(Offsets, NoWeightIsCoherentPathTracing) {
  const std::vector<float> zeros(64 * 64, 0.0f);
  for (const int pair : {0, 2, 9}) {
    const Values cpt = draw(weighted("cpt", 0.0f), 9, pair, 0, 256);
    for (const std::string& move : all_moves()) {
      EXPECT_EQ(draw(weighted("cpt:" + move, 0.0f), 9, pair, 0, 256), cpt) << move;
      SamplerState mapped = weighted("cpt:" + move, 1.0f);
      mapped.weights = zeros.data();
      EXPECT_EQ(draw(mapped, 9, pair, 0, 256), cpt) << move;
    }
  }
}

TEST(Offsets, AMapGivesEachPixelItsWeight) {
  const std::vector<float> map{0.0f, 0.3f, 1.0f};
  for (const std::string& move : all_moves()) {
    SamplerState mapped = weighted("cpt:" + move, 0.5f, {3, 1, 16});
    mapped.weights = map.data();
    for (std::uint32_t pixel = 0; pixel < 3; ++pixel) {
      const SamplerState same = weighted("cpt:" + move, map[pixel], {3, 1, 16});
      EXPECT_EQ(draw(mapped, pixel, 2, 0, 64), draw(same, pixel, 2, 0, 64)) << move;
    }
  }
}

// Whoever shares a packet with them.
TEST(Offsets, WeightsBeyondTheRangeCountAsItsEnds) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float inf = std::numeric_limits<float>::infinity();
  const std::vector<float> odd{-1.0f, nan, -inf, 0.0f, 1.5f, 1e30f, inf, 1.0f};
  const std::vector<float> ends{0.0f, 0.0f, 0.0f, 0.0f, 1.0f, 1.0f, 1.0f, 1.0f};
  for (const std::string& move : all_moves()) {
    SamplerState state = weighted("cpt:" + move, 0.5f, {8, 1, 16});
    Couples all;
    for (std::uint32_t i = 0; i < 64; ++i) all.add(i % 8, i / 8);
    for (const int width : {1, 4, 8, 16}) {
      const Kernel& kernel = find_kernel(choose_isa(), width);
      state.weights = ends.data();
      const Values expected = draw_batch(kernel, state, all, 2);
      state.weights = odd.data();
      EXPECT_EQ(draw_batch(kernel, state, all, 2), expected) << move << ' ' << width;
    }
  }
}

TEST(Offsets, PixelsStayWithinTheirWeightAheadOfTheSequence) {
  const Values shared = draw(weighted("cpt", 0.0f), 0, 2, 0, 256);
  for (const std::string& offset : offset_names()) {
    for (const float w : {1e-7f, 1.0f / 64, 0.1f, 0.5f}) {
      float farthest = 0.0f;
      for (std::uint32_t pixel = 0; pixel < 64; ++pixel) {
        const Values own = draw(weighted("cpt:offset=" + offset, w), pixel, 2, 0, 256);
        for (std::size_t k = 0; k < shared.u.size(); ++k) {
          const float du = ahead(own.u[k], shared.u[k]), dv = ahead(own.v[k], shared.v[k]);
          ASSERT_TRUE(du <= w + 0x1p-24f && dv <= w + 0x1p-24f) << offset << ' ' << w;
          farthest = std::max({farthest, du, dv});
        }
      }
      EXPECT_GT(farthest, 0.9f * w - 0x1p-24f) << offset << ' ' << w;
    }
  }
}

// XOR changes only digits below the larger power of two, and all of them.
TEST(Offsets, XorKeepsTheDigitsAboveTheWeight) {
  const Values shared = draw(weighted("cpt", 0.0f), 0, 2, 0, 256);
  for (const std::string& offset : offset_names()) {
    for (const float w : {0x1p-23f, 1.0f / 64, 0.1f, 0.125f, 0.126f, 0.5f, 1.0f - 0x1p-24f, 1.0f}) {
      std::uint32_t changed = 0;
      for (std::uint32_t pixel = 0; pixel < 64; ++pixel) {
        const Values own = draw(weighted("cpt:mix=xor,offset=" + offset, w), pixel, 2, 0, 256);
        for (std::size_t k = 0; k < shared.u.size(); ++k) {
          changed |= digits_of(own.u[k]) ^ digits_of(shared.u[k]);
          changed |= digits_of(own.v[k]) ^ digits_of(shared.v[k]);
        }
      }
      EXPECT_EQ(changed, std::bit_ceil(std::uint32_t(std::ceil(w * 0x1p24f))) - 1u)
          << offset << ' ' << w;
    }
  }
}

// Offsets ---------------------------------------------------------------------------------------

// The offset that is mixed in does not depend on the sample, except for fresh ones; other pixels
// and pairs have others.
TEST(Offsets, OnlyFreshOnesDependOnTheSample) {
  for (const std::string& offset : offset_names()) {
    std::set<std::pair<float, float>> offsets;
    for (std::uint32_t pixel = 0; pixel < 64; ++pixel) {
      for (const int pair : {2, 3}) {
        const Values shared = draw(weighted("cpt", 0.0f), 0, pair, 0, 256);
        const Values own = draw(weighted("cpt:offset=" + offset, 1.0f), pixel, pair, 0, 256);
        std::set<std::pair<std::uint32_t, std::uint32_t>> here;
        for (std::size_t k = 0; k < shared.u.size(); ++k) {
          // Both are cut to 24 digits: their difference is off by one digit at most.
          here.emplace((digits_of(ahead(own.u[k], shared.u[k])) + 1) >> 2,
                       (digits_of(ahead(own.v[k], shared.v[k])) + 1) >> 2);
        }
        EXPECT_EQ(here.size() > 4, offset == "fresh") << offset;
        EXPECT_EQ(here.size() > 200, offset == "fresh") << offset;
        offsets.emplace(ahead(own.u[0], shared.u[0]), ahead(own.v[0], shared.v[0]));
      }
    }
    EXPECT_EQ(offsets.size(), 128u) << offset;
  }
}

// Fresh offsets fill the square as random points do, at every weight: with a random sequence, as
// counts of a stratified one would be too even for chi-square.
TEST(Offsets, EveryPixelIsUniformAtEveryWeight) {
  const float weights[] = {0.001f, 0.1f, 0.3f, 0.5f, 0.9f, 1.0f};
  const double limit = sidak(significance, 2 * 3 * 6);
  for (const char* mix : {"add", "xor"}) {
    for (const float w : weights) {
      const auto text = std::string("cpt:sequence=random,offset=fresh,mix=") + mix;
      const Values x = draw(weighted(text, w), 31, 2, 0, many);
      EXPECT_GT(evenness_of(x.u, 256), limit) << mix << ' ' << w;
      EXPECT_GT(evenness_of(x.v, 256), limit) << mix << ' ' << w;
      EXPECT_GT(joint_evenness(x.u, x.v, 16), limit) << mix << ' ' << w;
    }
  }
}

// At w = 1 the offset alone is what a pixel follows; it must not repeat the sequence's numbers.
TEST(Offsets, AreIndependentOfTheSequence) {
  const double limit = sidak(significance, 3);
  const Values own = draw(state_of("random"), 5, 2, 0, many);
  const Values shared = draw(state_of("cpt:sequence=random"), 5, 2, 0, many);
  const Values moved = draw(state_of("cpt:sequence=random,offset=fresh"), 5, 2, 0, many);
  std::vector<float> offset;
  for (std::size_t k = 0; k < many; ++k) offset.push_back(ahead(moved.u[k], shared.u[k]));
  EXPECT_GT(joint_evenness(shared.u, offset, 32), limit);
  EXPECT_GT(joint_evenness(shared.u, moved.u, 32), limit);
  EXPECT_GT(joint_evenness(own.u, offset, 32), limit);
}

// Over the pixels of an image offsets are uniform, and those of two pairs independent: bluenoise
// and morton ones are even more even than random ones. (A larger image repeats the mask's.)
TEST(Offsets, AreUniformOverTheImage) {
  const std::vector<std::string> names = offset_names();
  const double limit = sidak(significance, 4.0 * double(names.size()));
  for (const std::string& offset : names) {
    const SamplerState state = weighted("cpt:mix=xor,offset=" + offset, 1.0f);
    const Values one = draw_image(state, 1, 3), two = draw_image(state, 2, 3);
    EXPECT_GT(evenness_of(one.u, 256), limit) << offset;
    EXPECT_GT(joint_evenness(one.u, one.v, 16), limit) << offset;
    EXPECT_GT(joint_evenness(one.u, two.u, 16), limit) << offset;
    EXPECT_GT(joint_evenness(one.u, two.v, 16), limit) << offset;
  }
}

// At both ends of rows, in images of any width with up to 2^22 rows and 2^31 pixels.
TEST(PixelPosition, IsExact) {
  for (const std::uint32_t width : {1u, 2u, 3u, 7u, 511u, 512u, 16383u, 16384u, 1u << 20}) {
    const std::uint32_t rows = std::min(1u << 22, 0x7fffffffu / width);
    for (std::uint32_t row = 0; row < rows; row += 1 + row / 64) {
      for (const std::uint32_t y : {row, rows - 1 - row}) {
        for (const std::uint32_t x : {0u, width / 2, width - 1}) {
          const auto p = position_of(y * width + x, int(width));
          ASSERT_TRUE(p.x == x && p.y == y) << x << ' ' << y << " of width " << width;
        }
      }
    }
  }
}

// Every aligned block of 4^m pixels has a net of offsets, in images of any shape.
TEST(MortonOffset, AlignedBlocksOfPixelsAreStratified) {
  for (const SamplePlan& plan : {SamplePlan{64, 64, 16}, {100, 70, 16}, {16384, 64, 16}}) {
    const SamplerState state = weighted("cpt:mix=xor,offset=morton", 1.0f, plan);
    for (const int side : {1, 2, 4, 8, 16, 32}) {
      for (const auto& [x, y] : {std::pair{0, 0}, {32, 0}, {32, 32}}) {
        const int bits = 2 * std::countr_zero(unsigned(side));
        EXPECT_TRUE(is_net(draw_block(state, x, y, side, 2, 5), bits)) << side;
      }
    }
  }
  const SamplerState state = weighted("cpt:mix=xor,offset=morton", 1.0f);
  EXPECT_FALSE(is_net(draw_block(state, 3, 3, 8, 2, 5), 6));  // guards the test
}

// Nets ------------------------------------------------------------------------------------------

// XOR with one offset for all samples turns nets into nets, whatever the weight.
TEST(Offsets, XorKeepsEveryPixelsNets) {
  for (const char* sequence : {"owen", "pmj02"}) {
    for (const char* offset : {"constant", "bluenoise", "morton"}) {
      const auto text = std::string("cpt:mix=xor,sequence=") + sequence + ",offset=" + offset;
      for (const float w : {1.0f / 64, 0.125f, 0.3f, 1.0f}) {
        for (const std::uint32_t pixel : {0u, 9u, 4095u}) {
          for (int bits = 0; bits <= 10; ++bits) {
            ASSERT_TRUE(is_net(draw(weighted(text, w), pixel, 2, 0, 1u << bits), bits))
                << text << ' ' << w << ' ' << bits;
          }
        }
      }
    }
  }
  EXPECT_FALSE(is_net(draw(weighted("cpt:mix=xor,offset=fresh", 1.0f), 9, 2, 0, 256), 8));
}

// The largest difference between counts in n rows.
int unevenness(const std::vector<float>& x, int n) {
  std::vector<int> count(static_cast<std::size_t>(n));
  for (const float value : x) ++count[std::size_t(value * float(n))];
  const auto [low, high] = std::minmax_element(count.begin(), count.end());
  return *high - *low;
}

// Adding one keeps every row and column of cells evenly filled, to within the cells that the
// rotation cuts; fresh offsets do not.
TEST(Offsets, AddingOneOffsetKeepsRowsEven) {
  for (const char* offset : {"constant", "bluenoise", "morton"}) {
    const SamplerState state = weighted(std::string("cpt:offset=") + offset, 1.0f);
    EXPECT_LE(unevenness(draw(state, 5, 2, 0, 1024).u, 32), 2) << offset;
  }
  EXPECT_GT(unevenness(draw(weighted("cpt:offset=fresh", 1.0f), 5, 2, 0, 1024).u, 32), 8);
}

// Strata: the points of every pixel are a net whose cells all pixels visit in the same order.
TEST(Strata, PixelsShareTheOrderOfCellsAndNothingElse) {
  for (const int m : {1, 2, 3, 4, 5}) {
    const std::uint32_t n = 1u << 2 * m;
    const SamplerState state = state_of("strata", 7, {64, 64, n});
    EXPECT_EQ(state.weight, std::ldexp(1.0f, -m));
    for (const int pair : {0, 1, 2}) {
      const Values first = draw(state, 0, pair, 0, n);
      for (const std::uint32_t pixel : {0u, 1u, 70u, 4095u}) {
        const Values points = draw(state, pixel, pair, 0, n);
        EXPECT_TRUE(is_net(points, 2 * m)) << m << ' ' << pixel;
        std::size_t same = 0;
        for (std::size_t k = 0; k < n; ++k) {
          ASSERT_EQ(std::floor(std::ldexp(points.u[k], m)), std::floor(std::ldexp(first.u[k], m)));
          ASSERT_EQ(std::floor(std::ldexp(points.v[k], m)), std::floor(std::ldexp(first.v[k], m)));
          same += points.u[k] == first.u[k] ? 1 : 0;
        }
        EXPECT_EQ(same, pixel == 0 ? n : 0u);
      }
    }
  }
}

TEST(Strata, CellsFitTheLargestPowerOfFourPlanned) {
  const auto weight = [](std::uint32_t samples) {
    return state_of("strata", 7, {64, 64, samples}).weight;
  };
  for (const auto& [samples, side] : {std::pair{1u, 1.0f},
                                      {3u, 1.0f},
                                      {4u, 0.5f},
                                      {15u, 0.5f},
                                      {16u, 0.25f},
                                      {63u, 0.25f},
                                      {64u, 0.125f},
                                      {1u << 24, 0x1p-12f}}) {
    EXPECT_EQ(weight(samples), side) << samples;
  }
}

}  // namespace
}  // namespace lockstep::test_offsets
