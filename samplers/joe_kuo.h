// Generator matrices of Sobol's sequence.
#pragma once

#include <cstdint>

namespace lockstep {

inline constexpr int joe_kuo_dimensions = 1024;

// 32 columns for each dimension, one after the other: the digits that bit j of the index flips,
// mirrored, so that bit i is the i-th digit behind the point. From the direction numbers
// new-joe-kuo-6 (Joe and Kuo 2008).
extern const std::uint32_t joe_kuo_matrices[joe_kuo_dimensions * 32];

}  // namespace lockstep
