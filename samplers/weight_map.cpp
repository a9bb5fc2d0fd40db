#include "samplers/weight_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace lockstep {
namespace {

// Calls f(x, y) for the pixels within `radius` of (cx, cy) that lie inside the image.
template <class F>
void for_window(const Image& image, int cx, int cy, int radius, F f) {
  for (int y = std::max(0, cy - radius); y <= std::min(image.height - 1, cy + radius); ++y) {
    for (int x = std::max(0, cx - radius); x <= std::min(image.width - 1, cx + radius); ++x) {
      f(x, y);
    }
  }
}

// The Gaussian along one axis: out(x, y) from in(x + k dx, y + k dy), k = -2..2.
Image gaussian_along(const Image& in, int dx, int dy) {
  constexpr std::array<float, 3> taps{1.0f, 0.60653066f, 0.13533528f};  // exp(-k^2 / 2)
  Image out(in.width, in.height);
  for (int y = 0; y < in.height; ++y) {
    for (int x = 0; x < in.width; ++x) {
      std::array<float, 3> sum{};
      float total = 0.0f;
      for (int k = -2; k <= 2; ++k) {
        const int nx = x + k * dx, ny = y + k * dy;
        if (nx < 0 || ny < 0 || nx >= in.width || ny >= in.height) continue;
        const float tap = taps[size_t(std::abs(k))];
        for (std::size_t c = 0; c < 3; ++c) sum[c] += tap * in.at(nx, ny)[c];
        total += tap;
      }
      for (std::size_t c = 0; c < 3; ++c) out.at(x, y)[c] = sum[c] / total;
    }
  }
  return out;
}

// The lower middle value where the window is cut to an even number of pixels.
void median_pixel(const Image& in, int cx, int cy, float* out) {
  for (int c = 0; c < 3; ++c) {
    std::array<float, 9> values{};
    int n = 0;
    for_window(in, cx, cy, 1, [&](int x, int y) { values[size_t(n++)] = in.at(x, y)[c]; });
    const auto middle = values.begin() + (n - 1) / 2;
    std::nth_element(values.begin(), middle, values.begin() + n);
    out[c] = *middle;
  }
}

}  // namespace

Image filter_pilot(const Image& pilot, WeightFilter filter) {
  if (filter == WeightFilter::None) return pilot;
  if (filter == WeightFilter::Gaussian) return gaussian_along(gaussian_along(pilot, 1, 0), 0, 1);
  Image out(pilot.width, pilot.height);
  for (int y = 0; y < pilot.height; ++y) {
    for (int x = 0; x < pilot.width; ++x) median_pixel(pilot, x, y, out.at(x, y));
  }
  return out;
}

float relative_difference(const Image& image, int cx, int cy) {
  float largest = 0.0f;
  for_window(image, cx, cy, 1, [&](int x, int y) {
    for (int c = 0; c < 3; ++c) {
      const float a = image.at(cx, cy)[c], b = image.at(x, y)[c];
      const float reference = std::max(a, b);
      if (reference > 0.0f) largest = std::max(largest, std::abs(a - b) / reference);
    }
  });
  return largest;
}

Image make_weights(const Image& pilot, const WeightSettings& settings) {
  const Image filtered = filter_pilot(pilot, settings.filter);
  Image weights(pilot.width, pilot.height, 1);
  for (int y = 0; y < pilot.height; ++y) {
    for (int x = 0; x < pilot.width; ++x) {
      const float d = relative_difference(filtered, x, y);
      const bool leaves = d > 0.0f && d >= settings.t;  // d = 0 stays, even where c is infinite
      *weights.at(x, y) = leaves ? std::min(1.0f, settings.c * d) : 0.0f;
    }
  }
  return weights;
}

Image make_auto_weights(const Image& pilot, const Image& variance, double variance_ratio) {
  // Differences of one part in a hundred are just seen (Weber's law), above a darkest grey that
  // displays show.
  constexpr double seen = 0.01, darkest = 0.01;
  const Image level = filter_pilot(pilot, WeightFilter::Gaussian);
  // Twice: a variance from one difference is off by more than itself.
  const Image smooth =
      filter_pilot(filter_pilot(variance, WeightFilter::Gaussian), WeightFilter::Gaussian);
  Image weights(pilot.width, pilot.height, 1);
  for (int y = 0; y < pilot.height; ++y) {
    for (int x = 0; x < pilot.width; ++x) {
      double contrast = 0.0;
      for (int c = 0; c < 3; ++c) {
        const double noise = std::sqrt(variance_ratio * double(smooth.at(x, y)[c]));
        contrast = std::max(contrast, noise / (double(level.at(x, y)[c]) + darkest));
      }
      *weights.at(x, y) = float(std::min(1.0, contrast / seen));
    }
  }
  return weights;
}

Image variance_of_neighbours(const Image& pilot) {
  Image variance(pilot.width, pilot.height);
  for (int y = 0; y < pilot.height; ++y) {
    for (int x = 0; x < pilot.width; ++x) {
      for (int c = 0; c < 3; ++c) {
        double sum = 0.0, squares = 0.0, n = 0.0;
        for_window(pilot, x, y, 1, [&](int nx, int ny) {
          // From the middle value: no cancellation where the level is high.
          const double d = double(pilot.at(nx, ny)[c]) - double(pilot.at(x, y)[c]);
          sum += d, squares += d * d, n += 1.0;
        });
        const double v = n > 1.0 ? (squares - sum * sum / n) / (n - 1.0) : 0.0;
        variance.at(x, y)[c] = float(std::max(0.0, v));
      }
    }
  }
  return variance;
}

double mean_weight(const Image& weights) {
  const double sum = std::accumulate(weights.pixels.begin(), weights.pixels.end(), 0.0);
  return weights.pixels.empty() ? 0.0 : sum / double(weights.pixels.size());
}

double share_of_zeros(const Image& weights) {
  const auto zeros = std::count(weights.pixels.begin(), weights.pixels.end(), 0.0f);
  return weights.pixels.empty() ? 0.0 : double(zeros) / double(weights.pixels.size());
}

}  // namespace lockstep
