// Which pair of sample dimensions serves which purpose. A purpose at a bounce always has the same
// pair, whatever happened before: nothing counts dimensions as it goes.
#pragma once

namespace lockstep {

inline constexpr int pixel_pair = 0;  // position in the pixel filter

// The pairs of a surface interaction. Light: which light, and where on it; Choice: which lobe.
enum class Purpose { Light, Bsdf, Choice, Roulette };

// `bounce` counts interactions from 0.
constexpr int sample_pair(int bounce, Purpose purpose) { return 1 + 4 * bounce + int(purpose); }

// Position on the lens: the pair of a roulette that is not played where there is one.
inline constexpr int lens_pair = sample_pair(0, Purpose::Roulette);

// Pairs are numbered below 4096 (see random_point).
inline constexpr int max_depth = 1020;
inline constexpr int max_pairs = 4096;

}  // namespace lockstep
