// A dither mask whose neighbouring values differ as much as can be, and which tiles.
#pragma once

#include <cstdint>

namespace lockstep {

inline constexpr int blue_noise_bits = 12;
inline constexpr int blue_noise_side = 1 << blue_noise_bits / 2;

// Ranks, row by row, each number below blue_noise_side^2 once. By void-and-cluster
// (Ulichney 1993, "The Void-and-Cluster Method for Dither Array Generation", with sigma 1.5).
extern const std::uint32_t blue_noise_mask[blue_noise_side * blue_noise_side];

}  // namespace lockstep
