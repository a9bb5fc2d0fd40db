// Tables of progressive multi-jittered (0, 2) points (Christensen, Kensler and Kilpatrick 2018).
#pragma once

#include <cstdint>

namespace lockstep {

inline constexpr std::uint32_t pmj02_points = 4096;  // of a table
inline constexpr std::uint32_t pmj02_tables = 16;    // independent of each other

// x and y of each point as 32-bit fractions, table after table. The first 2^m points of a table
// are a (0, m, 2)-net.
extern const std::uint32_t pmj02_table[2 * pmj02_tables * pmj02_points];

}  // namespace lockstep
