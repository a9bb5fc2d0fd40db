// The sequence that docs/tutorial.md adds is compiled, and what the tutorial says of it is true.
// Exact: no significance.
#include "docs/examples/golden.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <vector>

namespace lockstep::test_example_sequence {
namespace {

constexpr std::uint32_t count = 64;

std::vector<std::uint32_t> first_coordinates(std::uint32_t pixel, int pair) {
  std::vector<std::uint32_t> x;
  for (std::uint32_t k = 0; k < count; ++k) {
    x.push_back(GoldenSequence::point(SamplerState{}, pixel, k, pair).x);
  }
  return x;
}

// Consecutive multiples of a number, mod 1, divide the circle into gaps of at most three lengths
// (Steinhaus; Sós 1958), whatever the shift; aligned blocks of samples are such multiples.
TEST(ExampleSequence, DividesTheCircleEvenly) {
  for (const std::uint32_t pixel : {0u, 7u, 123456u}) {
    for (const int pair : {0, 1, 9}) {
      std::vector<std::uint32_t> x = first_coordinates(pixel, pair);
      std::sort(x.begin(), x.end());
      std::set<std::uint32_t> gaps{x.front() - x.back()};
      for (std::size_t i = 1; i < x.size(); ++i) gaps.insert(x[i] - x[i - 1]);
      EXPECT_LE(gaps.size(), 3u) << "pixel " << pixel << ", pair " << pair;
      EXPECT_LT(*gaps.rbegin(), 3.0 * 0x1p32 / count);
    }
  }
}

TEST(ExampleSequence, PairsAndPixelsHaveOrdersOfTheirOwn) {
  const std::vector<std::uint32_t> one = first_coordinates(3, 0);
  for (const auto& other : {first_coordinates(3, 1), first_coordinates(4, 0)}) {
    std::set<std::uint32_t> distances;
    for (std::size_t k = 0; k < count; ++k) distances.insert(other[k] - one[k]);
    EXPECT_GT(distances.size(), count / 8);  // in step there is one
  }
}

}  // namespace
}  // namespace lockstep::test_example_sequence
