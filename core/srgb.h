// The sRGB curve both ways (IEC 61966-2-1). Values outside [0, 1] are not clamped.
#pragma once

#include <cmath>

namespace lockstep {

inline float srgb_from_linear(float value) {
  return value <= 0.0031308f ? 12.92f * value : 1.055f * std::pow(value, 1.0f / 2.4f) - 0.055f;
}

inline float linear_from_srgb(float value) {
  return value <= 0.04045f ? value / 12.92f : std::pow((value + 0.055f) / 1.055f, 2.4f);
}

}  // namespace lockstep
