#include "experiments/metrics/error_spectrum.h"

#include <kiss_fftnd.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <memory>
#include <new>

namespace lockstep {
namespace {

using Values = std::vector<kiss_fft_cpx>;

// The transform of an image's values, row by row.
Values transformed(const Values& values, int width, int height) {
  const int sides[] = {height, width};
  const std::unique_ptr<kiss_fftnd_state, decltype(&std::free)> plan(
      kiss_fftnd_alloc(sides, 2, 0, nullptr, nullptr), &std::free);
  if (!plan) throw std::bad_alloc();
  Values frequencies(values.size());
  kiss_fftnd(plan.get(), values.data(), frequencies.data());
  return frequencies;
}

// The longest side up to `side` that is transformed fast: a prime factor p takes time in p^2.
int fast_side(int side) {
  constexpr int largest_factor = 127;
  for (; side > largest_factor; --side) {
    int rest = side;
    for (int factor = 2; factor <= largest_factor; ++factor) {
      while (rest % factor == 0) rest /= factor;
    }
    if (rest == 1) break;
  }
  return side;
}

// The luminance of the error in the upper left `width` x `height` pixels, less its mean.
Values error_luminance(const Image& reference, const Image& test, int width, int height) {
  std::vector<double> luminance;
  double mean = 0.0;
  for (int y = 0; y < height; ++y) {
    const float *r = reference.at(0, y), *t = test.at(0, y);
    for (int x = 0; x < width; ++x, r += 3, t += 3) {
      const auto error = [&](int c) { return double(t[c]) - double(r[c]); };
      luminance.push_back(0.2126 * error(0) + 0.7152 * error(1) + 0.0722 * error(2));
      mean += luminance.back() / (double(width) * double(height));
    }
  }
  Values values;
  for (double value : luminance) values.push_back({float(value - mean), 0.0f});
  return values;
}

// Power added up over frequencies, of which there are `count`.
struct Sum {
  double power = 0.0;
  double count = 0.0;

  void add(double value) {
    power += value;
    count += 1.0;
  }
  double mean() const { return count > 0.0 ? power / count : 0.0; }
};

}  // namespace

ErrorSpectrum error_spectrum(const Image& reference, const Image& test, int bins) {
  const int width = fast_side(reference.width), height = fast_side(reference.height);
  const double pixels = double(width) * double(height);
  const Values transform =
      transformed(error_luminance(reference, test, width, height), width, height);
  std::vector<Sum> rings(std::size_t(std::max(bins, 1)));
  Sum all;
  for (int row = 0; row < height; ++row) {
    const double fy = double(std::min(row, height - row)) / height;
    for (int column = 0; column < width; ++column) {
      const double fx = double(std::min(column, width - column)) / width;
      const double frequency = std::hypot(fx, fy);
      if (frequency == 0.0) continue;
      const auto [re, im] = transform[std::size_t(row) * std::size_t(width) + std::size_t(column)];
      const double power = (double(re) * double(re) + double(im) * double(im)) / pixels;
      all.add(power);
      const std::size_t ring = std::size_t(2.0 * frequency * double(rings.size()));
      if (frequency <= 0.5) rings[std::min(ring, rings.size() - 1)].add(power);
    }
  }
  ErrorSpectrum spectrum{{}, all.mean()};
  for (std::size_t i = 0; i < rings.size(); ++i) {
    const double middle = (double(i) + 0.5) / (2.0 * double(rings.size()));
    if (rings[i].count > 0.0) spectrum.rings.push_back({middle, rings[i].mean()});
  }
  return spectrum;
}

void average_in(ErrorSpectrum& mean, const ErrorSpectrum& next, int count) {
  if (mean.rings.empty()) mean.rings = next.rings;
  const auto blend = [&](double& value, double added) { value += (added - value) / count; };
  blend(mean.white, next.white);
  for (std::size_t i = 0; i < mean.rings.size(); ++i) {
    blend(mean.rings[i].power, next.rings[i].power);
  }
}

}  // namespace lockstep
