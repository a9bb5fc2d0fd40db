#include "experiments/metrics.h"

#include "core/error.h"
#include "experiments/squared_error.h"

#include <fmt/format.h>

#include <cmath>

namespace lockstep {
namespace {

void check_finite(const Image& image, std::string_view name) {
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    if (std::isfinite(image.pixels[i])) continue;
    const std::size_t pixel = i / std::size_t(image.channels);
    throw Error(
        fmt::format("{}: pixel ({}, {}) is not finite; no metric is defined for such an image",
                    name, pixel % std::size_t(image.width), pixel / std::size_t(image.width)));
  }
}

}  // namespace

const std::vector<Metric>& metrics() {
  static const std::vector<Metric> table = {
      {"rmse", "RMSE", "radiance", true, rmse},
      {"relmse", "relMSE", "", true, relmse},
      {"relmse_trimmed", "relMSE, worst 0.1 % of pixels left out", "", true, relmse_trimmed},
  };
  return table;
}

std::vector<double> evaluate_metrics(const Image& reference, const Image& test,
                                     std::string_view reference_name, std::string_view test_name) {
  if (reference.width != test.width || reference.height != test.height ||
      reference.channels != test.channels) {
    throw Error(
        fmt::format("{} is {}x{} with {} channels, {} is {}x{} with {}; compare images of one size",
                    reference_name, reference.width, reference.height, reference.channels,
                    test_name, test.width, test.height, test.channels));
  }
  check_finite(reference, reference_name);
  check_finite(test, test_name);
  std::vector<double> values;
  for (const Metric& metric : metrics()) values.push_back(metric.evaluate(reference, test));
  return values;
}

}  // namespace lockstep
