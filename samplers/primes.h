// The bases of Halton's sequence.
#pragma once

#include <cstdint>

namespace lockstep {

inline constexpr int halton_dimensions = 1024;

// The first primes, one for each dimension.
extern const std::uint32_t halton_primes[halton_dimensions];

}  // namespace lockstep
