#include "experiments/metrics/block_error.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace lockstep {
namespace {

constexpr double kDarkestBlock = 0.01;  // of the mean: keeps errors of black blocks finite

double luminance(const float* rgb) {
  return 0.2126 * double(rgb[0]) + 0.7152 * double(rgb[1]) + 0.0722 * double(rgb[2]);
}

struct Block {
  double sum = 0.0;
  double pixels = 0.0;
};

// Row by row.
std::vector<Block> blocks_of(const Image& image) {
  const int columns = (image.width + kErrorBlock - 1) / kErrorBlock;
  const int rows = (image.height + kErrorBlock - 1) / kErrorBlock;
  std::vector<Block> blocks(std::size_t(columns) * std::size_t(rows));
  for (int y = 0; y < image.height; ++y) {
    Block* row = &blocks[std::size_t(y / kErrorBlock) * std::size_t(columns)];
    for (int x = 0; x < image.width; ++x) {
      row[x / kErrorBlock].sum += luminance(image.at(x, y));
      row[x / kErrorBlock].pixels += 1.0;
    }
  }
  return blocks;
}

double mean_of(const std::vector<Block>& blocks) {
  Block all;
  for (const Block& block : blocks) {
    all.sum += block.sum;
    all.pixels += block.pixels;
  }
  return all.sum / std::max(all.pixels, 1.0);
}

}  // namespace

double block_relative_rmse(const Image& reference, const Image& test) {
  const std::vector<Block> expected = blocks_of(reference), found = blocks_of(test);
  const double least = kDarkestBlock * mean_of(expected);
  double sum = 0.0, pixels = 0.0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const double b = expected[i].sum / expected[i].pixels;
    const double a = found[i].sum / found[i].pixels;
    const double error = a == b ? 0.0 : (a - b) / (b + least);
    sum += expected[i].pixels * error * error;
    pixels += expected[i].pixels;
  }
  return std::sqrt(sum / std::max(pixels, 1.0));
}

double luminance_ratio(const Image& reference, const Image& test) {
  return mean_of(blocks_of(test)) / mean_of(blocks_of(reference));
}

}  // namespace lockstep
