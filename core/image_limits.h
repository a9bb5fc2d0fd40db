// Larger images are refused before they are decoded: a damaged header may claim any size.
#pragma once

#include <cstddef>

namespace lockstep {

inline constexpr int max_image_side = 1 << 17;
inline constexpr std::size_t max_image_pixels = std::size_t(1) << 28;

}  // namespace lockstep
