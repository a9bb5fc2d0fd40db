// Errors that depend on how neighbouring pixels err together. Both images are linear RGB of one
// size.
#pragma once

#include "core/image.h"

namespace lockstep {

// RMSE over pixels and channels after the error image was blurred with a Gaussian of standard
// deviation 4 pixels, cut at 12: what of the error a person sees from afar. Fine noise all but
// vanishes, blotches stay. In units of radiance.
double low_pass_rmse(const Image& reference, const Image& test);

// Structural similarity (Wang et al. 2004): Gaussian windows of 11 x 11 pixels and standard
// deviation 1.5 on the Rec. 709 luma of the images clamped to [0, 1] and sRGB-encoded. The mean
// over windows inside the image, or over all pixels along a side shorter than 11. Higher is
// better, 1 for equal images.
double ssim(const Image& reference, const Image& test);

}  // namespace lockstep
