// At which spatial frequencies an image errs: white noise is seen less than blotches.
#pragma once

#include "core/image.h"

#include <vector>

namespace lockstep {

struct SpectrumRing {
  double frequency = 0.0;  // cycles per pixel, the ring's middle
  double power = 0.0;      // mean over the ring's frequencies
};

struct ErrorSpectrum {
  std::vector<SpectrumRing> rings;  // by rising frequency; rings without a frequency are left out
  double white = 0.0;               // power in every ring of white noise of the same total power
};

// The power spectrum of the error (test - reference) of the luminance 0.2126 R + 0.7152 G +
// 0.0722 B, averaged over rings: ring i has the frequencies in [i, i + 1) / (2 bins) cycles per
// pixel, the last one with 1/2; higher ones, which only diagonals have, are in `white` alone. The
// mean of the error is removed first, and frequency zero belongs to no ring.
// The power at a frequency is |F|^2 / pixels, with F = sum of error * exp(-2 pi i f x): its sum
// over all frequencies is the error's sum of squares (Parseval), and white noise of variance v has
// v in every ring. Which rings there are depends on the images' size alone. Sides with a prime
// factor above 127 lose the few last pixels that make it so: transforming them would take minutes.
ErrorSpectrum error_spectrum(const Image& reference, const Image& test, int bins = 32);

// Makes `next` part of `mean`, the mean spectrum of `count` images with it. An empty `mean` (count
// is 1) becomes `next`.
void average_in(ErrorSpectrum& mean, const ErrorSpectrum& next, int count);

}  // namespace lockstep
