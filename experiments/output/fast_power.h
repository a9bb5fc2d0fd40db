// Powers of floats in arithmetic alone, so that compilers turn loops of them into vectors (g++ with
// -fno-trapping-math).
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <limits>
#include <numbers>

namespace lockstep {

// log2(x) of a normal positive x, to 2e-7 of the larger of itself and 1. With x = 2^e m and m in
// [sqrt(1/2), sqrt(2)): log2(m) = 2/ln(2) (s + s^3/3 + ...), s = (m - 1) / (m + 1).
inline float fast_log2(float x) {
  constexpr std::int32_t root_of_half = 0x3f3504f3;
  const std::int32_t bits = std::bit_cast<std::int32_t>(x);
  const std::int32_t exponent = (bits - root_of_half) >> 23;
  const float m = std::bit_cast<float>(bits - (exponent << 23));
  const float s = (m - 1.0f) / (m + 1.0f), s2 = s * s;
  const float series =
      1.0f + s2 * (1.0f / 3.0f + s2 * (1.0f / 5.0f + s2 * (1.0f / 7.0f + s2 * (1.0f / 9.0f))));
  return float(exponent) + 2.0f * std::numbers::log2e_v<float> * s * series;
}

// 2^x for x in [-126, 127], to a relative 2e-7: 2^i exp(t) with |t| <= ln(2) / 2.
inline float fast_exp2(float x) {
  constexpr float rounding = 12582912.0f;  // 1.5 * 2^23: what is added loses its fraction
  const float whole = (x + rounding) - rounding;
  const float t = (x - whole) * std::numbers::ln2_v<float>;
  const float e =
      1.0f +
      t * (1.0f + t * (1.0f / 2.0f +
                       t * (1.0f / 6.0f + t * (1.0f / 24.0f +
                                               t * (1.0f / 120.0f +
                                                    t * (1.0f / 720.0f + t * (1.0f / 5040.0f)))))));
  return std::bit_cast<float>((std::int32_t(whole) + 127) << 23) * e;
}

// x^p for p >= 0, to a relative 2e-6 where x and the result are between 1e-10 and 1e10; below
// normal floats, and for negative x, the result is 0. 0^0 is 0, too.
inline float fast_power(float x, float p) {
  constexpr float least = std::numeric_limits<float>::min();
  const float power = p * fast_log2(std::max(x, least));
  const float result = fast_exp2(std::min(std::max(power, -126.0f), 126.0f));
  return x >= least ? result : 0.0f;
}

}  // namespace lockstep
