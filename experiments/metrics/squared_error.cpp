#include "experiments/metrics/squared_error.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace lockstep {
namespace {

constexpr double kDarkest = 0.01;             // keeps errors finite where images are black
constexpr std::size_t kPixelsPerTrim = 1000;  // one pixel in this many is left out

double mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (double value : values) sum += value;
  return values.empty() ? 0.0 : sum / double(values.size());
}

// relMSE of each pixel, averaged over its channels.
std::vector<double> relative_errors(const Image& reference, const Image& test) {
  const std::size_t channels = std::size_t(reference.channels);
  std::vector<double> errors(reference.pixels.size() / channels, 0.0);
  for (std::size_t i = 0; i < reference.pixels.size(); ++i) {
    const double r = reference.pixels[i];
    const double d = test.pixels[i] - r;
    errors[i / channels] += d * d / ((r * r + kDarkest) * double(channels));
  }
  return errors;
}

}  // namespace

double mse(const Image& reference, const Image& test) {
  double sum = 0.0;
  for (std::size_t i = 0; i < reference.pixels.size(); ++i) {
    const double d = double(test.pixels[i]) - double(reference.pixels[i]);
    sum += d * d;
  }
  return sum / double(std::max<std::size_t>(1, reference.pixels.size()));
}

double rmse(const Image& reference, const Image& test) { return std::sqrt(mse(reference, test)); }

double relmse(const Image& reference, const Image& test) {
  return mean(relative_errors(reference, test));
}

double relmse_trimmed(const Image& reference, const Image& test) {
  std::vector<double> errors = relative_errors(reference, test);
  const std::size_t kept = errors.size() - errors.size() / kPixelsPerTrim;
  if (kept < errors.size()) {
    std::nth_element(errors.begin(), errors.begin() + kept, errors.end());
    errors.resize(kept);
  }
  return mean(errors);
}

double smape(const Image& reference, const Image& test) {
  double sum = 0.0;
  for (std::size_t i = 0; i < reference.pixels.size(); ++i) {
    const double r = reference.pixels[i], t = test.pixels[i];
    sum += std::abs(t - r) / (std::abs(t) + std::abs(r) + kDarkest);
  }
  return sum / double(std::max<std::size_t>(1, reference.pixels.size()));
}

}  // namespace lockstep
