// How far a test image is off where noise has been averaged away: what bias looks like. Both images
// are linear RGB of one size.
#pragma once

#include "core/image.h"

namespace lockstep {

constexpr int kErrorBlock = 16;  // pixels

// Root of the mean over blocks of ((a - b) / (b + 0.01 m))^2, where a and b are the mean luminances
// of a block of 16 x 16 pixels in the test and the reference, and m is the mean luminance of the
// reference. Blocks at the right and lower borders may be smaller; each counts by its pixels.
// Without unit. Not finite where the reference is black and the test is not.
double block_relative_rmse(const Image& reference, const Image& test);

// Mean luminance of the test over that of the reference: 1 where no light is lost or gained. Not
// finite where the reference is black.
double luminance_ratio(const Image& reference, const Image& test);

}  // namespace lockstep
