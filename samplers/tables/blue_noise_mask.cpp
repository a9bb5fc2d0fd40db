#include "samplers/blue_noise_mask.h"
#include "samplers/tables/tables.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

namespace lockstep {
namespace {

constexpr int side = blue_noise_side;
constexpr int cells = side * side;

// Ones on a torus, and how close to others each cell is: a sum of Gaussians around the ones.
class Pattern {
 public:
  Pattern() {
    constexpr double sigma = 1.5;
    for (int y = 0; y < side; ++y) {
      for (int x = 0; x < side; ++x) {
        const int dx = std::min(x, side - x), dy = std::min(y, side - y);
        gaussian_[std::size_t(y * side + x)] =
            float(std::exp(-(dx * dx + dy * dy) / (2.0 * sigma * sigma)));
      }
    }
  }

  bool one(int cell) const { return ones_[std::size_t(cell)]; }

  void set(int cell, bool value) {
    ones_[std::size_t(cell)] = value;
    const float sign = value ? 1.0f : -1.0f;
    const int cx = cell % side, cy = cell / side;
    for (int y = 0; y < side; ++y) {
      const float* row = &gaussian_[std::size_t(((y - cy) & (side - 1)) * side)];
      float* energy = &energy_[std::size_t(y * side)];
      for (int x = 0; x < side; ++x) energy[x] += sign * row[(x - cx) & (side - 1)];
    }
  }

  // The one with the most ones around it, or the zero with the fewest.
  int extreme(bool ones) const {
    int best = -1;
    for (int cell = 0; cell < cells; ++cell) {
      if (one(cell) != ones) continue;
      const float e = energy_[std::size_t(cell)];
      if (best < 0 || (ones ? e > energy_[std::size_t(best)] : e < energy_[std::size_t(best)])) {
        best = cell;
      }
    }
    return best;
  }

 private:
  std::array<float, cells> gaussian_{}, energy_{};
  std::array<bool, cells> ones_{};
};

// A tenth of the cells, spread by moving the tightest cluster into the largest void until that is
// where it came from.
Pattern first_pattern() {
  Pattern p;
  std::mt19937 random(1);
  for (int n = 0; n < cells / 10;) {
    const int cell = int(random() % cells);
    if (p.one(cell)) continue;
    p.set(cell, true);
    ++n;
  }
  while (true) {
    const int cluster = p.extreme(true);
    p.set(cluster, false);
    const int empty = p.extreme(false);
    p.set(empty, true);
    if (empty == cluster) return p;
  }
}

}  // namespace

std::vector<std::uint32_t> make_blue_noise_mask() {
  std::vector<std::uint32_t> ranks(cells);
  const Pattern first = first_pattern();
  Pattern p = first;
  // Downwards from the first pattern, then upwards from it.
  for (int rank = cells / 10 - 1; rank >= 0; --rank) {
    const int cell = p.extreme(true);
    p.set(cell, false);
    ranks[std::size_t(cell)] = std::uint32_t(rank);
  }
  p = first;
  for (int rank = cells / 10; rank < cells; ++rank) {
    const int cell = p.extreme(false);
    p.set(cell, true);
    ranks[std::size_t(cell)] = std::uint32_t(rank);
  }
  return ranks;
}

}  // namespace lockstep
