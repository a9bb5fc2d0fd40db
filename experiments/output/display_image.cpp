#include "experiments/output/display_image.h"

#include "core/srgb.h"
#include "core/vector_clones.h"
#include "experiments/output/fast_power.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace lockstep {
namespace {

constexpr int kSteps = 16;
using ColourMap = std::array<std::array<float, 3>, kSteps + 1>;

// Display values of magma at equal distances; between them a straight line is within 1 %.
constexpr ColourMap kMagma = {{{0.001f, 0.000f, 0.014f},
                               {0.040f, 0.031f, 0.134f},
                               {0.113f, 0.065f, 0.277f},
                               {0.212f, 0.062f, 0.419f},
                               {0.317f, 0.072f, 0.485f},
                               {0.415f, 0.110f, 0.505f},
                               {0.513f, 0.148f, 0.508f},
                               {0.614f, 0.182f, 0.499f},
                               {0.716f, 0.215f, 0.475f},
                               {0.817f, 0.256f, 0.436f},
                               {0.904f, 0.320f, 0.388f},
                               {0.961f, 0.418f, 0.360f},
                               {0.987f, 0.536f, 0.382f},
                               {0.996f, 0.654f, 0.446f},
                               {0.997f, 0.770f, 0.535f},
                               {0.992f, 0.884f, 0.640f},
                               {0.987f, 0.991f, 0.750f}}};

// The same of viridis, within 2.5 %.
constexpr ColourMap kViridis = {{{0.267f, 0.005f, 0.329f},
                                 {0.282f, 0.095f, 0.417f},
                                 {0.279f, 0.175f, 0.483f},
                                 {0.259f, 0.251f, 0.524f},
                                 {0.230f, 0.321f, 0.545f},
                                 {0.200f, 0.386f, 0.555f},
                                 {0.173f, 0.447f, 0.558f},
                                 {0.150f, 0.506f, 0.557f},
                                 {0.128f, 0.565f, 0.551f},
                                 {0.120f, 0.624f, 0.534f},
                                 {0.155f, 0.682f, 0.503f},
                                 {0.241f, 0.737f, 0.455f},
                                 {0.363f, 0.787f, 0.387f},
                                 {0.508f, 0.829f, 0.299f},
                                 {0.669f, 0.862f, 0.195f},
                                 {0.836f, 0.886f, 0.102f},
                                 {0.993f, 0.906f, 0.144f}}};

// The sRGB value of what a display can show of a linear value, to 2e-6.
inline float shown(float linear) {
  const float value = std::min(std::max(linear, 0.0f), 1.0f);
  const float curve = 1.055f * fast_power(value, 1.0f / 2.4f) - 0.055f;
  return value <= 0.0031308f ? 12.92f * value : curve;
}

LOCKSTEP_VECTOR_CLONES
void codes_of(const float* __restrict linear, int count, std::uint8_t* __restrict codes) {
  for (int i = 0; i < count; ++i) codes[i] = std::uint8_t(int(255.0f * shown(linear[i]) + 0.5f));
}

LOCKSTEP_VECTOR_CLONES
void luma_of(const float* __restrict rgb, int count, float* __restrict luma) {
  for (int i = 0; i < count; ++i) {
    luma[i] = 0.2126f * shown(rgb[3 * i]) + 0.7152f * shown(rgb[3 * i + 1]) +
              0.0722f * shown(rgb[3 * i + 2]);
  }
}

Image coloured(const Image& map, const ColourMap& colour_map) {
  Image colours(map.width, map.height, 3);
  for (std::size_t i = 0; i < map.pixels.size(); ++i) {
    const float place = std::clamp(map.pixels[i], 0.0f, 1.0f) * kSteps;
    const int step = std::min(int(place), kSteps - 1);
    const auto& from = colour_map[std::size_t(step)];
    const auto& to = colour_map[std::size_t(step) + 1];
    for (std::size_t c = 0; c < 3; ++c) {
      const float value = from[c] + (place - float(step)) * (to[c] - from[c]);
      colours.pixels[3 * i + c] = linear_from_srgb(value);
    }
  }
  return colours;
}

}  // namespace

void display_codes(const float* linear, int count, std::uint8_t* codes) {
  codes_of(linear, count, codes);
}

Image display_luma(const Image& image) {
  Image luma(image.width, image.height, 1);
  tbb::parallel_for(0, image.height,
                    [&](int y) { luma_of(image.at(0, y), image.width, luma.at(0, y)); });
  return luma;
}

Image magma(const Image& map) { return coloured(map, kMagma); }

Image viridis(const Image& map) { return coloured(map, kViridis); }

}  // namespace lockstep
