#include "experiments/error_spectrum.h"

#include <fftw3.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <mutex>

namespace lockstep {
namespace {

struct Free {
  void operator()(void* memory) const { fftw_free(memory); }
};
template <typename Value>
using Buffer = std::unique_ptr<Value[], Free>;

// The transform of real values, row by row; each row has its first width / 2 + 1 frequencies.
Buffer<fftw_complex> transformed(double* values, int width, int height) {
  static std::mutex planner;  // all of FFTW but executing a plan
  const std::size_t count = std::size_t(height) * (std::size_t(width) / 2 + 1);
  Buffer<fftw_complex> frequencies(fftw_alloc_complex(count));
  std::unique_lock lock(planner);
  fftw_plan plan = fftw_plan_dft_r2c_2d(height, width, values, frequencies.get(), FFTW_ESTIMATE);
  lock.unlock();
  fftw_execute(plan);
  lock.lock();
  fftw_destroy_plan(plan);
  return frequencies;
}

// The luminance of the error, less its mean.
Buffer<double> error_luminance(const Image& reference, const Image& test) {
  const std::size_t count = reference.pixels.size() / 3;
  Buffer<double> luminance(fftw_alloc_real(count));
  double sum = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    const auto error = [&](std::size_t c) {
      return double(test.pixels[3 * i + c]) - double(reference.pixels[3 * i + c]);
    };
    luminance[i] = 0.2126 * error(0) + 0.7152 * error(1) + 0.0722 * error(2);
    sum += luminance[i];
  }
  for (std::size_t i = 0; i < count; ++i) luminance[i] -= sum / double(count);
  return luminance;
}

struct Ring {
  double power = 0.0;
  double frequencies = 0.0;
};

}  // namespace

std::vector<double> radial_spectrum(const Image& reference, const Image& test, int bins) {
  const int width = reference.width, height = reference.height, columns = width / 2 + 1;
  const Buffer<double> error = error_luminance(reference, test);
  const Buffer<fftw_complex> transform = transformed(error.get(), width, height);
  std::vector<Ring> rings(std::size_t(std::max(bins, 1)));
  for (int row = 0; row < height; ++row) {
    const double fy = double(std::min(row, height - row)) / height;
    for (int column = 0; column < columns; ++column) {
      const double frequency = std::hypot(double(column) / width, fy);
      if (frequency == 0.0 || frequency > 0.5) continue;
      // Frequencies to the right of the middle mirror those on the left.
      const double copies = column == 0 || 2 * column == width ? 1.0 : 2.0;
      const double* f = transform[std::size_t(row) * std::size_t(columns) + std::size_t(column)];
      Ring& ring =
          rings[std::min(std::size_t(2.0 * frequency * double(rings.size())), rings.size() - 1)];
      ring.power += copies * (f[0] * f[0] + f[1] * f[1]);
      ring.frequencies += copies;
    }
  }
  std::vector<double> spectrum;
  for (const Ring& ring : rings) {
    const double pixels = double(width) * double(height);
    spectrum.push_back(ring.frequencies > 0.0 ? ring.power / (ring.frequencies * pixels) : 0.0);
  }
  return spectrum;
}

}  // namespace lockstep
