#include "experiments/metrics/structural_error.h"

#include "experiments/metrics/separable_filter.h"
#include "experiments/metrics/squared_error.h"
#include "experiments/output/display_image.h"

#include <functional>

namespace lockstep {
namespace {

constexpr float kLowPassSigma = 4.0f;
constexpr int kLowPassRadius = 12;

constexpr float kWindowSigma = 1.5f;
constexpr int kWindowRadius = 5;
constexpr float kC1 = 0.01f * 0.01f;  // Wang et al. 2004, eqs. 7 and 9, for a range of 1
constexpr float kC2 = 0.03f * 0.03f;

template <typename Function>
Image combined(const Image& p, const Image& q, Function function) {
  Image result(p.width, p.height, p.channels);
  for (std::size_t i = 0; i < p.pixels.size(); ++i) {
    result.pixels[i] = function(p.pixels[i], q.pixels[i]);
  }
  return result;
}

// Similarity around each pixel (Wang et al. 2004, eq. 13).
Image similarity(const Image& x, const Image& y) {
  const std::vector<float> window = gaussian_weights(kWindowSigma, kWindowRadius);
  const auto mean = [&](const Image& image) { return separable_filter(image, window, window); };
  const auto mean_product = [&](const Image& p, const Image& q) {
    return mean(combined(p, q, std::multiplies<>()));
  };
  const Image mx = mean(x), my = mean(y);
  const Image xx = mean_product(x, x), yy = mean_product(y, y), xy = mean_product(x, y);
  Image result(x.width, x.height, 1);
  for (std::size_t i = 0; i < result.pixels.size(); ++i) {
    const float a = mx.pixels[i], b = my.pixels[i];
    const float variances = (xx.pixels[i] - a * a) + (yy.pixels[i] - b * b);
    const float covariance = xy.pixels[i] - a * b;
    result.pixels[i] = (2.0f * a * b + kC1) * (2.0f * covariance + kC2) /
                       ((a * a + b * b + kC1) * (variances + kC2));
  }
  return result;
}

// How much of a side is left out at either end.
int margin(int size) { return size > 2 * kWindowRadius ? kWindowRadius : 0; }

}  // namespace

double low_pass_rmse(const Image& reference, const Image& test) {
  const std::vector<float> weights = gaussian_weights(kLowPassSigma, kLowPassRadius);
  const Image error = combined(test, reference, std::minus<>());
  const Image blurred = separable_filter(error, weights, weights);
  return rmse(Image(error.width, error.height, error.channels), blurred);
}

double ssim(const Image& reference, const Image& test) {
  const Image map = similarity(display_luma(reference), display_luma(test));
  const int left = margin(map.width), top = margin(map.height);
  double sum = 0.0;
  for (int y = top; y < map.height - top; ++y) {
    for (int x = left; x < map.width - left; ++x) sum += *map.at(x, y);
  }
  return sum / (double(map.width - 2 * left) * double(map.height - 2 * top));
}

}  // namespace lockstep
