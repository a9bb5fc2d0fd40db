#include "experiments/metrics/yee.h"

#include "core/vector_clones.h"
#include "experiments/output/display_image.h"
#include "experiments/output/fast_power.h"

#include <tbb/parallel_for.h>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace lockstep {
namespace {

constexpr std::size_t kLevels = 8;
constexpr std::size_t kBands = kLevels - 2;
constexpr float kLeast = 1e-5f;     // keeps ratios of luminances finite
constexpr float kScotopic = 10.0f;  // cd/m^2, below which colours are not told apart
constexpr float kMostMasking = 10.0f;

// Adobe RGB (1998) with white D65: the primaries that perceptualdiff takes images to have.
inline glm::vec3 xyz_from_adobe(const glm::vec3& rgb) {
  return {0.576700f * rgb.x + 0.185556f * rgb.y + 0.188212f * rgb.z,
          0.297361f * rgb.x + 0.627355f * rgb.y + 0.0752847f * rgb.z,
          0.0270328f * rgb.x + 0.0706879f * rgb.y + 0.991248f * rgb.z};
}

inline float lab_curve(float share) {
  constexpr float knee = 216.0f / 24389.0f, slope = 24389.0f / 27.0f;
  const float root = fast_power(share, 1.0f / 3.0f);
  return share > knee ? root : (slope * share + 16.0f) / 116.0f;
}

// CIELAB's a and b, and Y, of what a display emits. perceptualdiff takes the bytes that it reads
// for red, green, blue, where its image library stores blue first. Its counts are what others
// report, so red and blue are exchanged here, too.
LOCKSTEP_VECTOR_CLONES
void see(const float* __restrict emitted, int count, const glm::vec3& white,
         float* __restrict luminance, float* __restrict ab) {
  const float white_x = white.x, white_y = white.y, white_z = white.z;
  for (int i = 0; i < count; ++i) {
    const glm::vec3 xyz =
        xyz_from_adobe(glm::vec3(emitted[3 * i + 2], emitted[3 * i + 1], emitted[3 * i]));
    const float y = lab_curve(xyz.y / white_y);
    luminance[i] = xyz.y;
    ab[2 * i] = 500.0f * (lab_curve(xyz.x / white_x) - y);
    ab[2 * i + 1] = 200.0f * (y - lab_curve(xyz.z / white_z));
  }
}

// What the display emits.
struct Display {
  Image luminance;  // cd/m^2
  Image ab;         // CIELAB's a and b
};

Display displayed(const Image& image, const YeeSettings& settings) {
  std::array<float, 256> emission;
  for (std::size_t code = 0; code < 256; ++code) {
    emission[code] = std::pow(float(code) / 255.0f, settings.gamma);
  }
  const glm::vec3 white = xyz_from_adobe(glm::vec3(1.0f, 1.0f, 1.0f));
  const std::size_t values = std::size_t(3 * image.width);
  Display display{Image(image.width, image.height, 1), Image(image.width, image.height, 2)};
  tbb::parallel_for(0, image.height, [&](int y) {
    std::vector<std::uint8_t> codes(values);
    std::vector<float> emitted(values);
    display_codes(image.at(0, y), int(values), codes.data());
    std::transform(codes.begin(), codes.end(), emitted.begin(),
                   [&](std::uint8_t code) { return emission[code]; });
    float* luminance = display.luminance.at(0, y);
    see(emitted.data(), image.width, white, luminance, display.ab.at(0, y));
    for (int x = 0; x < image.width; ++x) luminance[x] *= settings.luminance;
  });
  return display;
}

constexpr int kRadius = 2;
constexpr std::array<float, 5> kWeights = {0.05f, 0.25f, 0.4f, 0.25f, 0.05f};
constexpr int kSumBlock = 16;  // sums kept in registers

// Mirrored at the borders of n pixels, which the far one repeats.
int mirrored(int i, int n) {
  if (i < 0) i = -i;
  if (i >= n) i = 2 * n - 1 - i;
  return std::clamp(i, 0, n - 1);
}

// `count` sums over 5 x 5 pixels whose first columns begin at `rows`. Where areas are flat, all
// their pixels are at the threshold or none: the order of the additions is perceptualdiff's.
LOCKSTEP_VECTOR_CLONES
void blur(const std::array<const float*, 5>& rows, int count, float* sums) {
  float block[kSumBlock] = {};
  for (std::size_t i = 0; i < 5; ++i) {
    for (std::size_t j = 0; j < 5; ++j) {
      const float weight = kWeights[i] * kWeights[j];
      const float* from = rows[j] + i;
      for (int k = 0; k < kSumBlock; ++k) block[k] += weight * from[k];
    }
  }
  std::copy_n(block, count, sums);
}

// The image with mirrored columns to the left and right, whole blocks wide.
Image widened(const Image& image) {
  const int blocks = (image.width + kSumBlock - 1) / kSumBlock;
  Image wide(blocks * kSumBlock + 2 * kRadius, image.height, 1);
  tbb::parallel_for(0, image.height, [&](int y) {
    std::copy_n(image.at(0, y), image.width, wide.at(kRadius, y));
    for (int i = 1; i <= kRadius; ++i) {
      for (int x : {-i, image.width - 1 + i}) {
        *wide.at(x + kRadius, y) = *image.at(mirrored(x, image.width), y);
      }
    }
  });
  return wide;
}

Image blurred(const Image& image) {
  const Image wide = widened(image);
  Image result(image.width, image.height, 1);
  tbb::parallel_for(0, image.height, [&](int y) {
    for (int x = 0; x < image.width; x += kSumBlock) {
      std::array<const float*, 5> rows;
      for (int j = 0; j < 5; ++j) {
        rows[std::size_t(j)] = wide.at(x, mirrored(y + j - kRadius, image.height));
      }
      blur(rows, std::min(kSumBlock, image.width - x), result.at(x, y));
    }
  });
  return result;
}

using Pyramid = std::vector<Image>;

// The least visible difference of luminance at an adaptation luminance, in cd/m^2 (Ward Larson et
// al. 1997).
float threshold_versus_intensity(float adaptation) {
  const float a = std::log10(adaptation);
  float r = a - 1.255f;
  if (a < -3.94f) {
    r = -2.86f;
  } else if (a < -1.44f) {
    r = std::pow(0.405f * a + 1.6f, 2.18f) - 2.86f;
  } else if (a < -0.0184f) {
    r = a - 0.395f;
  } else if (a < 1.9f) {
    r = std::pow(0.249f * a + 0.65f, 2.7f) - 0.72f;
  }
  return std::pow(10.0f, r);
}

// Contrast sensitivity at a luminance in cd/m^2 over cycles per degree (Barten 1989). The products
// of very small and very large floats overflow where they do in perceptualdiff, and a sensitivity
// that is not a number lets the pixel pass there and here.
class Sensitivity {
 public:
  explicit Sensitivity(float luminance)
      : a_(440.0f * std::pow(1.0f + 0.7f / luminance, -0.2f)),
        b_(0.3f * std::pow(1.0f + 100.0f / luminance, 0.15f)) {}
  float operator()(float frequency) const {
    const float f = b_ * frequency;
    return a_ * frequency * std::exp(-f) * std::sqrt(1.0f + 0.06f * std::exp(f));
  }

