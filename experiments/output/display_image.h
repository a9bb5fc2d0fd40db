// What a display shows of linear images, and maps of values as images for people.
#pragma once

#include "core/image.h"

#include <cstdint>

namespace lockstep {

// The 8-bit sRGB codes of `count` linear values: what an image file of them would hold.
void display_codes(const float* linear, int count, std::uint8_t* codes);

// 0.2126 R + 0.7152 G + 0.0722 B of the sRGB values in [0, 1], one channel: Rec. 709 luma.
Image display_luma(const Image& image);

// A one-channel map in [0, 1] in the colours of matplotlib's magma: black, purple, orange, cream.
// Linear, so that an 8-bit file of it shows them.
Image magma(const Image& map);

// The same in matplotlib's viridis: purple, blue, green, yellow.
Image viridis(const Image& map);

}  // namespace lockstep
