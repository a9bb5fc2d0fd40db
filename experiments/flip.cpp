#include "experiments/flip.h"

#include "experiments/separable_filter.h"

#include <tbb/parallel_for.h>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace lockstep {
namespace {

// Andersson et al. 2020, section 4.
constexpr float kColourExponent = 0.7f;    // q_c
constexpr float kTurningPoint = 0.4f;      // p_c, as a share of the largest distance
constexpr float kTurningValue = 0.95f;     // p_t
constexpr float kFeatureDegrees = 0.082f;  // w, the width of edges that are detected

constexpr float kLabKnee = 6.0f / 29.0f;

// Columns are the XYZ values of the primaries of Rec. 709 with white D65.
const glm::dmat3 kXyzFromRgb(10135552.0 / 24577794.0, 2613072.0 / 12288897.0,
                             1425312.0 / 73733382.0, 8788810.0 / 24577794.0, 8788810.0 / 12288897.0,
                             8788810.0 / 73733382.0, 4435075.0 / 24577794.0, 887015.0 / 12288897.0,
                             70074185.0 / 73733382.0);

// XYZ as shares of white's.
glm::dmat3 shares_of_white() {
  const glm::dvec3 white = kXyzFromRgb * glm::dvec3(1.0, 1.0, 1.0);
  glm::dmat3 result = kXyzFromRgb;
  for (int column = 0; column < 3; ++column) result[column] /= white;
  return result;
}
const glm::mat3 kXyzShareFromRgb(shares_of_white());
const glm::mat3 kRgbFromXyzShare(glm::inverse(shares_of_white()));

// The opponent space YCxCz, linear in XYZ, without its factors and offset:
// they would be taken back after filtering. Y is in [0, 1]; one channel each.
struct Opponent {
  Image y, cx, cz;
};

Opponent opponent_of(const Image& image) {
  const auto plane = [&] { return Image(image.width, image.height, 1); };
  Opponent result{plane(), plane(), plane()};
  tbb::parallel_for(0, image.height, [&](int row) {
    float *to_y = result.y.at(0, row), *to_cx = result.cx.at(0, row), *to_cz = result.cz.at(0, row);
    for (int x = 0; x < image.width; ++x) {
      const float* rgb = image.at(x, row);
      const glm::vec3 share = kXyzShareFromRgb * glm::vec3(rgb[0], rgb[1], rgb[2]);
      to_y[x] = share.y;
      to_cx[x] = share.x - share.y;
      to_cz[x] = share.y - share.z;
    }
  });
  return result;
}

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

std::vector<float> weights_of(const SensitivityFilter& filter, float pixels_per_degree) {
  constexpr float pi = std::numbers::pi_v<float>;
  const float deviation = std::sqrt(kWidestFilter / (2.0f * pi * pi));
  const int radius = int(std::ceil(3.0f * deviation * pixels_per_degree));
  const float height = filter.a * std::sqrt(pi / filter.b);
  std::vector<float> weights;
  for (int i = -radius; i <= radius; ++i) {
    const float x = float(i) / pixels_per_degree;
    weights.push_back((filter.root ? std::sqrt(height) : height) *
                      std::exp(-pi * pi * x * x / filter.b));
  }
  return weights;
}

float sum_of(const std::vector<float>& weights) {
  float sum = 0.0f;
  for (float weight : weights) sum += weight;
  return sum;
}

void scale(std::vector<float>& weights, float factor) {
  for (float& weight : weights) weight *= factor;
}

// Filters one channel in both directions with weights scaled to a sum of one.
Image seen(const Image& channel, const SensitivityFilter& filter, float pixels_per_degree) {
  std::vector<float> weights = weights_of(filter, pixels_per_degree);
  scale(weights, 1.0f / sum_of(weights));
  return separable_filter(channel, weights, weights);
}

// Blue-yellow is seen through a sum of two Gaussians, each of which is separable.
Image seen_blue_yellow(const Image& channel, float pixels_per_degree) {
  std::vector<float> first = weights_of(kBlueYellow1, pixels_per_degree);
  std::vector<float> second = weights_of(kBlueYellow2, pixels_per_degree);
  const float factor = 1.0f / std::hypot(sum_of(first), sum_of(second));
  scale(first, factor);
  scale(second, factor);
  Image sum = separable_filter(channel, first, first);
  const Image other = separable_filter(channel, second, second);
  for (std::size_t i = 0; i < sum.pixels.size(); ++i) sum.pixels[i] += other.pixels[i];
  return sum;
}

Opponent seen(const Opponent& image, float pixels_per_degree) {
  return {seen(image.y, kAchromatic, pixels_per_degree),
          seen(image.cx, kRedGreen, pixels_per_degree),
          seen_blue_yellow(image.cz, pixels_per_degree)};
}

float lab_curve(float share) {
  return share > kLabKnee * kLabKnee * kLabKnee
             ? std::pow(share, 1.0f / 3.0f)
             : share / (3.0f * kLabKnee * kLabKnee) + 4.0f / 29.0f;
}

// CIELAB with chroma that grows with lightness: the Hunt effect.
glm::vec3 hunt_lab(const glm::vec3& rgb) {
  const glm::vec3 share = kXyzShareFromRgb * rgb;
  const float x = lab_curve(share.x), y = lab_curve(share.y), z = lab_curve(share.z);
  const float lightness = 116.0f * y - 16.0f;
  const float hunt = 0.01f * lightness;
  return {lightness, hunt * 500.0f * (x - y), hunt * 200.0f * (y - z)};
}

glm::vec3 hunt_lab(float y, float cx, float cz) {
  const glm::vec3 rgb = kRgbFromXyzShare * glm::vec3(y + cx, y, y - cz);
  return hunt_lab(glm::vec3(std::clamp(rgb.x, 0.0f, 1.0f), std::clamp(rgb.y, 0.0f, 1.0f),
                            std::clamp(rgb.z, 0.0f, 1.0f)));
}

// HyAB distance (Abasi et al. 2019), compressed.
float colour_distance(const glm::vec3& p, const glm::vec3& q) {
  const glm::vec3 d = p - q;
  return std::pow(std::abs(d.x) + std::sqrt(d.y * d.y + d.z * d.z), kColourExponent);
}

// To [0, 1] in two straight pieces, so that large distances take little of the range.
float redistributed(float distance, float largest) {
  const float turn = kTurningPoint * largest;
  if (distance < turn) return kTurningValue / turn * distance;
  return kTurningValue + (distance - turn) / (largest - turn) * (1.0f - kTurningValue);
}

Image colour_difference(const Opponent& p, const Opponent& q) {
  const float largest =
      colour_distance(hunt_lab(glm::vec3(0.0f, 1.0f, 0.0f)), hunt_lab(glm::vec3(0.0f, 0.0f, 1.0f)));
  Image result(p.y.width, p.y.height, 1);
  tbb::parallel_for(0, result.height, [&](int row) {
    for (int x = 0; x < result.width; ++x) {
      const auto lab = [&](const Opponent& image) {
        return hunt_lab(*image.y.at(x, row), *image.cx.at(x, row), *image.cz.at(x, row));
      };
      *result.at(x, row) = redistributed(colour_distance(lab(p), lab(q)), largest);
    }
  });
  return result;
}

// A Gaussian and its first two derivatives, without factors.
struct FeatureFilters {
  std::vector<float> smooth, edge, point;
};

// Positive weights sum to one, negative ones to minus one.
void normalise_signs(std::vector<float>& weights) {
  float positive = 0.0f, negative = 0.0f;
  for (float weight : weights) (weight > 0.0f ? positive : negative) += std::abs(weight);
  for (float& weight : weights) {
    if (weight != 0.0f) weight /= weight > 0.0f ? positive : negative;
  }
}

FeatureFilters feature_filters(float pixels_per_degree) {
  const float deviation = 0.5f * kFeatureDegrees * pixels_per_degree;
  const int radius = int(std::ceil(3.0f * deviation));
  FeatureFilters filters{gaussian_weights(deviation, radius), {}, {}};
  for (int i = -radius; i <= radius; ++i) {
    const float weight = filters.smooth[std::size_t(i + radius)];
    const float x = float(i) / deviation;
    filters.edge.push_back(-x * weight);
    filters.point.push_back((x * x - 1.0f) * weight);
  }
  normalise_signs(filters.edge);
  normalise_signs(filters.point);
  return filters;
}

// The length of the vector of a derivative's horizontal and vertical response.
Image feature_strength(const Image& luminance, const std::vector<float>& derivative,
                       const std::vector<float>& smooth) {
  Image result = separable_filter(luminance, derivative, smooth);
  const Image down = separable_filter(luminance, smooth, derivative);
  tbb::parallel_for(0, result.height, [&](int row) {
    float* across = result.at(0, row);
    for (int x = 0; x < result.width; ++x) {
      const float other = *down.at(x, row);
      across[x] = std::sqrt(across[x] * across[x] + other * other);
    }
  });
  return result;
}

struct Features {
  Image edges, points;
};

Features features_of(const Image& luminance, const FeatureFilters& filters) {
  return {feature_strength(luminance, filters.edge, filters.smooth),
          feature_strength(luminance, filters.point, filters.smooth)};
}

// Raises the colour difference to one minus the feature difference, whose exponent is q_f = 1/2.
void amplify(Image& colour, const Features& p, const Features& q) {
  tbb::parallel_for(0, colour.height, [&](int row) {
    float* value = colour.at(0, row);
    for (int x = 0; x < colour.width; ++x) {
      const float edge = std::abs(*p.edges.at(x, row) - *q.edges.at(x, row));
      const float point = std::abs(*p.points.at(x, row) - *q.points.at(x, row));
      const float feature = std::sqrt(std::max(edge, point) / std::numbers::sqrt2_v<float>);
      value[x] = std::pow(value[x], 1.0f - feature);
    }
  });
}

// FLIP of two images in [0, 1].
Image flip_of(const Image& reference, const Image& test, float pixels_per_degree) {
  const Opponent p = opponent_of(reference), q = opponent_of(test);
  Image map = colour_difference(seen(p, pixels_per_degree), seen(q, pixels_per_degree));
  const FeatureFilters filters = feature_filters(pixels_per_degree);
  amplify(map, features_of(p.y, filters), features_of(q.y, filters));
  return map;
}

// A value of `image` each, in parallel.
template <typename Function>
Image mapped(const Image& image, Function function) {
  Image result(image.width, image.height, image.channels);
  tbb::parallel_for(0, image.height, [&](int row) {
    const float* from = image.at(0, row);
    std::transform(from, from + image.width * image.channels, result.at(0, row), function);
  });
  return result;
}

// Narkowicz's fit of the ACES curve with its exposure of 0.6: n(x) / d(x).
constexpr float kAcesN[] = {0.6f * 0.6f * 2.51f, 0.6f * 0.03f, 0.0f};
constexpr float kAcesD[] = {0.6f * 0.6f * 2.43f, 0.6f * 0.59f, 0.14f};
constexpr float kJustBelowWhite = 0.85f;
constexpr float kLargest = 1e9f;  // its square is finite

float aces(float x) {
  x = std::min(x, kLargest);
  const float y = (kAcesN[0] * x * x + kAcesN[1] * x + kAcesN[2]) /
                  (kAcesD[0] * x * x + kAcesD[1] * x + kAcesD[2]);
  return std::clamp(y, 0.0f, 1.0f);
}

// The larger solution of aces(x) = kJustBelowWhite.
float radiance_below_white() {
  const float a = kAcesN[0] - kJustBelowWhite * kAcesD[0];
  const float b = kAcesN[1] - kJustBelowWhite * kAcesD[1];
  const float c = kAcesN[2] - kJustBelowWhite * kAcesD[2];
  const float middle = -0.5f * b / a;
  return middle + std::sqrt(middle * middle - c / a);
}

float median(std::vector<float>& values) {
  const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

Image flip_ldr_map(const Image& reference, const Image& test, float pixels_per_degree) {
  const auto clamped = [](float value) { return std::clamp(value, 0.0f, 1.0f); };
  return flip_of(mapped(reference, clamped), mapped(test, clamped), pixels_per_degree);
}

Exposures flip_exposures(const Image& reference) {
  std::vector<float> luminances;
  for (std::size_t i = 0; i + 3 <= reference.pixels.size(); i += 3) {
    const float* rgb = &reference.pixels[i];
    luminances.push_back(0.2126f * rgb[0] + 0.7152f * rgb[1] + 0.0722f * rgb[2]);
  }
  if (luminances.empty()) return {};
  const float brightest = *std::max_element(luminances.begin(), luminances.end());
  if (brightest <= 0.0f) return {};
  float middle = median(luminances);
  if (middle <= 0.0f) {
    std::erase_if(luminances, [](float luminance) { return luminance <= 0.0f; });
    middle = median(luminances);
  }
  const float shown = radiance_below_white();
  Exposures exposures{std::log2(shown / brightest), std::log2(shown / middle), 2};
  exposures.count = std::max(2, int(std::ceil(exposures.stop - exposures.start)));
  return exposures;
}

Image flip_hdr_map(const Image& reference, const Image& test, float pixels_per_degree) {
  const Exposures exposures = flip_exposures(reference);
  const float step = (exposures.stop - exposures.start) / float(exposures.count - 1);
  Image largest(reference.width, reference.height, 1);
  for (int i = 0; i < exposures.count; ++i) {
    const float gain = std::exp2(exposures.start + float(i) * step);
    const auto shown = [gain](float value) { return aces(gain * value); };
    const Image map = flip_of(mapped(reference, shown), mapped(test, shown), pixels_per_degree);
    for (std::size_t p = 0; p < map.pixels.size(); ++p) {
      largest.pixels[p] = std::max(largest.pixels[p], map.pixels[p]);
    }
  }
  return largest;
}

double mean_of(const Image& map) {
  double sum = 0.0;
  for (float value : map.pixels) sum += value;
  return map.pixels.empty() ? 0.0 : sum / double(map.pixels.size());
}

}  // namespace lockstep