 private:
  float a_, b_;
};

// How much a contrast, in multiples of the visible one, raises its own threshold (Daly 1993).
float masking(float contrast) {
  const float b = 0.0153f * std::pow(392.498f * contrast, 0.7f);
  return std::sqrt(std::sqrt(1.0f + b * b * b * b));
}

// What follows from the field of view alone.
struct Viewing {
  std::array<float, kBands> frequency;  // of the bands, in cycles per degree
  std::array<float, kBands> elevation;  // of the threshold for them
  std::size_t adaptation = 0;           // the level that averages over about a degree
};

Viewing viewing_of(float field_of_view, int width) {
  constexpr float pi = std::numbers::pi_v<float>;
  const float extent = 2.0f * std::tan(0.5f * field_of_view * pi / 180.0f) * 180.0f / pi;
  const Sensitivity sensitivity(100.0f);
  const float most = sensitivity(3.248f);
  Viewing viewing{};
  float frequency = 0.5f * float(width) / extent;
  for (std::size_t i = 0; i < kBands; ++i, frequency *= 0.5f) {
    viewing.frequency[i] = frequency;
    viewing.elevation[i] = most / sensitivity(frequency);
  }
  for (float pixels = 1.0f; pixels <= extent && viewing.adaptation + 1 < kLevels; pixels *= 2.0f) {
    ++viewing.adaptation;
  }
  return viewing;
}

// How far above the plain threshold a difference must be: masked contrasts of the bands, averaged
// with the contrasts as weights (Ramasubramanian et al. 1999).
float threshold_elevation(const Pyramid& p, const Pyramid& q, std::size_t pixel,
                          const Viewing& viewing, float adaptation) {
  const auto band = [&](const Pyramid& pyramid, std::size_t i) {
    return std::abs(pyramid[i].pixels[pixel] - pyramid[i + 1].pixels[pixel]);
  };
  const Sensitivity sensitivity(adaptation);
  float sum = 0.0f, contrasts = 0.0f;
  for (std::size_t i = 0; i < kBands; ++i) {
    const float around = std::max({p[i + 2].pixels[pixel], q[i + 2].pixels[pixel], kLeast});
    const float contrast = std::max(band(p, i), band(q, i)) / around;
    sum += contrast * viewing.elevation[i] * masking(contrast * sensitivity(viewing.frequency[i]));
    contrasts += contrast;
  }
  return std::clamp(sum / std::max(contrasts, kLeast), 1.0f, kMostMasking);
}

}  // namespace

