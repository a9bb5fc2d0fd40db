#include "tests/chi_square.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

namespace lockstep {
namespace {

constexpr double min_expected = 5.0;  // per pooled cell: the usual limit of the approximation
constexpr double pi = std::numbers::pi;

// P(a, x) by its power series; converges quickly for x < a + 1.
double lower_gamma_series(double a, double x) {
  double term = 1.0 / a, sum = term;
  for (int n = 1; n < 100000 && term > sum * 1e-16; ++n) {
    term *= x / (a + n);
    sum += term;
  }
  return sum * std::exp(a * std::log(x) - x - std::lgamma(a));
}

// Q(a, x) by its continued fraction, evaluated forwards (Lentz 1976), for x >= a + 1.
double upper_gamma_fraction(double a, double x) {
  double b = x + 1.0 - a, c = 1e300, d = 1.0 / b, value = d;
  for (int n = 1; n < 100000; ++n) {
    const double numerator = -n * (n - a);
    b += 2.0;
    d = 1.0 / (numerator * d + b);
    c = b + numerator / c;
    value *= c * d;
    if (std::abs(c * d - 1.0) < 1e-15) break;
  }
  return value * std::exp(a * std::log(x) - x - std::lgamma(a));
}

// Three-point Gauss-Legendre along both axes.
double gauss(const SquareDensity& density, glm::dvec2 lo, glm::dvec2 hi) {
  constexpr double nodes[3] = {0.1127016653792583, 0.5, 0.8872983346207417};
  constexpr double weights[3] = {5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};
  const glm::dvec2 size = hi - lo;
  double sum = 0.0;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      sum += weights[i] * weights[j] * density(lo + size * glm::dvec2(nodes[i], nodes[j]));
    }
  }
  return sum * size.x * size.y;
}

double refine(const SquareDensity& density, glm::dvec2 lo, glm::dvec2 hi, double whole,
              double tolerance, int depth) {
  const glm::dvec2 mid = 0.5 * (lo + hi);
  const glm::dvec2 corners[4][2] = {
      {lo, mid}, {{mid.x, lo.y}, {hi.x, mid.y}}, {{lo.x, mid.y}, {mid.x, hi.y}}, {mid, hi}};
  double quarters[4], sum = 0.0;
  for (int i = 0; i < 4; ++i) {
    quarters[i] = gauss(density, corners[i][0], corners[i][1]);
    sum += quarters[i];
  }
  if (depth == 0 || std::abs(sum - whole) <= tolerance) return sum;
  sum = 0.0;
  for (int i = 0; i < 4; ++i) {
    sum += refine(density, corners[i][0], corners[i][1], quarters[i], 0.5 * tolerance, depth - 1);
  }
  return sum;
}

}  // namespace

double sidak_significance(int tests) { return -std::expm1(std::log1p(-test_significance) / tests); }

double upper_gamma(double a, double x) {
  if (x <= 0.0) return 1.0;
  return x < a + 1.0 ? 1.0 - lower_gamma_series(a, x) : upper_gamma_fraction(a, x);
}

ChiSquare chi_square(const std::vector<double>& observed, const std::vector<double>& expected) {
  struct Cell {
    double observed = 0.0, expected = 0.0;
  };
  std::vector<Cell> pooled;
  Cell pool;
  double impossible = 0.0, total = 0.0;
  for (std::size_t i = 0; i < observed.size(); ++i) {
    pool.observed += observed[i];
    pool.expected += expected[i];
    total += observed[i];
    if (expected[i] < 1e-6) impossible += observed[i];
    if (pool.expected >= min_expected) {
      pooled.push_back(pool);
      pool = {};
    }
  }
  if (pooled.empty()) return {};
  pooled.back().observed += pool.observed;
  pooled.back().expected += pool.expected;

  ChiSquare result;
  for (const Cell& c : pooled) {
    const double difference = c.observed - c.expected;
    result.statistic += difference * difference / c.expected;
  }
  // Rounding may carry a few samples over the edge of the support, no more.
  if (impossible > 1e-4 * total) result.statistic = std::numeric_limits<double>::infinity();
  result.degrees = int(pooled.size()) - 1;
  if (!(result.statistic < 1e9)) {
    result.p_value = 0.0;
  } else if (result.degrees > 0) {
    result.p_value = upper_gamma(0.5 * result.degrees, 0.5 * result.statistic);
  }
  return result;
}

