#include "samplers/pmj02_table.h"
#include "samplers/tables/tables.h"

#include <algorithm>
#include <bit>
#include <random>
#include <stdexcept>
#include <vector>

namespace lockstep {
namespace {

// Builds one table by doubling: points [n, 2n) go where, together with the first n, they leave one
// point in every elementary interval of area 1 / 2n.
class Builder {
 public:
  Builder(std::uint32_t seed, std::uint32_t* points) : random_(seed), points_(points) {
    points_[0] = std::uint32_t(random_()), points_[1] = std::uint32_t(random_());
    for (int k = 0; (1u << 2 * k) < pmj02_points; ++k) extend(k);
  }

 private:
  // From 4^k points, one in every square of side 2^-k, to 4^(k + 1), one in every quarter of them.
  void extend(int k) {
    const std::uint32_t n = 1u << 2 * k;
    std::vector<std::uint32_t> beside(
        n);  // of a square: which neighbour of its first point is next
    for (std::uint32_t& b : beside) b = std::uint32_t(random_()) & 1u;
    begin(2 * k + 1, n);
    for (std::uint32_t i = 0; i < n; ++i) place(n + i, i, k, 1, 1);
    begin(2 * k + 2, 2 * n);
    for (std::uint32_t i = 0; i < n; ++i) place(2 * n + i, i, k, beside[i], 1 - beside[i]);
    for (std::uint32_t i = 0; i < n; ++i) place(3 * n + i, i, k, 1 - beside[i], beside[i]);
  }

  // Intervals of area 2^-bits, of which the first `count` points take theirs.
  void begin(int bits, std::uint32_t count) {
    bits_ = bits;
    taken_.assign(std::size_t(bits + 1) << bits, 0);
    for (std::uint32_t i = 0; i < count; ++i) {
      mark(points_[2 * i] >> (32 - bits), points_[2 * i + 1] >> (32 - bits));
    }
  }

  // Of the interval 2^-a wide and 2^(a - bits) high around strips x and y.
  std::size_t interval(int a, std::uint32_t x, std::uint32_t y) const {
    return (std::size_t(a) << bits_) | (std::size_t(x >> (bits_ - a)) << (bits_ - a)) | y >> a;
  }
  void mark(std::uint32_t x, std::uint32_t y) {
    for (int a = 0; a <= bits_; ++a) taken_[interval(a, x, y)] = 1;
  }
  bool is_free(std::uint32_t x, std::uint32_t y) const {
    for (int a = 0; a <= bits_; ++a) {
      if (taken_[interval(a, x, y)]) return false;
    }
    return true;
  }

  // Point `to` goes into the quarter that lies dx, dy from that of point `from` in its square.
  void place(std::uint32_t to, std::uint32_t from, int k, std::uint32_t dx, std::uint32_t dy) {
    const int quarter_bits = k + 1, inner = bits_ - quarter_bits;
    const std::uint32_t x0 = ((points_[2 * from] >> (32 - quarter_bits)) ^ dx) << inner;
    const std::uint32_t y0 = ((points_[2 * from + 1] >> (32 - quarter_bits)) ^ dy) << inner;
    std::vector<std::uint32_t> xs, ys;  // strips without a point
    for (std::uint32_t i = 0; i < 1u << inner; ++i) {
      if (!taken_[interval(bits_, x0 + i, y0)]) xs.push_back(x0 + i);
      if (!taken_[interval(0, x0, y0 + i)]) ys.push_back(y0 + i);
    }
    std::shuffle(xs.begin(), xs.end(), random_);
    std::shuffle(ys.begin(), ys.end(), random_);
    for (const std::uint32_t x : xs) {
      for (const std::uint32_t y : ys) {
        if (!is_free(x, y)) continue;
        mark(x, y);
        points_[2 * to] = x << (32 - bits_) | std::uint32_t(random_()) >> bits_;
        points_[2 * to + 1] = y << (32 - bits_) | std::uint32_t(random_()) >> bits_;
        return;
      }
    }
    throw std::logic_error("pmj02: no elementary interval is left for a point");
  }

  std::mt19937 random_;
  std::uint32_t* points_;
  int bits_ = 0;
  std::vector<char> taken_;
};

}  // namespace

std::vector<std::uint32_t> make_pmj02_table() {
  std::vector<std::uint32_t> points(2 * pmj02_tables * pmj02_points);
  for (std::uint32_t t = 0; t < pmj02_tables; ++t) {
    Builder(t + 1, points.data() + 2 * t * pmj02_points);
  }
  return points;
}

}  // namespace lockstep
