#include "experiments/output/preview.h"

#include "core/srgb.h"

#include <algorithm>
#include <cmath>

namespace lockstep {
namespace {

constexpr double kWhiteQuantile = 0.95;
constexpr float kWhite = 0.9f;

}  // namespace

float preview_exposure(const Image& reference) {
  std::vector<float> brightest;
  const std::size_t channels = std::size_t(reference.channels);
  for (std::size_t i = 0; i + channels <= reference.pixels.size(); i += channels) {
    const float* pixel = &reference.pixels[i];
    brightest.push_back(*std::max_element(pixel, pixel + channels));
  }
  if (brightest.empty()) return 1.0f;
  const auto place =
      brightest.begin() + std::ptrdiff_t(kWhiteQuantile * double(brightest.size() - 1));
  std::nth_element(brightest.begin(), place, brightest.end());
  return *place > 0.0f && std::isfinite(*place) ? kWhite / *place : 1.0f;
}

Image exposed(const Image& image, float exposure) {
  Image result = image;
  for (float& value : result.pixels) value *= exposure;
  return result;
}

Image weights_as_grey(const Image& weights) {
  Image grey(weights.width, weights.height, 3);
  for (std::size_t i = 0; i < grey.pixels.size(); ++i) {
    const float w = weights.pixels[i / 3 * std::size_t(weights.channels)];
    grey.pixels[i] = linear_from_srgb(std::clamp(w, 0.0f, 1.0f));
  }
  return grey;
}

}  // namespace lockstep
