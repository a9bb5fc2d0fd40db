#include "experiments/metrics/separable_filter.h"

#include "core/vector_clones.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace lockstep {
namespace {

constexpr int kStripRows = 64;  // filtered in both directions while they are in the cache
constexpr int kBlock = 32;      // sums kept in registers

LOCKSTEP_VECTOR_CLONES
void sums_of(float* __restrict sums, const float* __restrict values, std::ptrdiff_t step,
             const float* __restrict weights, std::ptrdiff_t taps, int count) {
  int i = 0;
  for (; i + kBlock <= count; i += kBlock) {
    float block[kBlock] = {};
    for (std::ptrdiff_t k = 0; k < taps; ++k) {
      const float weight = weights[k];
      const float* from = values + i + k * step;
      for (int j = 0; j < kBlock; ++j) block[j] += weight * from[j];
    }
    for (int j = 0; j < kBlock; ++j) sums[i + j] = block[j];
  }
  for (; i < count; ++i) {
    float sum = 0.0f;
    for (std::ptrdiff_t k = 0; k < taps; ++k) sum += weights[k] * values[i + k * step];
    sums[i] = sum;
  }
}

// A row with `radius` copies of its first and last pixels on either side.
void pad_row(const Image& image, int y, int radius, std::vector<float>& padded) {
  const std::size_t channels = std::size_t(image.channels);
  padded.resize(std::size_t(image.width + 2 * radius) * channels);
  float* to = padded.data();
  for (int i = 0; i < radius; ++i) to = std::copy_n(image.at(0, y), channels, to);
  to = std::copy_n(image.at(0, y), std::size_t(image.width) * channels, to);
  for (int i = 0; i < radius; ++i) to = std::copy_n(image.at(image.width - 1, y), channels, to);
}

struct Filter {
  const std::vector<float>& horizontal;
  const std::vector<float>& vertical;
};

void filter_strip(const Image& image, const Filter& filter, int begin, int end, Image& result) {
  const int across = int(filter.horizontal.size()) / 2;
  const int down = int(filter.vertical.size()) / 2;
  const int values = image.width * image.channels;
  std::vector<float> padded, rows(std::size_t(end - begin + 2 * down) * std::size_t(values));
  float* row = rows.data();
  for (int y = begin - down; y < end + down; ++y, row += values) {
    pad_row(image, std::clamp(y, 0, image.height - 1), across, padded);
    weighted_sums(row, padded.data(), image.channels, filter.horizontal, values);
  }
  row = rows.data();
  for (int y = begin; y < end; ++y, row += values) {
    weighted_sums(result.at(0, y), row, values, filter.vertical, values);
  }
}

}  // namespace

void weighted_sums(float* sums, const float* values, std::ptrdiff_t step,
                   const std::vector<float>& weights, int count) {
  sums_of(sums, values, step, weights.data(), std::ptrdiff_t(weights.size()), count);
}

std::vector<float> gaussian_weights(float sigma, int radius) {
  std::vector<float> weights;
  float sum = 0.0f;
  for (int i = -radius; i <= radius; ++i) {
    weights.push_back(std::exp(-float(i * i) / (2.0f * sigma * sigma)));
    sum += weights.back();
  }
  for (float& weight : weights) weight /= sum;
  return weights;
}

Image separable_filter(const Image& image, const std::vector<float>& horizontal,
                       const std::vector<float>& vertical) {
  Image result(image.width, image.height, image.channels);
  const Filter filter{horizontal, vertical};
  tbb::parallel_for(0, (image.height + kStripRows - 1) / kStripRows, [&](int strip) {
    const int begin = strip * kStripRows;
    filter_strip(image, filter, begin, std::min(begin + kStripRows, image.height), result);
  });
  return result;
}

}  // namespace lockstep
