// Pearson's chi-square test of a sampling routine against the density that it claims.
//
// Samples are counted in equal cells of the unit square; a DirectionMap takes directions there. The
// density is integrated numerically over every cell, cells that expect few samples are pooled, and
// samples that carry nothing are counted in one more cell, which expects what the density lacks of
// an integral of 1. Seeds are fixed, so a test either always passes or always fails.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <functional>
#include <vector>

namespace lockstep {

// Chance that a set of tests rejects a correct program.
inline constexpr double test_significance = 0.01;

// Significance of each of `tests` independent tests for test_significance of them all (Sidak 1967).
double sidak_significance(int tests);

// Regularised upper incomplete gamma function Q(a, x), a > 0, x >= 0.
double upper_gamma(double a, double x);

struct ChiSquare {
  double statistic = 0.0;
  int degrees = 0;
  double p_value = 1.0;
};

// Expected values are counts, with the same sum as those observed.
ChiSquare chi_square(const std::vector<double>& observed, const std::vector<double>& expected);

// Density per unit area of the unit square.
using SquareDensity = std::function<double(glm::dvec2)>;

// Integral over the rectangle from lo to hi by adaptive Gauss quadrature; `tolerance` is absolute.
double integrate(const SquareDensity& density, glm::dvec2 lo, glm::dvec2 hi, double tolerance);

struct DensityTest {
  ChiSquare chi_square;
  double mass = 0.0;         // integral of the density
  double valid_share = 0.0;  // of samples that were not lost
  double samples = 0.0;
};

class CellCounts {
 public:
  CellCounts(int columns, int rows);
  void add(glm::dvec2 point);
  void add_lost() { ++lost_; }
  DensityTest test(const SquareDensity& density) const;

 private:
  int columns_, rows_;
  std::vector<double> counts_;
  double lost_ = 0.0;
};

// The sphere as a unit square: y is the angle around `axis`, and x the angle from it through
// 1 - cos = 2 x^power. A higher power gives more cells to directions near the axis.
class DirectionMap {
 public:
  explicit DirectionMap(glm::dvec3 axis, double power = 1.0);
  glm::dvec2 to_square(glm::dvec3 direction) const;
  glm::dvec3 to_direction(glm::dvec2 point) const;
  double solid_angle_per_area(glm::dvec2 point) const;

 private:
  glm::dmat3 frame_;
  double power_;
};

}  // namespace lockstep
