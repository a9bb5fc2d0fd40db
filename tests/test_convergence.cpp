// How fast pixels' estimates come closer to an integral: root mean squared errors over many pixels
// for 16 to 4096 samples, as slopes on logarithmic axes, against what theory has for each sequence.
//
// Rates of low-discrepancy points have a power of log N as a factor, of which theory bounds the
// exponent: a slope may lie anywhere between that with and without it. Seeds are fixed; for the
// finite number of pixels slopes are off by 0.01 or so.
#include "tests/t_samples.h"

#include <cmath>
#include <numbers>

namespace lockstep::test_convergence {
namespace {

constexpr int all_pixels = 256, some_pixels = 4;
const std::vector<std::uint32_t> counts = {16, 64, 256, 1024, 4096};

// The first pixels' samples of a pair, batch after batch: calls f(pixel, u, v).
template <class F>
void for_samples(const SamplerState& state, int pixels, int pair, std::uint32_t count, F f) {
  for (std::uint32_t first = 0; first < count; first += max_samples_per_batch) {
    const std::uint32_t n = std::min<std::uint32_t>(max_samples_per_batch, count - first);
    Couples c;
    for (int pixel = 0; pixel < pixels; ++pixel) {
      for (std::uint32_t k = 0; k < n; ++k) c.add(std::uint32_t(pixel), first + k);
    }
    const Values values = draw_batch(widest_kernel(), state, c, pair);
    for (std::size_t i = 0; i < values.u.size(); ++i) {
      f(c.pixel[i], double(values.u[i]), double(values.v[i]));
    }
  }
}

using Integrand = double (*)(double u, double v);

// Products of smooth functions of one variable, neither symmetric nor periodic.
double smooth(double u, double v) { return std::exp(u + v); }
const double smooth_integral = std::pow(std::exp(1.0) - 1.0, 2);

// A quarter of a disk.
double disk(double u, double v) { return u * u + v * v < 2.0 * std::numbers::inv_pi ? 1.0 : 0.0; }
constexpr double disk_integral = 0.5;

double root_mean_square(const std::vector<double>& errors) {
  double squares = 0.0;
  for (const double e : errors) squares += e * e;
  return std::sqrt(squares / double(errors.size()));
}

double rms_error(const SamplerState& state, int pair, std::uint32_t count, Integrand f,
                 double integral) {
  std::vector<double> errors(all_pixels, -integral);
  for_samples(state, all_pixels, pair, count,
              [&](std::size_t pixel, double u, double v) { errors[pixel] += f(u, v) / count; });
  return root_mean_square(errors);
}

// Of log y over log N, by least squares.
double slope(const std::vector<double>& y) {
  double sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const double x = std::log(counts[i]), log_y = std::log(y[i]);
    sx += x, sy += log_y, sxx += x * x, sxy += x * log_y;
  }
  const double n = double(counts.size());
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

// Error ~ N^power (log N)^e with e in [0, logs].
struct Rate {
  const char* sampler;
  double power, logs = 0.0;
  int pair = 1;
};

void expect_rates(const std::vector<Rate>& rates, Integrand f, double integral, double tolerance) {
  std::vector<double> log_n;
  for (const std::uint32_t n : counts) log_n.push_back(std::log(n));
  for (const Rate& r : rates) {
    std::vector<double> errors;
    for (const std::uint32_t n : counts) {
      errors.push_back(rms_error(state_of(r.sampler, 7, {16, 16, n}), r.pair, n, f, integral));
    }
    const double found = slope(errors);
    EXPECT_GT(found, r.power - tolerance) << r.sampler;
    EXPECT_LT(found, r.power + r.logs * slope(log_n) + tolerance) << r.sampler;
  }
}

// Monte Carlo N^-1/2. Strata N^-1 in two dimensions (Haber 1966). Scrambled nets N^-3/2 (log N)^1/2
// (Owen 1997). Sequences N^-1 log N and shifted point sets N^-1 (log N)^1/2, as their L2
// discrepancies (Roth 1954 and Proinov 1986: no better can be had).
TEST(Convergence, OfASmoothFunction) {
  expect_rates({{"random", -0.5},
                {"stratified", -1.0},
                {"owen", -1.5, 0.5},
                {"sobol", -1.5, 0.5, 0},
                {"pmj02", -1.5, 0.5},
                {"linked", -1.5, 0.5},
                {"zsobol", -1.5, 0.5},
                {"halton", -1.0, 1.0},
                {"lattice", -1.0, 0.5},
                {"strata", -1.5, 0.5},
                {"bluenoise", -1.0, 0.5},
                {"rcs:weight=1", -1.0, 0.5},
                {"rcs:weight=1,mix=xor", -1.5, 0.5},
                {"rcs:weight=1,offset=fresh", -0.5}},
               smooth, smooth_integral, 0.05);
}

// Only strata that its edge cuts are in error, about N^1/2 of them, each by as much as a random
// point: N^-3/4. Shifted lattices too (Kendall 1948), and so Halton's boxes.
TEST(Convergence, OfADisk) {
  std::vector<Rate> rates{{"random", -0.5}, {"rcs:weight=1,offset=fresh", -0.5}};
  for (const char* sampler :
       {"stratified", "owen", "sobol", "pmj02", "linked", "zsobol", "halton", "lattice", "strata",
        "bluenoise", "rcs:weight=1", "rcs:weight=1,mix=xor"}) {
    rates.push_back({sampler, -0.75});
  }
  expect_rates(rates, disk, disk_integral, 0.1);
}

// Of u_1 u_2 + v_1 v_2 about the middle. Many seeds, as orders may be those of all pixels.
std::vector<double> errors_of_product(const std::string& sequence, int one, int two,
                                      std::uint32_t n) {
  std::vector<double> all;
  for (std::uint32_t seed = 0; seed < 64; ++seed) {
    const SamplerState state = state_of(sequence, seed, {16, 16, n});
    std::vector<double> u, v, errors(some_pixels);
    for_samples(state, some_pixels, one, n, [&](std::size_t, double x, double y) {
      u.push_back(x - 0.5), v.push_back(y - 0.5);
    });
    std::size_t i = 0;
    for_samples(state, some_pixels, two, n, [&](std::size_t pixel, double x, double y) {
      errors[pixel] += (u[i] * (x - 0.5) + v[i] * (y - 0.5)) / n;
      ++i;
    });
    all.insert(all.end(), errors.begin(), errors.end());
  }
  return all;
}

// A function of two pairs that is nothing in either alone: as with random numbers where pairs are
// padded, never slower. Pairs that go through their strata in the same order would never get there.
TEST(Convergence, OfAProductOfTwoPairs) {
  for (const std::string& sequence : sequence_names()) {
    for (const auto& [one, two] : {std::pair{0, 1}, {1, 2}, {0, 3}, {2, 5}, {3, 19}}) {
      std::vector<double> errors;
      for (const std::uint32_t n : counts) {
        errors.push_back(root_mean_square(errors_of_product(sequence, one, two, n)));
      }
      EXPECT_LT(slope(errors), -0.4) << sequence << ", pairs " << one << " and " << two;
    }
  }
}

}  // namespace
}  // namespace lockstep::test_convergence
