// Filters that are the product of a row of weights and a column of weights.
#pragma once

#include "core/image.h"

#include <cstddef>
#include <vector>

namespace lockstep {

// exp(-i^2 / (2 sigma^2)) for i from -radius to radius, summing to one.
std::vector<float> gaussian_weights(float sigma, int radius);

// sums[i] = sum over k of weights[k] * values[i + k * step] for i below `count`, added up in the
// order of k.
void weighted_sums(float* sums, const float* values, std::ptrdiff_t step,
                   const std::vector<float>& weights, int count);

// Sums of horizontal[i] * vertical[j] * pixel (x + i - radius, y + j - radius), all channels alike;
// beyond the borders the nearest pixel counts. Both rows of weights have odd lengths.
Image separable_filter(const Image& image, const std::vector<float>& horizontal,
                       const std::vector<float>& vertical);

}  // namespace lockstep
