// Every lane operation at W = 4, 8, 16 against W = 1, lane by lane and bit for bit, with denormals
// kept and with denormals flushed to zero as kernels run.
#include "core/simd.h"

#include "packets/flush_denormals.h"
#include "tests/widths.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>
#include <vector>

namespace lockstep::test_simd {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();
constexpr float largest = std::numeric_limits<float>::max();
constexpr float denormal = std::numeric_limits<float>::denorm_min();

const std::vector<float>& special_values() {
  static const std::vector<float> values = {
      0.0f,           -0.0f,           infinity,  -infinity, not_a_number, -not_a_number,  denormal,
      -denormal,      0x1p-127f,       0x1p-126f, largest,   -largest,     1.0f,           -1.0f,
      0.5f,           -0.5f,           1.5f,      2.5f,      -2.5f,        0x1.fffffep-1f, 0x1p23f,
      0x1p23f - 0.5f, -0x1p22f - 0.5f, 3.4e-20f};
  return values;
}

// Random bits, random moderate numbers, and special values in turn.
float test_value(std::uint32_t i, std::uint32_t seed) {
  const Hash3<std::uint32_t> h = pcg3d(i, seed, 7u);
  if (h.z % 4 == 0) return special_values()[h.x % special_values().size()];
  return h.z % 4 == 1 ? as_float(h.x) : 200.0f * unit_float(h.x) - 100.0f;
}

std::vector<float> test_values(std::uint32_t seed) {
  std::vector<float> v(16 * 1024);
  for (std::uint32_t i = 0; i < v.size(); ++i) v[i] = test_value(i, seed);
  // All pairs of special values where two of these lists meet.
  const auto n = std::uint32_t(special_values().size());
  for (std::uint32_t i = 0; i < n * n; ++i) {
    v[i] = special_values()[seed % 2 ? i % n : i / n];
  }
  return v;
}

std::vector<std::uint32_t> test_bits(std::uint32_t seed) {
  std::vector<std::uint32_t> v(16 * 1024);
  for (std::uint32_t i = 0; i < v.size(); ++i) v[i] = pcg3d(i, seed, 11u).x;
  v[0] = 0u, v[1] = ~0u, v[2] = 0x80000000u, v[3] = 0x7fffffffu;
  return v;
}

class Simd : public testing::TestWithParam<bool> {
 protected:
  void SetUp() override {
    if (GetParam()) flush_.emplace();
  }
  void TearDown() override { flush_.reset(); }