double integrate(const SquareDensity& density, glm::dvec2 lo, glm::dvec2 hi, double tolerance) {
  return refine(density, lo, hi, gauss(density, lo, hi), tolerance, 8);
}

CellCounts::CellCounts(int columns, int rows)
    : columns_(columns), rows_(rows), counts_(std::size_t(columns) * std::size_t(rows), 0.0) {}

void CellCounts::add(glm::dvec2 point) {
  const int x = std::clamp(int(point.x * columns_), 0, columns_ - 1);
  const int y = std::clamp(int(point.y * rows_), 0, rows_ - 1);
  ++counts_[std::size_t(x * rows_ + y)];
}

DensityTest CellCounts::test(const SquareDensity& density) const {
  DensityTest result;
  const double valid = std::accumulate(counts_.begin(), counts_.end(), 0.0);
  result.samples = valid + lost_;
  result.valid_share = valid / result.samples;
  // A fraction of a sample per cell, which is far below the noise.
  const double tolerance = 0.1 / result.samples;
  std::vector<double> expected;
  for (int x = 0; x < columns_; ++x) {
    for (int y = 0; y < rows_; ++y) {
      const glm::dvec2 cells(columns_, rows_);
      expected.push_back(integrate(density, glm::dvec2(x, y) / cells,
                                   glm::dvec2(x + 1, y + 1) / cells, tolerance));
      result.mass += expected.back();
    }
  }
  for (double& e : expected) e *= result.samples;
  std::vector<double> observed = counts_;
  observed.push_back(lost_);
  expected.push_back(std::max(0.0, 1.0 - result.mass) * result.samples);
  result.chi_square = chi_square(observed, expected);
  return result;
}

DirectionMap::DirectionMap(glm::dvec3 axis, double power) : power_(power) {
  const glm::dvec3 z = glm::normalize(axis);
  const glm::dvec3 other =
      std::abs(z.x) < 0.5 ? glm::dvec3(1.0, 0.0, 0.0) : glm::dvec3(0.0, 1.0, 0.0);
  const glm::dvec3 x = glm::normalize(glm::cross(other, z));
  frame_ = glm::dmat3(x, glm::cross(z, x), z);
}

glm::dvec2 DirectionMap::to_square(glm::dvec3 direction) const {
  const glm::dvec3 w = glm::normalize(direction);
  const glm::dvec3 gap = w - frame_[2];
  const double one_minus_cos = 0.5 * glm::dot(gap, gap);
  const double turn = std::atan2(glm::dot(w, frame_[1]), glm::dot(w, frame_[0])) / (2.0 * pi);
  return {std::pow(0.5 * one_minus_cos, 1.0 / power_), turn < 0.0 ? turn + 1.0 : turn};
}

glm::dvec3 DirectionMap::to_direction(glm::dvec2 point) const {
  const double one_minus_cos = 2.0 * std::pow(point.x, power_);
  const double sine = std::sqrt(std::max(0.0, one_minus_cos * (2.0 - one_minus_cos)));
  const double angle = 2.0 * pi * point.y;
  return frame_ * glm::dvec3(sine * std::cos(angle), sine * std::sin(angle), 1.0 - one_minus_cos);
}

double DirectionMap::solid_angle_per_area(glm::dvec2 point) const {
  return 4.0 * pi * power_ * std::pow(point.x, power_ - 1.0);
}

}  // namespace lockstep
