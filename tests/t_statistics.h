// Tail probabilities and running moments for tests of random quantities.
//
// A test states its significance: the chance that correct code fails it, were the seeds drawn anew.
// Seeds are fixed, so a test that passes goes on passing.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

namespace lockstep {

// Chance per test, over all it looks at, of failing correct code.
inline constexpr double significance = 1e-4;

// What each of n tests may spend of `alpha` (Sidak 1967).
inline double sidak(double alpha, double n) { return -std::expm1(std::log1p(-alpha) / n); }

// Regularised upper incomplete gamma function: series below a + 1, Lentz's fraction above.
inline double upper_gamma(double a, double x) {
  if (x <= 0.0) return 1.0;
  const double scale = std::exp(a * std::log(x) - x - std::lgamma(a));
  if (x < a + 1.0) {
    double term = 1.0 / a, sum = term;
    for (double n = a + 1.0; term > sum * 1e-15; n += 1.0) sum += term *= x / n;
    return 1.0 - sum * scale;
  }
  double b = x + 1.0 - a, c = 1e300, d = 1.0 / b, h = d;
  for (int i = 1; i < 10000; ++i) {
    const double an = -i * (i - a);
    b += 2.0;
    d = 1.0 / (an * d + b);
    c = b + an / c;
    h *= d * c;
    if (std::abs(d * c - 1.0) < 1e-14) break;
  }
  return h * scale;
}

// P(chi-square with `freedom` degrees of freedom > x).
inline double chi_square_tail(double x, double freedom) {
  return upper_gamma(0.5 * freedom, 0.5 * x);
}

// Regularised incomplete beta function I_x(a, b), by Lentz's fraction.
inline double incomplete_beta(double a, double b, double x) {
  if (x <= 0.0 || x >= 1.0) return x <= 0.0 ? 0.0 : 1.0;
  if (x > (a + 1.0) / (a + b + 2.0)) return 1.0 - incomplete_beta(b, a, 1.0 - x);
  const double scale = std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) +
                                a * std::log(x) + b * std::log1p(-x)) /
                       a;
  double c = 1.0, d = 1.0 / (1.0 - (a + b) * x / (a + 1.0)), h = d;
  const auto step = [&](double coefficient) {
    d = 1.0 / (1.0 + coefficient * d);
    c = 1.0 + coefficient / c;
    h *= d * c;
  };
  for (int m = 1; m < 10000; ++m) {
    step(m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m)));
    step(-(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1)));
    if (std::abs(d * c - 1.0) < 1e-14) break;
  }
  return scale * h;
}

// P(|Student's t| > |t|).
inline double t_tail(double t, double freedom) {
  return incomplete_beta(0.5 * freedom, 0.5, freedom / (freedom + t * t));
}

// P(|normal| > |z|).
inline double normal_tail(double z) { return std::erfc(std::abs(z) / std::sqrt(2.0)); }

// Mean and variance in one pass (Welford 1962).
struct Moments {
  double count = 0.0, mean = 0.0, squares = 0.0;

  void add(double x) {
    const double delta = x - mean;
    count += 1.0;
    mean += delta / count;
    squares += delta * (x - mean);
  }
  double variance() const { return count > 1.0 ? squares / (count - 1.0) : 0.0; }
  double mean_variance() const { return count > 0.0 ? variance() / count : 0.0; }
};

// Probability under equal means of a difference at least this large (Welch 1947). `floor` is a
// difference that rounding explains: 1 below it.
inline double equal_means(const Moments& a, const Moments& b, double floor = 0.0) {
  const double difference = std::abs(a.mean - b.mean);
  if (difference <= floor) return 1.0;
  const double va = a.mean_variance(), vb = b.mean_variance();
  if (va + vb <= 0.0) return 0.0;
  const double freedom = (va + vb) * (va + vb) /
                         (va * va / (a.count - 1.0) + (vb > 0.0 ? vb * vb / (b.count - 1.0) : 0.0));
  return t_tail((difference - floor) / std::sqrt(va + vb), freedom);
}

// Probability of a mean at least this far from `expected` (one-sample t-test).
inline double mean_is(const Moments& a, double expected, double floor = 0.0) {
  const double difference = std::abs(a.mean - expected);
  if (difference <= floor) return 1.0;
  if (a.variance() <= 0.0) return 0.0;
  return t_tail((difference - floor) / std::sqrt(a.mean_variance()), a.count - 1.0);
}

// Probability of counts at least this uneven where all cells are equally likely.
inline double evenness(const std::vector<std::uint32_t>& cells) {
  double total = 0.0, x = 0.0;
  for (const std::uint32_t n : cells) total += n;
  const double expected = total / double(cells.size());
  for (const std::uint32_t n : cells) x += (n - expected) * (n - expected) / expected;
  return chi_square_tail(x, double(cells.size()) - 1.0);
}

}  // namespace lockstep
