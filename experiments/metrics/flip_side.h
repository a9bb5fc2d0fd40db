// FLIP's view of one image, tile by tile: what of its colours and features is seen (Andersson et
// al. 2020, section 4). Two views make an error.
#pragma once

#include "core/image.h"

#include <vector>

namespace lockstep {

// How an image is shown before it is judged: clamped to [0, 1], or multiplied by `gain` and
// tone-mapped with the ACES curve.
struct FlipDisplay {
  bool tone_mapped = false;
  float gain = 1.0f;
};

// The larger radiance x whose ACES value is just below white, 0.85.
float radiance_below_white();

// What of a separable filter is applied in one direction, and the rows of weights that FLIP uses.
struct FlipFilters {
  using Weights = std::vector<float>;
  Weights achromatic, red_green, blue_yellow1, blue_yellow2;  // contrast sensitivity (table 1)
  Weights smooth, edge, point;  // a Gaussian and its first two derivatives (section 4.2)
  int radius = 0;               // of the widest
};
FlipFilters flip_filters(float pixels_per_degree);

constexpr int kFlipTileWidth = 128;
constexpr int kFlipTileHeight = 64;

// Part of an image, at most of the size above; only its last row and column may be smaller.
struct FlipTile {
  int x = 0, y = 0, width = 0, height = 0;
};
std::vector<FlipTile> flip_tiles(const Image& image);

// What is seen of a tile, in rows of kFlipTileWidth values.
struct FlipSide {
  std::vector<float> lightness, a, b;  // Hunt-adjusted CIELAB
  std::vector<float> edges, points;    // strength of features
};

// Memory for one tile at a time, used again from tile to tile.
struct FlipScratch {
  std::vector<float> rgb, y, cx, cz;
  std::vector<float> across[7];
};

void see_tile(const Image& image, const FlipTile& tile, const FlipDisplay& display,
              const FlipFilters& filters, FlipScratch& scratch, FlipSide& side);

// FLIP of a row of `tile`, `row` from its top.
void flip_errors(const FlipSide& p, const FlipSide& q, const FlipTile& tile, int row,
                 float* errors);

}  // namespace lockstep
