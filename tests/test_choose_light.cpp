// The choice among lights: the interval that holds u, and what is left of u.
#include "tests/chi_square.h"
#include "tests/t_light.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace lockstep::test_light {
namespace {

// Cumulative distribution of these probabilities, the last value exactly 1.
std::vector<float> cumulative(const std::vector<double>& probabilities) {
  std::vector<float> cdf;
  double below = 0.0, total = 0.0;
  for (const double p : probabilities) total += p;
  for (const double p : probabilities) {
    cdf.push_back(float(below / total));
    below += p;
  }
  cdf.push_back(1.0f);
  return cdf;
}

TEST(ChooseLight, FindsTheIntervalThatHoldsU) {
  std::vector<std::vector<double>> sets = {{1.0},
                                           {0.3, 0.7},
                                           {0.0, 1.0},
                                           {1.0, 0.0},
                                           {0.2, 0.5, 0.3},
                                           {0.0, 1.0, 0.0},
                                           {0.0, 0.0, 1.0},
                                           {1.0, 0.0, 0.0, 0.0, 2.0},
                                           {}};
  for (std::uint32_t i = 0; i < 1000; ++i) {
    sets.back().push_back(i % 7 ? double(uniform3(i, 60).x) : 0.0);
  }
  for (const auto& probabilities : sets) {
    const std::vector<float> cdf = cumulative(probabilities);
    const int n = int(probabilities.size());
    const LightTable table{n, nullptr, cdf.data()};
    std::vector<float> values = {0.0f, 0x1p-24f, one_minus_epsilon};
    for (const float edge : cdf) {
      values.push_back(std::min(edge, one_minus_epsilon));
      values.push_back(std::max(0.0f, std::nextafter(edge, 0.0f)));
    }
    for (std::uint32_t i = 0; i < 1000; ++i) values.push_back(uniform3(i, 61).x);
    values.resize((values.size() + 15) / 16 * 16, 0.5f);
    std::vector<int> chosen;
    for (const float u : values) {
      const LightChoice<float> found = choose_light(table, Vec2<float>(u, one_minus_epsilon));
      const int i = found.index;
      chosen.push_back(i);
      ASSERT_TRUE(i >= 0 && i < n) << i << " of " << n;
      EXPECT_TRUE(found.u.x >= 0.0f && found.u.x < 1.0f) << "u " << u << " left " << found.u.x;
      EXPECT_TRUE(cdf[size_t(i)] <= u && u < cdf[size_t(i + 1)]) << "u " << u << " chose " << i;
      EXPECT_GT(probabilities[size_t(i)], 0.0) << "u " << u << " chose " << i;
    }
    for_each_width([&](auto width) {
      constexpr int W = width();
      for (std::size_t i = 0; i < values.size(); i += W) {
        const auto wide =
            choose_light(table, Vec2<Float<W>>(load<Float<W>>(&values[i]), Float<W>(0.3f)));
        for (int k = 0; k < W; ++k) {
          const auto one = choose_light(table, Vec2<float>(values[i + size_t(k)], 0.3f));
          EXPECT_EQ(wide.index[k], chosen[i + size_t(k)]);
          EXPECT_EQ(wide.u.x[k], one.u.x);
        }
      }
    });
  }
}

// What is left of u on lights of many probabilities, down to the single step of 2^-24 that a sample
// resolves: there u.x is always the same.
TEST(ChooseLight, WhatIsLeftOfUIsUniform) {
  constexpr float step = 0x1p-24f;
  const std::vector<float> steps = {1.0f, 2.0f, 3.0f, 17.0f, 1000.0f, 0x1p20f, 5e6f};
  std::vector<float> cdf{0.0f};
  for (const float n : steps) cdf.push_back(cdf.back() + n * step);
  cdf.push_back(1.0f);
  const LightTable table{int(steps.size()) + 1, nullptr, cdf.data()};
  for (std::size_t i = 0; i < steps.size(); ++i) {
    CellCounts counts(16, 16);
    for (std::uint32_t k = 0; k < sample_count; ++k) {
      const glm::vec3 r = uniform3(k, 90 + std::uint32_t(i));
      const float u = cdf[i] + std::min(std::floor(r.x * steps[i]), steps[i] - 1.0f) * step;
      const LightChoice<float> c = choose_light(table, Vec2<float>(u, r.y));
      ASSERT_EQ(c.index, int(i));
      counts.add(glm::dvec2(c.u));
    }
    const DensityTest test = counts.test([](glm::dvec2) { return 1.0; });
    EXPECT_GT(test.chi_square.p_value, sidak_significance(int(steps.size()))) << steps[i];
  }
}

}  // namespace
}  // namespace lockstep::test_light
