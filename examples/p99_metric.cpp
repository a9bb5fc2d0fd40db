// A metric: a column of errors.csv, a choice of the report page, a line of `metrics`.
#include "experiments/metrics/metrics.h"

#include <algorithm>
#include <cmath>

namespace {

using namespace lockstep;

// The error that 99 of 100 values of pixels and channels stay below.
double p99(const Image& reference, const Image& test) {
  std::vector<double> errors;
  for (std::size_t i = 0; i < reference.pixels.size(); ++i) {
    errors.push_back(std::abs(double(test.pixels[i]) - double(reference.pixels[i])));
  }
  const auto place = errors.begin() + std::ptrdiff_t(errors.size() * 99 / 100);
  std::nth_element(errors.begin(), place, errors.end());
  return *place;
}

}  // namespace

void add_p99_metric() {
  add_metric({"p99", "Error that 99 % of values stay below", "radiance"}, p99);
}
