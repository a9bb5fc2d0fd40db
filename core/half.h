// Half floats on the host (IEEE 754 binary16).
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

namespace lockstep {

inline constexpr float largest_half = 65504.0f;

// Nearest half float, ties to even; the largest one for what lies beyond it. Not for NaN.
inline std::uint16_t half_from_float(float value) {
  const auto sign = std::uint16_t(std::bit_cast<std::uint32_t>(value) >> 16 & 0x8000u);
  const float magnitude = std::fmin(std::fabs(value), largest_half);
  if (magnitude < 0x1p-14f) {  // evenly spaced there, by 2^-24
    return std::uint16_t(sign | unsigned((magnitude * 0x1p24f + 0x1p23f) - 0x1p23f));
  }
  const std::uint32_t bits = std::bit_cast<std::uint32_t>(magnitude);
  const std::uint32_t rounded = bits + 0xfffu + (bits >> 13 & 1u);
  return std::uint16_t(sign | ((rounded >> 13) - ((127u - 15u) << 10)));
}

inline float float_from_half_bits(std::uint16_t half) {
  const int exponent = half >> 10 & 31;
  const float fraction = float(half & 1023);
  const float magnitude = exponent == 0    ? std::ldexp(fraction, -24)
                          : exponent == 31 ? (fraction == 0.0f ? INFINITY : NAN)
                                           : std::ldexp(1024.0f + fraction, exponent - 25);
  return half & 0x8000 ? -magnitude : magnitude;
}

}  // namespace lockstep
