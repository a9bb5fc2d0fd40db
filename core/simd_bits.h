// Bits in mirrored order: bit 0 becomes bit 31.
#pragma once

#include "core/simd.h"

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

namespace detail {

template <class U>
LOCKSTEP_INLINE U reverse_by_halves(U x) {
  x = (x >> 16) | (x << 16);
  x = ((x & U(0xff00ff00u)) >> 8) | ((x & U(0x00ff00ffu)) << 8);
  x = ((x & U(0xf0f0f0f0u)) >> 4) | ((x & U(0x0f0f0f0fu)) << 4);
  x = ((x & U(0xccccccccu)) >> 2) | ((x & U(0x33333333u)) << 2);
  return ((x & U(0xaaaaaaaau)) >> 1) | ((x & U(0x55555555u)) << 1);
}

#if defined(__SSSE3__)

// Looks up 16 bytes by the bytes of `index`, in every 16 bytes of the register.
template <class R>
LOCKSTEP_INLINE R shuffle_bytes(__m128i table, R index) {
#if defined(__AVX512BW__)
  if constexpr (sizeof(R) == 64) {
    return (R)_mm512_shuffle_epi8(_mm512_broadcast_i32x4(table), (__m512i)index);
  }
#endif
#if defined(__AVX2__)
  if constexpr (sizeof(R) == 32) {
    return (R)_mm256_shuffle_epi8(_mm256_broadcastsi128_si256(table), (__m256i)index);
  }
#endif
  if constexpr (sizeof(R) == 16) return (R)_mm_shuffle_epi8(table, (__m128i)index);
}

// Reorders the bytes of every 16.
template <class R>
LOCKSTEP_INLINE R move_bytes(R x, __m128i order) {
#if defined(__AVX512BW__)
  if constexpr (sizeof(R) == 64) {
    return (R)_mm512_shuffle_epi8((__m512i)x, _mm512_broadcast_i32x4(order));
  }
#endif
#if defined(__AVX2__)
  if constexpr (sizeof(R) == 32) {
    return (R)_mm256_shuffle_epi8((__m256i)x, _mm256_broadcastsi128_si256(order));
  }
#endif
  if constexpr (sizeof(R) == 16) return (R)_mm_shuffle_epi8((__m128i)x, order);
}

// Half bytes by table, bytes by a shuffle: a third of the instructions.
template <class R>
LOCKSTEP_INLINE R reverse_by_bytes(R x) {
  const __m128i low = _mm_setr_epi8(0, -128, 64, -64, 32, -96, 96, -32, 16, -112, 80, -48, 48, -80,
                                    112, -16);  // of the lower half byte, reversed
  const __m128i high = _mm_setr_epi8(0, 8, 4, 12, 2, 10, 6, 14, 1, 9, 5, 13, 3, 11, 7, 15);
  const __m128i order = _mm_setr_epi8(3, 2, 1, 0, 7, 6, 5, 4, 11, 10, 9, 8, 15, 14, 13, 12);
  const R mask = 0x0f0f0f0fu - R{};
  return move_bytes(shuffle_bytes(low, x & mask) | shuffle_bytes(high, (x >> 4) & mask), order);
}

#endif

}  // namespace detail

LOCKSTEP_INLINE std::uint32_t reverse_bits(std::uint32_t x) { return detail::reverse_by_halves(x); }

template <int W>
LOCKSTEP_INLINE Lanes<std::uint32_t, W> reverse_bits(Lanes<std::uint32_t, W> x) {
#if defined(__SSSE3__)
  return apply_lanes<Lanes<std::uint32_t, W>>(
      [](auto r) LOCKSTEP_LAMBDA { return detail::reverse_by_bytes(r); }, x);
#elif defined(__aarch64__)
  return apply_lanes<Lanes<std::uint32_t, W>>(
      [](auto r) LOCKSTEP_LAMBDA { return vrev32q_u8(vrbitq_u8((uint8x16_t)r)); }, x);
#else
  return detail::reverse_by_halves(x);
#endif
}

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
