// At which spatial frequencies an image errs: white noise is seen less than blotches.
#pragma once

#include "core/image.h"

#include <vector>

namespace lockstep {

// The power spectrum of the error (test - reference) of the luminance 0.2126 R + 0.7152 G +
// 0.0722 B, averaged over rings: entry i for frequencies in [i, i + 1) / (2 bins) cycles per pixel,
// the last one with 1/2; higher ones, which only diagonals have, are left out. The mean of the
// error is removed first, and frequency zero belongs to no ring. Entries of rings without a
// frequency of the image are 0.
// The power at a frequency is |F|^2 / pixels, with F = sum of error * exp(-2 pi i f x): its mean
// over all frequencies is the error's mean square (Parseval), and white noise of variance v has v
// in every ring.
std::vector<double> radial_spectrum(const Image& reference, const Image& test, int bins);

}  // namespace lockstep
