// Weights of randomized coherent sampling from a pilot image (Staal and Hachisuka, step 2).
#pragma once

#include "core/image.h"
#include "samplers/sampler_spec.h"

namespace lockstep {

struct WeightSettings {
  float c = 4.0f;
  float t = 0.02f;
  WeightFilter filter = WeightFilter::Gaussian;
};

// The pilot after the filter. Gaussian: 5x5, sigma 1 pixel, normalised inside the image.
// Median: 3x3, each channel by itself.
Image filter_pilot(const Image& pilot, WeightFilter filter);

// d of pixel (x, y): the largest |a - b| / max(a, b) over its eight neighbours inside the image and
// the three channels; 0 where both are 0. In [0, 1] for images without negative values.
float relative_difference(const Image& image, int x, int y);

// One channel: w = min(1, c d) where d >= t, else 0.
Image make_weights(const Image& pilot, const WeightSettings& settings);

// Weights without parameters: what is shared is seen as structure only where it can be seen at all.
// w = 1 where the image's noise will be above the threshold of vision, and in proportion below it.
// `variance`: of the pilot's mean, by channel; smoothed here. The image's variance will be
// `variance_ratio` times it. One channel.
Image make_auto_weights(const Image& pilot, const Image& variance, double variance_ratio);

// A variance for a pilot of one sample per pixel: that of the values within a pixel's distance, by
// channel. Structure counts as noise there: edges are rendered as if they were noisy.
Image variance_of_neighbours(const Image& pilot);

// The mean over all pixels, and the share of those where the weight is 0.
double mean_weight(const Image& weights);
double share_of_zeros(const Image& weights);

}  // namespace lockstep