YeeView yee_view(const Image& image, const YeeSettings& settings) {
  Display display = displayed(image, settings);
  YeeView view{{}, std::move(display.ab)};
  view.luminances.push_back(std::move(display.luminance));
  while (view.luminances.size() < kLevels) {
    view.luminances.push_back(blurred(view.luminances.back()));
  }
  return view;
}

YeeDifference yee_difference(const YeeView& p, const YeeView& q, const YeeSettings& settings) {
  const Pyramid &p_levels = p.luminances, &q_levels = q.luminances;
  const int width = p.ab.width, height = p.ab.height;
  const Viewing viewing = viewing_of(settings.field_of_view, width);
  const auto fails = [&](std::size_t pixel) {
    const std::size_t level = viewing.adaptation;
    const float adaptation =
        std::max(0.5f * (p_levels[level].pixels[pixel] + q_levels[level].pixels[pixel]), kLeast);
    const float difference = std::abs(p_levels[0].pixels[pixel] - q_levels[0].pixels[pixel]);
    const float threshold = threshold_versus_intensity(adaptation);
    float colour = 0.0f;
    if (!settings.luminance_only && adaptation >= kScotopic) {
      const float a = p.ab.pixels[2 * pixel] - q.ab.pixels[2 * pixel];
      const float b = p.ab.pixels[2 * pixel + 1] - q.ab.pixels[2 * pixel + 1];
      colour = settings.colour_factor * (a * a + b * b);
    }
    // The threshold is only ever elevated: most pixels need no more.
    if (difference <= threshold && colour <= 1.0f) return false;
    const float elevation = threshold_elevation(p_levels, q_levels, pixel, viewing, adaptation);
    return difference > elevation * threshold || colour > elevation;
  };
  YeeDifference result{0, Image(width, height, 1)};
  tbb::parallel_for(0, height, [&](int y) {
    for (int x = 0; x < width; ++x) {
      const std::size_t pixel = std::size_t(y) * std::size_t(width) + std::size_t(x);
      result.failing.pixels[pixel] = fails(pixel) ? 1.0f : 0.0f;
    }
  });
  for (float failing : result.failing.pixels) result.pixels += failing > 0.0f;
  return result;
}

YeeDifference yee_difference(const Image& reference, const Image& test,
                             const YeeSettings& settings) {
  return yee_difference(yee_view(reference, settings), yee_view(test, settings), settings);
}

}  // namespace lockstep
