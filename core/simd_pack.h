// Packing the lanes of a mask to the front, many vectors by one mask.
#pragma once

#include "core/simd.h"

#include <array>

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

namespace detail {

// Row m lists the lanes set in m, a byte each; the rest names lane 0.
template <int W>
constexpr auto packed_lanes() {
  std::array<std::array<std::uint8_t, W>, (1u << W)> table{};
  for (unsigned m = 0; m < (1u << W); ++m) {
    int n = 0;
    for (int lane = 0; lane < W; ++lane) {
      if (m >> lane & 1u) table[m][size_t(n++)] = std::uint8_t(lane);
    }
  }
  return table;
}

#if defined(__AVX2__) && !defined(__AVX512VL__)
constexpr auto packed_lanes_8 = packed_lanes<8>();
#endif
#if (defined(__SSE4_1__) && !defined(__AVX512VL__)) || defined(__aarch64__)
// The same for four lanes, as the bytes that pshufb and tbl move.
constexpr auto packed_bytes_4 = [] {
  std::array<std::array<std::uint8_t, 16>, 16> table{};
  const auto lanes = packed_lanes<4>();
  for (size_t m = 0; m < 16; ++m) {
    for (size_t byte = 0; byte < 16; ++byte) {
      table[m][byte] = std::uint8_t(4 * lanes[m][byte / 4] + byte % 4);
    }
  }
  return table;
}();
#endif

}  // namespace detail

// Moves the lanes where a mask is set to the front, in order.
template <int W>
class Packing {
 public:
  LOCKSTEP_INLINE explicit Packing(LaneMask<W> m) : mask_(bits(m)) {}

  LOCKSTEP_INLINE int count() const { return std::popcount(mask_); }

  // Writes count() elements to p. May write W in all: leave room behind the end.
  template <class T>
  LOCKSTEP_INLINE void store(T* p, Lanes<T, W> v) const {
    write(p, v, mask_);
  }

 private:
  template <class T, int N>
  LOCKSTEP_INLINE static void write(T* p, Lanes<T, N> v, std::uint32_t mask) {
    if constexpr (!Lanes<T, N>::native) {
      const std::uint32_t low = mask & ((1u << (N / 2)) - 1u);
      write(p, v.s.lo, low);
      write(p + std::popcount(low), v.s.hi, mask >> (N / 2));
#if defined(__AVX512VL__)
    } else if constexpr (N == 16) {
      _mm512_storeu_si512(p, _mm512_maskz_compress_epi32(__mmask16(mask), (__m512i)v.s));
    } else if constexpr (N == 8) {
      _mm256_storeu_si256((__m256i*)p, _mm256_maskz_compress_epi32(__mmask8(mask), (__m256i)v.s));
    } else {
      _mm_storeu_si128((__m128i*)p, _mm_maskz_compress_epi32(__mmask8(mask), (__m128i)v.s));
    }
#else
#if defined(__AVX2__)
    } else if constexpr (N == 8) {
      const auto* row = detail::packed_lanes_8[mask].data();
      const __m256i lanes = _mm256_cvtepu8_epi32(_mm_loadl_epi64((const __m128i*)row));
      _mm256_storeu_si256((__m256i*)p, _mm256_permutevar8x32_epi32((__m256i)v.s, lanes));
#endif
#if defined(__SSE4_1__)
    } else {
      const auto* row = detail::packed_bytes_4[mask].data();
      const __m128i moves = _mm_loadu_si128((const __m128i*)row);
      _mm_storeu_si128((__m128i*)p, _mm_shuffle_epi8((__m128i)v.s, moves));
#elif defined(__aarch64__)
    } else {
      const auto* row = detail::packed_bytes_4[mask].data();
      vst1q_u8((std::uint8_t*)p, vqtbl1q_u8((uint8x16_t)v.s, vld1q_u8(row)));
#else
    } else {
      for (int lane = 0; lane < N; ++lane) {
        if (mask >> lane & 1u) *p++ = v[lane];
      }
#endif
    }
#endif
  }

  std::uint32_t mask_;
};

template <>
class Packing<1> {
 public:
  LOCKSTEP_INLINE explicit Packing(bool m) : mask_(m) {}
  LOCKSTEP_INLINE int count() const { return mask_; }
  template <class T>
  LOCKSTEP_INLINE void store(T* p, T v) const {
    *p = v;
  }

 private:
  bool mask_;
};

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
