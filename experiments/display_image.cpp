#include "experiments/display_image.h"

#include "core/srgb.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace lockstep {
namespace {

// Display values of magma at equal distances; between them a straight line is within 1 %.
constexpr int kMagmaSteps = 16;
constexpr std::array<std::array<float, 3>, kMagmaSteps + 1> kMagma = {{{0.001f, 0.000f, 0.014f},
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

}  // namespace

std::uint8_t display_code(float linear) {
  return std::uint8_t(255.0f * srgb_from_linear(std::clamp(linear, 0.0f, 1.0f)) + 0.5f);
}

Image display_luma(const Image& image) {
  Image luma(image.width, image.height, 1);
  tbb::parallel_for(0, image.height, [&](int y) {
    const float* pixel = image.at(0, y);
    for (int x = 0; x < image.width; ++x, pixel += image.channels) {
      const auto shown = [&](int c) { return srgb_from_linear(std::clamp(pixel[c], 0.0f, 1.0f)); };
      *luma.at(x, y) = 0.2126f * shown(0) + 0.7152f * shown(1) + 0.0722f * shown(2);
    }
  });
  return luma;
}

Image magma(const Image& map) {
  Image colours(map.width, map.height, 3);
  for (std::size_t i = 0; i < map.pixels.size(); ++i) {
    const float place = std::clamp(map.pixels[i], 0.0f, 1.0f) * kMagmaSteps;
    const int step = std::min(int(place), kMagmaSteps - 1);
    const auto& from = kMagma[std::size_t(step)];
    const auto& to = kMagma[std::size_t(step) + 1];
    for (std::size_t c = 0; c < 3; ++c) {
      const float shown = from[c] + (place - float(step)) * (to[c] - from[c]);
      colours.pixels[3 * i + c] = linear_from_srgb(shown);
    }
  }
  return colours;
}

}  // namespace lockstep