 private:
  std::optional<FlushDenormals> flush_;
};
INSTANTIATE_TEST_SUITE_P(Denormals, Simd, testing::Bool(),
                         [](const auto& mode) { return mode.param ? "Flushed" : "Kept"; });

// f on packets of the inputs, against f on each of their elements.
template <class F, class T, class... Rest>
void expect_same_at_every_width(const char* name, F f, const std::vector<T>& first,
                                const Rest&... rest) {
  for_each_width([&](auto width) {
    constexpr int W = width();
    int failures = 0;
    for (std::size_t i = 0; i + W <= first.size() && failures < 5; i += W) {
      const auto wide =
          f(load<Lanes<T, W>>(&first[i]), load<Lanes<typename Rest::value_type, W>>(&rest[i])...);
      for (int k = 0; k < W; ++k) {
        const auto at = i + std::size_t(k);
        // The lane's type: bool & bool is an int.
        const decltype(lane(wide, k)) narrow = f(first[at], rest[at]...);
        if (same_value(lane(wide, k), narrow)) continue;
        ADD_FAILURE() << name << " W=" << W << " lane " << k << " operand " << first[at] << ": "
                      << lane(wide, k) << " against " << narrow;
        ++failures;
      }
    }
  });
}

#define EXPECT_SAME(expression, ...) \
  expect_same_at_every_width(        \
      #expression, [](auto x) { return expression; }, __VA_ARGS__)
#define EXPECT_SAME2(expression, ...) \
  expect_same_at_every_width(         \
      #expression, [](auto x, auto y) { return expression; }, __VA_ARGS__)
#define EXPECT_SAME3(expression, ...) \
  expect_same_at_every_width(         \
      #expression, [](auto x, auto y, auto z) { return expression; }, __VA_ARGS__)

TEST_P(Simd, FloatArithmetic) {
  const auto a = test_values(1), b = test_values(2), c = test_values(3);
  EXPECT_SAME2(x + y, a, b);
  EXPECT_SAME2(x - y, a, b);
  EXPECT_SAME2(x * y, a, b);
  EXPECT_SAME2(x / y, a, b);
  EXPECT_SAME2(x += y, a, b);
  EXPECT_SAME2(x *= y, a, b);
  EXPECT_SAME2(min(x, y), a, b);
  EXPECT_SAME2(max(x, y), a, b);
  EXPECT_SAME2(copysign(x, y), a, b);
  EXPECT_SAME3(fma(x, y, z), a, b, c);
  EXPECT_SAME3(clamp(x, y, z), a, b, c);
  EXPECT_SAME3(x * y + z, a, b, c);
  EXPECT_SAME(-x, a);
  EXPECT_SAME(sqrt(x), a);
  EXPECT_SAME(floor(x), a);
  EXPECT_SAME(abs(x), a);
  EXPECT_SAME(is_finite(x), a);
}

TEST_P(Simd, FloatComparisonsAndSelect) {
  const auto a = test_values(1), b = test_values(2), c = test_values(3);
  EXPECT_SAME2(x < y, a, b);
  EXPECT_SAME2(x <= y, a, b);
  EXPECT_SAME2(x > y, a, b);
  EXPECT_SAME2(x >= y, a, b);
  EXPECT_SAME2(x == y, a, b);
  EXPECT_SAME2(x != y, a, b);
  EXPECT_SAME3((!(x < y)) & (y < z), a, b, c);
  EXPECT_SAME3((!(x < y)) | (y < z), a, b, c);
  EXPECT_SAME3(as_uint(select(x < y, y, z)), a, b, c);
}

TEST_P(Simd, Integers) {
  const auto a = test_bits(1), b = test_bits(2), c = test_bits(3);
  EXPECT_SAME2(x + y, a, b);
  EXPECT_SAME2(x - y, a, b);
  EXPECT_SAME2(x * y, a, b);
  EXPECT_SAME2((x & y) | (x ^ y), a, b);
  EXPECT_SAME2(x < y, a, b);
  EXPECT_SAME2(x >= y, a, b);
  EXPECT_SAME2(as_int(x) < as_int(y), a, b);
  EXPECT_SAME2(as_int(x) == as_int(y), a, b);
  EXPECT_SAME3(select(x > y, y, z), a, b, c);
  EXPECT_SAME3(select(x > y, as_int(y), as_int(z)), a, b, c);
  EXPECT_SAME(x << 9, a);
  EXPECT_SAME(x >> 8, a);
  EXPECT_SAME(as_int(x) >> 3, a);
  EXPECT_SAME(as_int(x) << 1, a);
}

TEST_P(Simd, Conversions) {
  const auto bits = test_bits(1);
  std::vector<float> in_range(bits.size());
  for (std::size_t i = 0; i < bits.size(); ++i) {
    in_range[i] = (unit_float(bits[i]) - 0.5f) * (i % 2 ? 0x1.fffffep31f : 16.0f);
  }
  EXPECT_SAME(to_float(as_int(x)), bits);
  EXPECT_SAME(to_int(x), in_range);
  EXPECT_SAME(unit_float(x), bits);
  // Bits pass through casts untouched.
  for_each_width([&](auto width) {
    constexpr int W = width();
    for (std::size_t i = 0; i + W <= bits.size(); i += W) {
      const auto u = load<UInt<W>>(&bits[i]);
      ASSERT_TRUE(all(as_uint(as_float(u)) == u));
      ASSERT_TRUE(all(as_uint(as_int(u)) == u));
    }
  });
}

TEST_P(Simd, SplatKeepsEveryBit) {
  for_each_width([&](auto width) {
    constexpr int W = width();
    for (const float x : special_values()) {
      if (GetParam() && !std::isnormal(x) && x != 0.0f) continue;  // flushed by design
      const Float<W> v(x);
      for (int k = 0; k < W; ++k) EXPECT_TRUE(same_value(v[k], x)) << x << " W=" << W;
    }
    EXPECT_EQ(as_uint(Float<W>(-0.0f)[W - 1]), 0x80000000u);
    EXPECT_EQ(UInt<W>(~0u)[W - 1], ~0u);
    EXPECT_EQ(Int<W>(-7)[0], -7);
  });
}

TEST_P(Simd, MaskReductions) {
  for_each_width([](auto width) {
    constexpr int W = width();
    const Int<W> lanes = lane_indices<W>();
    for (int k = 0; k < W; ++k) EXPECT_EQ(lanes[k], k);
    for (std::uint32_t pattern = 0; pattern < 1u << W; pattern += (W == 16 ? 7u : 1u)) {
      std::int32_t members[W];
      for (int k = 0; k < W; ++k) members[k] = std::int32_t(pattern >> k & 1u);
      const Mask<W> m = load<Int<W>>(members) == Int<W>(1);
      ASSERT_EQ(bits(m), pattern);
      ASSERT_EQ(any(m), pattern != 0);
      ASSERT_EQ(none(m), pattern == 0);
      ASSERT_EQ(all(m), pattern == (1u << W) - 1u);
      ASSERT_EQ(count(m), std::popcount(pattern));
      ASSERT_EQ(bits(!m), ~pattern & ((1u << W) - 1u));
    }
    EXPECT_TRUE(all(Mask<W>(true)));
    EXPECT_TRUE(none(Mask<W>(false)));
  });
  EXPECT_TRUE(all(true) && any(true) && !none(true) && !any(false) && none(false) && !all(false));
  EXPECT_EQ(count(true), 1);
}

TEST_P(Simd, LoadAndStoreNeedNoAlignment) {
  const auto values = test_bits(5);
  for_each_width([&](auto width) {
    constexpr int W = width();
    std::vector<std::uint32_t> out(W + 3, 42u);
    store(&out[1], load<UInt<W>>(&values[3]));
    for (int k = 0; k < W; ++k) EXPECT_EQ(out[size_t(k + 1)], values[size_t(k + 3)]);
    EXPECT_EQ(out[0], 42u);
    EXPECT_EQ(out[W + 1], 42u);
    const auto v = load<UInt<W>>(&values[3]);
    for (int k = 0; k < W; ++k) EXPECT_EQ(v[k], values[size_t(k + 3)]);
  });
}

TEST_P(Simd, Gather) {
  const auto floats = test_values(6);
  const auto words = test_bits(7);
  std::vector<std::int32_t> index(4096), signed_words(words.begin(), words.end());
  for (std::uint32_t i = 0; i < index.size(); ++i) {
    index[i] = std::int32_t(pcg3d(i, 1u, 2u).y % floats.size());
  }
  expect_same_at_every_width(
      "gather float", [&](auto i) { return as_uint(gather(floats.data(), i)); }, index);
  expect_same_at_every_width(
      "gather uint32", [&](auto i) { return gather(words.data(), i); }, index);
  expect_same_at_every_width(
      "gather int32", [&](auto i) { return gather(signed_words.data(), i); }, index);
  // Negative offsets from inside an array.
  const float* middle = floats.data() + floats.size() - 1;
  expect_same_at_every_width(
      "gather backwards", [&](auto i) { return as_uint(gather(middle, -i)); }, index);
}

TEST(SimdScalar, OperationsAreWhatTheirNamesSay) {
  EXPECT_EQ(min(1.0f, not_a_number) != min(1.0f, not_a_number), true);
  EXPECT_EQ(min(not_a_number, 1.0f), 1.0f);
  EXPECT_EQ(max(not_a_number, 1.0f), 1.0f);
  EXPECT_EQ(floor(-0.25f), -1.0f);
  EXPECT_EQ(to_int(-2.75f), -2);
  EXPECT_EQ(copysign(3.0f, -0.0f), -3.0f);
  EXPECT_EQ(abs(-0.0f), 0.0f);
  EXPECT_FALSE(std::signbit(abs(-0.0f)));
  EXPECT_TRUE(is_finite(largest));
  EXPECT_FALSE(is_finite(infinity));
  EXPECT_FALSE(is_finite(-infinity));
  EXPECT_FALSE(is_finite(not_a_number));
  EXPECT_EQ(select(true, 1, 2), 1);
  EXPECT_EQ(sqrt(9.0f), 3.0f);
#if defined(__FMA__) || defined(__aarch64__)
  EXPECT_EQ(fma(0x1.000002p0f, 0x1.000002p0f, -0x1.000004p0f), 0x1p-46f);
#endif
}

}  // namespace
}  // namespace lockstep::test_simd
