#include "experiments/metrics/flip_side.h"
#include "experiments/metrics/separable_filter.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lockstep {
namespace {

using Weights = FlipFilters::Weights;

constexpr float kFeatureDegrees = 0.082f;  // w, the width of edges that are detected
constexpr float kNegligible = 1e-8f;       // of a sum of weights, less than its rounding

// A Gaussian of the contrast sensitivity functions, a sqrt(pi / b) exp(-pi^2 x^2 / b) with x in
// degrees (table 1); `root` takes the root of its height, for both factors of a product.
struct SensitivityFilter {
  float a, b;
  bool root = false;
};
constexpr SensitivityFilter kAchromatic{1.0f, 0.0047f};
constexpr SensitivityFilter kRedGreen{1.0f, 0.0053f};
constexpr SensitivityFilter kBlueYellow1{34.1f, 0.04f, true};
constexpr SensitivityFilter kBlueYellow2{13.5f, 0.025f, true};
constexpr float kWidestFilter = 0.04f;

Weights weights_of(const SensitivityFilter& filter, float pixels_per_degree) {
  constexpr float pi = std::numbers::pi_v<float>;
  const float deviation = std::sqrt(kWidestFilter / (2.0f * pi * pi));
  const int radius = int(std::ceil(3.0f * deviation * pixels_per_degree));
  const float height = filter.a * std::sqrt(pi / filter.b);
  Weights weights;
  for (int i = -radius; i <= radius; ++i) {
    const float x = float(i) / pixels_per_degree;
    weights.push_back((filter.root ? std::sqrt(height) : height) *
                      std::exp(-pi * pi * x * x / filter.b));
  }
  return weights;
}

float sum_of(const Weights& weights) {
  float sum = 0.0f;
  for (float weight : weights) sum += weight;
  return sum;
}

// Divided by `sum`, without outer weights that change nothing.
Weights normalised(Weights weights, float sum) {
  for (float& weight : weights) weight /= sum;
  std::ptrdiff_t outer = 0;
  while (outer < std::ssize(weights) / 2 && weights[std::size_t(outer)] < kNegligible) ++outer;
  return {weights.begin() + outer, weights.end() - outer};
}

Weights normalised(const Weights& weights) { return normalised(weights, sum_of(weights)); }

// Positive weights sum to one, negative ones to minus one.
void normalise_signs(Weights& weights) {
  float positive = 0.0f, negative = 0.0f;
  for (float weight : weights) (weight > 0.0f ? positive : negative) += std::abs(weight);
  for (float& weight : weights) {
    if (weight != 0.0f) weight /= weight > 0.0f ? positive : negative;
  }
}

}  // namespace

FlipFilters flip_filters(float pixels_per_degree) {
  FlipFilters filters;
  filters.achromatic = normalised(weights_of(kAchromatic, pixels_per_degree));
  filters.red_green = normalised(weights_of(kRedGreen, pixels_per_degree));
  // Blue-yellow is seen through a sum of two Gaussians, each of which is separable.
  const Weights first = weights_of(kBlueYellow1, pixels_per_degree);
  const Weights second = weights_of(kBlueYellow2, pixels_per_degree);
  const float root = std::hypot(sum_of(first), sum_of(second));
  filters.blue_yellow1 = normalised(first, root);
  filters.blue_yellow2 = normalised(second, root);

  const float deviation = 0.5f * kFeatureDegrees * pixels_per_degree;
  const int radius = int(std::ceil(3.0f * deviation));
  filters.smooth = gaussian_weights(deviation, radius);
  for (int i = -radius; i <= radius; ++i) {
    const float weight = filters.smooth[std::size_t(i + radius)];
    const float x = float(i) / deviation;
    filters.edge.push_back(-x * weight);
    filters.point.push_back((x * x - 1.0f) * weight);
  }
  normalise_signs(filters.edge);
  normalise_signs(filters.point);
  for (const Weights* weights : {&filters.achromatic, &filters.red_green, &filters.blue_yellow1,
                                 &filters.blue_yellow2, &filters.smooth}) {
    filters.radius = std::max(filters.radius, int(weights->size() / 2));
  }
  return filters;
}

}  // namespace lockstep
