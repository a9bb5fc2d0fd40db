// What moves lanes and bits about: rows of four, packing by a mask, mirrored bits. Every mask at
// every width, against plain loops.
#include "core/simd_rows.h"

#include "core/simd_bits.h"
#include "core/simd_pack.h"
#include "tests/widths.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>

namespace lockstep::test_simd_rows {
namespace {

// Random bits; as floats they may be NaN, which must pass through untouched.
template <class T>
std::vector<T> random_values(std::size_t count, std::uint32_t seed) {
  std::vector<T> v(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t word = pcg3d(i, seed, 23u).x;
    std::memcpy(&v[i], &word, sizeof word);
  }
  return v;
}

template <class T>
bool same_bits(const T* a, const T* b, int n) {
  return std::memcmp(a, b, size_t(n) * sizeof(T)) == 0;
}

template <int W>
Mask<W> mask_of(std::uint32_t pattern) {
  std::int32_t members[W];
  for (int k = 0; k < W; ++k) members[k] = std::int32_t(pattern >> k & 1u);
  return load<Int<W>>(members) == Int<W>(1);
}

// Rows -----------------------------------------------------------------------------------------

template <class T, int W>
void check_gather_rows() {
  const auto values = random_values<T>(1003, 1);
  for (std::uint32_t round = 0; round < 300; ++round) {
    std::int32_t at[W];
    for (int k = 0; k < W; ++k) {
      // Any place, not only multiples of four, the last one too, and all lanes alike.
      const std::uint32_t of_lane = round % 10 == 0 ? 0u : std::uint32_t(k);
      at[k] = std::int32_t(pcg3d(round, of_lane, 3u).x % 1000u);
    }
    if (round % 3 == 0) at[round % W] = 999;
    const auto rows = gather_rows(values.data(), load<Int<W>>(at));
    T x[W], y[W], z[W], w[W];
    store(x, rows.x), store(y, rows.y), store(z, rows.z), store(w, rows.w);
    for (int k = 0; k < W; ++k) {
      const T row[4] = {x[k], y[k], z[k], w[k]};
      ASSERT_TRUE(same_bits(row, &values[size_t(at[k])], 4)) << "W=" << W << " lane " << k;
    }
  }
}

TEST(Rows, GatherReadsFourElementsPerLane) {
  check_gather_rows<float, 1>();
  check_gather_rows<std::int32_t, 1>();
  for_each_width([](auto width) {
    check_gather_rows<float, width()>();
    check_gather_rows<std::int32_t, width()>();
  });
}

template <int W>
void check_add_rows(std::uint32_t pattern) {
  constexpr int row_count = 40;
  std::vector<float> rows(4 * row_count), expected;
  for (std::uint32_t i = 0; i < rows.size(); ++i) rows[i] = unit_float(pcg3d(i, pattern, 5u).x);
  expected = rows;
  // Rows of their own for the lanes that are set; the others may name any row.
  std::int32_t at[W];
  float add[4][W];
  for (int k = 0; k < W; ++k) {
    at[k] = (pattern >> k & 1u) ? (7 * k + int(pattern % row_count)) % row_count : 3;
    for (int c = 0; c < 4; ++c)
      add[c][k] = unit_float(pcg3d(std::uint32_t(k), 9u, pattern).y) + float(c);
  }
  for (int k = 0; k < W; ++k) {
    for (int c = 0; c < 4 && (pattern >> k & 1u); ++c) expected[size_t(4 * at[k] + c)] += add[c][k];
  }
  using V = Float<W>;
  const Rows<V> values{load<V>(add[0]), load<V>(add[1]), load<V>(add[2]), load<V>(add[3])};
  add_rows(rows.data(), load<Int<W>>(at), values, mask_of<W>(pattern));
  ASSERT_EQ(rows, expected) << "W=" << W << " mask " << pattern;
}

TEST(Rows, AddTouchesTheRowsOfSetLanesOnly) {
  check_add_rows<1>(0);
  check_add_rows<1>(1);
  for_each_width([](auto width) {
    for (std::uint32_t pattern = 0; pattern < 1u << width(); ++pattern) {
      check_add_rows<width()>(pattern);
    }
  });
}

// Packing --------------------------------------------------------------------------------------

template <class T, int W>
void check_packing(const std::vector<T>& values, std::uint32_t pattern) {
  std::vector<T> expected;
  for (int k = 0; k < W; ++k) {
    if (pattern >> k & 1u) expected.push_back(values[size_t(k)]);
  }
  const int n = int(expected.size());
  std::array<T, W + 1> out;
  out.fill(T(42));
  const Packing<W> packing(mask_of<W>(pattern));
  ASSERT_EQ(packing.count(), n);
  packing.store(out.data(), load<std::conditional_t<W == 1, T, Lanes<T, W>>>(values.data()));
  ASSERT_EQ(out[W], T(42)) << "W=" << W << " mask " << pattern;
  ASSERT_TRUE(same_bits(out.data(), expected.data(), n)) << "W=" << W << " mask " << pattern;
}

template <class T>
void check_every_packing(std::uint32_t seed) {
  const auto values = random_values<T>(16, seed);
  check_packing<T, 1>(values, 0);
  check_packing<T, 1>(values, 1);
  for_each_width([&](auto width) {
    for (std::uint32_t pattern = 0; pattern < 1u << width(); ++pattern) {
      check_packing<T, width()>(values, pattern);
    }
  });
}

TEST(PackingLanes, EveryMaskKeepsTheOrderOfItsLanes) {
  check_every_packing<float>(11);
  check_every_packing<std::int32_t>(12);
  check_every_packing<std::uint32_t>(13);
}

// Queues grow by packing one packet after another: what is written past the end is written over.
TEST(PackingLanes, OneAfterAnotherFilterAnArray) {
  const auto values = random_values<std::uint32_t>(1024, 14);
  std::vector<std::uint32_t> even;
  std::copy_if(values.begin(), values.end(), std::back_inserter(even),
               [](std::uint32_t x) { return x % 2 == 0; });
  for_each_width([&](auto width) {
    constexpr int W = width();
    std::vector<std::uint32_t> out(values.size() + W);
    std::size_t n = 0;
    for (std::size_t i = 0; i < values.size(); i += W) {
      const auto x = load<UInt<W>>(&values[i]);
      const Packing<W> packing((x & UInt<W>(1u)) == UInt<W>(0u));
      packing.store(&out[n], x);
      n += size_t(packing.count());
    }
    out.resize(n);
    EXPECT_EQ(out, even) << "W=" << W;
  });
}

// Bits -----------------------------------------------------------------------------------------

std::uint32_t mirrored(std::uint32_t x) {
  std::uint32_t r = 0;
  for (int i = 0; i < 32; ++i) r |= (x >> i & 1u) << (31 - i);
  return r;
}

TEST(Bits, AreMirroredAtEveryWidth) {
  auto words = random_values<std::uint32_t>(16 * 256, 15);
  for (std::size_t i = 0; i < 32; ++i) words[i] = 1u << i;
  words[32] = 0u, words[33] = ~0u;
  for (const std::uint32_t x : words) ASSERT_EQ(reverse_bits(x), mirrored(x)) << x;
  for_each_width([&](auto width) {
    constexpr int W = width();
    for (std::size_t i = 0; i < words.size(); i += W) {
      const auto r = reverse_bits(load<UInt<W>>(&words[i]));
      for (int k = 0; k < W; ++k) {
        ASSERT_EQ(r[k], mirrored(words[i + size_t(k)])) << "W=" << W << " lane " << k;
      }
    }
  });
}

}  // namespace
}  // namespace lockstep::test_simd_rows
