#include "experiments/metrics/flip.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace lockstep {
namespace {

float median(std::vector<float>& values) {
  const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// The images as they are, then one for each exposure.
std::vector<FlipDisplay> displays_for(const Image& reference) {
  const Exposures exposures = flip_exposures(reference);
  const float step = (exposures.stop - exposures.start) / float(exposures.count - 1);
  std::vector<FlipDisplay> displays(1);
  for (int i = 0; i < exposures.count; ++i) {
    displays.push_back({true, std::exp2(exposures.start + float(i) * step)});
  }
  return displays;
}

}  // namespace

Exposures flip_exposures(const Image& reference) {
  std::vector<float> luminances;
  luminances.reserve(reference.pixels.size() / 3);
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

FlipReference::FlipReference(const Image& reference, float pixels_per_degree,
                             std::size_t most_bytes)
    : reference_(&reference),
      filters_(flip_filters(pixels_per_degree)),
      tiles_(flip_tiles(reference)),
      displays_(displays_for(reference)) {
  const std::size_t bytes = 5 * sizeof(float) * kFlipTileWidth * kFlipTileHeight * tiles_.size();
  const std::size_t count =
      std::min(displays_.size(), most_bytes / std::max<std::size_t>(bytes, 1));
  for (std::size_t i = 0; i < count; ++i) kept_.emplace_back(tiles_.size());
  tbb::parallel_for(std::size_t(0), count > 0 ? tiles_.size() : 0, [&](std::size_t tile) {
    FlipScratch scratch;
    for (std::size_t i = 0; i < count; ++i) {
      see_tile(reference, tiles_[tile], displays_[i], filters_, scratch, kept_[i][tile]);
    }
  });
}

const FlipSide& FlipReference::side(std::size_t display, std::size_t tile, FlipScratch& scratch,
                                    FlipSide& made) const {
  if (display < kept_.size()) return kept_[display][tile];
  see_tile(*reference_, tiles_[tile], displays_[display], filters_, scratch, made);
  return made;
}

Image FlipReference::ldr_map(const Image& test) const {
  Image map(test.width, test.height, 1);
  tbb::parallel_for(std::size_t(0), tiles_.size(), [&](std::size_t index) {
    const FlipTile& tile = tiles_[index];
    FlipScratch scratch;
    FlipSide ours, made;
    see_tile(test, tile, displays_[0], filters_, scratch, ours);
    const FlipSide& reference = side(0, index, scratch, made);
    for (int row = 0; row < tile.height; ++row) {
      flip_errors(reference, ours, tile, row, map.at(tile.x, tile.y + row));
    }
  });
  return map;
}

HdrFlip FlipReference::hdr_map(const Image& test) const {
  HdrFlip result{Image(test.width, test.height, 1), Image(test.width, test.height, 1)};
  const std::size_t last = displays_.size() - 1;
  tbb::parallel_for(std::size_t(0), tiles_.size(), [&](std::size_t index) {
    const FlipTile& tile = tiles_[index];
    FlipScratch scratch;
    FlipSide ours, made;
    float errors[kFlipTileWidth];
    for (std::size_t i = 1; i <= last; ++i) {
      see_tile(test, tile, displays_[i], filters_, scratch, ours);
      const FlipSide& reference = side(i, index, scratch, made);
      const float place = float(i - 1) / float(last - 1);
      for (int row = 0; row < tile.height; ++row) {
        flip_errors(reference, ours, tile, row, errors);
        float* largest = result.map.at(tile.x, tile.y + row);
        float* exposure = result.exposure.at(tile.x, tile.y + row);
        for (int x = 0; x < tile.width; ++x) {
          exposure[x] = errors[x] > largest[x] ? place : exposure[x];
          largest[x] = std::max(errors[x], largest[x]);
        }
      }
    }
  });
  return result;
}

Image flip_ldr_map(const Image& reference, const Image& test, float pixels_per_degree) {
  return FlipReference(reference, pixels_per_degree, 0).ldr_map(test);
}

Image flip_hdr_map(const Image& reference, const Image& test, float pixels_per_degree) {
  return FlipReference(reference, pixels_per_degree, 0).hdr_map(test).map;
}

double mean_of_map(const Image& map) {
  double sum = 0.0;
  for (float value : map.pixels) sum += value;
  return map.pixels.empty() ? 0.0 : sum / double(map.pixels.size());
}

}  // namespace lockstep
