// Sample values through the kernels: bits across widths, stratification, uniformity, independence.
// Statistics are taken with the widest kernel; that the others agree bit for bit is tested first.
#include "packets/kernel.h"
#include "samplers/make_state.h"
#include "samplers/dimensions.h"
#include "samplers/sampler.h"
#include "tests/t_statistics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace lockstep {
namespace {

// Values of one pair for (pixel, sample) couples, in their order.
struct Couples {
  std::vector<std::uint32_t> pixel, sample;

  void add(std::uint32_t p, std::uint32_t s) {
    pixel.push_back(p);
    sample.push_back(s);
  }
  std::size_t size() const { return pixel.size(); }
};

struct Values {
  std::vector<float> u, v;
  bool operator==(const Values&) const = default;
};

// Asks for the couples in the order of `path` (all of them, if empty) in one batch.
Values draw_batch(const Kernel& kernel, const SamplerState& state, const Couples& c, int pair,
                  const std::vector<std::int32_t>& path = {}) {
  Couples batched = path.empty() ? c : Couples{};
  for (const std::int32_t i : path) batched.add(c.pixel[size_t(i)], c.sample[size_t(i)]);
  const auto n = batched.size();
  const auto [low, high] = std::minmax_element(c.sample.begin(), c.sample.end());
  // Behind the end: a pixel that exists, and any sample.
  batched.pixel.resize(n + 16, batched.pixel.back());
  batched.sample.resize(n + 16, 0xffffffffu);
  Values values{std::vector<float>(n + 16), std::vector<float>(n + 16)};
  const SampleBatch batch{batched.pixel.data(), batched.sample.data(), int(n), *low,
                          int(*high - *low + 1)};
  EXPECT_LE(batch.samples, max_samples_per_batch);
  kernel.fill_pair(state, batch, pair, values.u.data(), values.v.data());
  values.u.resize(n);
  values.v.resize(n);
  return values;
}

// All samples [first, first + count) of one pixel.
Values draw(const SamplerState& state, std::uint32_t pixel, int pair, std::uint32_t first,
            std::uint32_t count) {
  const Kernel& kernel = find_kernel(available_isas().back(), 0);
  Values all;
  for (std::uint32_t done = 0; done < count; done += max_samples_per_batch) {
    Couples c;
    const std::uint32_t n = std::min<std::uint32_t>(max_samples_per_batch, count - done);
    for (std::uint32_t k = 0; k < n; ++k) c.add(pixel, first + done + k);
    const Values part = draw_batch(kernel, state, c, pair);
    all.u.insert(all.u.end(), part.u.begin(), part.u.end());
    all.v.insert(all.v.end(), part.v.begin(), part.v.end());
  }
  return all;
}

SamplerState state_of(std::string_view text, std::uint32_t seed = 7) {
  return make_state(parse_sampler(text), seed);
}

const char* const samplers[] = {"random",
                                "owen",
                                "cpt",
                                "cpt:sequence=random",
                                "rcs:weight=0",
                                "rcs:weight=0.3,offset=fresh",
                                "rcs:weight=1,offset=fresh",
                                "rcs:weight=0.3,offset=fresh,sequence=random",
                                "rcs:weight=0.3,offset=constant",
                                "rcs:weight=1,offset=constant"};

// Correlation of two equally long series, as a standard normal under independence.
double correlation_z(const std::vector<float>& a, const std::vector<float>& b) {
  Moments ma, mb;
  for (const float x : a) ma.add(double(x));
  for (const float x : b) mb.add(double(x));
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    sum += (double(a[i]) - ma.mean) * (double(b[i]) - mb.mean);
  }
  const double n = double(a.size());
  return sum / std::sqrt(ma.squares * mb.squares) * std::sqrt(n);
}

// Evenness of points over n x n cells.
double joint_evenness(const std::vector<float>& a, const std::vector<float>& b, int n) {
  std::vector<std::uint32_t> cells(size_t(n) * size_t(n));
  for (std::size_t i = 0; i < a.size(); ++i) {
    ++cells[size_t(a[i] * float(n)) * size_t(n) + size_t(b[i] * float(n))];
  }
  return evenness(cells);
}

double evenness_of(const std::vector<float>& a, int n) {
  std::vector<std::uint32_t> cells(static_cast<size_t>(n));
  for (const float x : a) ++cells[size_t(x * float(n))];
  return evenness(cells);
}

// Values of all paths, and of the listed ones by themselves, at W = 4, 8, 16 as at W = 1.
void expect_same_at_all_widths(const SamplerState& state, const Couples& c, int pair,
                               const std::vector<std::int32_t>& some) {
  for (const Isa isa : available_isas()) {
    const Values all = draw_batch(find_kernel(isa, 1), state, c, pair);
    for (const int width : {1, 4, 8, 16}) {
      const Kernel& kernel = find_kernel(isa, width);
      ASSERT_EQ(draw_batch(kernel, state, c, pair), all) << name(isa) << ' ' << width;
      const Values few = draw_batch(kernel, state, c, pair, some);
      for (std::size_t i = 0; i < some.size(); ++i) {
        ASSERT_EQ(few.u[i], all.u[size_t(some[i])]) << name(isa) << ' ' << width;
        ASSERT_EQ(few.v[i], all.v[size_t(some[i])]) << name(isa) << ' ' << width;
      }
    }
  }
}

TEST(Samplers, AllWidthsGiveTheSameBits) {
  Couples c;
  for (std::uint32_t i = 0; i < 300; ++i) c.add((i * 7919u) % 1000u, 100u + (i * 31u) % 37u);
  std::vector<float> map(1000);
  for (std::size_t i = 0; i < map.size(); ++i) map[i] = float(i % 11) / 10.0f;
  // Some of the paths, out of order, and one of them twice; no multiple of any width.
  std::vector<std::int32_t> some;
  for (int i = 0; i < 101; ++i) some.push_back((i * 83 + 5) % 300);
  some.push_back(some.front());

  for (const char* text : samplers) {
    for (const bool mapped : {false, true}) {
      SamplerState state = state_of(text);
      if (mapped) state.weights = map.data();
      SCOPED_TRACE(std::string(text) + (mapped ? " with a map" : ""));
      for (const int pair : {pixel_pair, sample_pair(0, Purpose::Light),
                             sample_pair(max_depth - 1, Purpose::Roulette)}) {
        expect_same_at_all_widths(state, c, pair, some);
      }
    }
  }
}

// Products and sums are fused where the instruction set has it, which perturb() may show.
TEST(Samplers, InstructionSetsAgreeToTheLastBits) {
  Couples c;
  for (std::uint32_t i = 0; i < 256; ++i) c.add(i * 7919u, i);
  for (const char* text : samplers) {
    const SamplerState state = state_of(text);
    const Values first = draw_batch(find_kernel(Isa::Sse4, 1), state, c, 2);
    for (const Isa isa : available_isas()) {
      const Values values = draw_batch(find_kernel(isa, 0), state, c, 2);
      if (state.perturbation == Perturbation::None) {
        EXPECT_EQ(values, first) << text;
        continue;
      }
      for (std::size_t i = 0; i < values.u.size(); ++i) {
        const double gap = std::abs(double(values.u[i]) - double(first.u[i]));
        EXPECT_LE(std::min(gap, 1.0 - gap), 0x1p-23) << text;
      }
    }
  }
}

TEST(Samplers, AValueDoesNotDependOnItsBatch) {
  const Kernel& kernel = find_kernel(available_isas().back(), 0);
  for (const char* text : samplers) {
    const SamplerState state = state_of(text);
    const Values all = draw(state, 12, 3, 0, 64);
    for (const std::uint32_t k : {0u, 1u, 17u, 63u}) {
      Couples one;
      one.add(12, k);
      const Values alone = draw_batch(kernel, state, one, 3);
      EXPECT_EQ(alone.u[0], all.u[k]) << text;
      EXPECT_EQ(alone.v[0], all.v[k]) << text;
    }
  }
}

TEST(Samplers, ValuesLieInTheUnitInterval) {
  for (const char* text : samplers) {
    for (const std::uint32_t seed : {0u, 1u, 0xffffffffu}) {
      for (const std::uint32_t first : {0u, 0x7fffff00u, 0xfffff000u}) {
        const Values values = draw(state_of(text, seed), 0xfffffffeu % 999u, 5, first, 2048);
        for (const float x : values.u) ASSERT_TRUE(x >= 0.0f && x < 1.0f) << text;
        for (const float x : values.v) ASSERT_TRUE(x >= 0.0f && x < 1.0f) << text;
      }
    }
  }
}

TEST(Samplers, SeedsPixelsPairsAndSamplesAllCount) {
  for (const char* text : samplers) {
    const Values base = draw(state_of(text, 7), 12, 3, 0, 64);
    EXPECT_NE(draw(state_of(text, 8), 12, 3, 0, 64), base) << text;
    EXPECT_NE(draw(state_of(text, 7), 12, 4, 0, 64), base) << text;
    EXPECT_NE(draw(state_of(text, 7), 12, 3, 64, 64), base) << text;
    EXPECT_NE(base.u, base.v) << text;
    const SamplerState state = state_of(text);
    const bool own =
        !state.shared || (state.perturbation != Perturbation::None && state.weight > 0.0f);
    EXPECT_EQ(draw(state, 13, 3, 0, 64) != base, own) << text;
  }
}

// Nets -----------------------------------------------------------------------------------------

// True where every elementary interval of area 1/n holds exactly one of the n = 2^bits points.
bool is_net(const Values& points, int bits) {
  for (int along_u = 0; along_u <= bits; ++along_u) {
    const int columns = 1 << along_u, rows = 1 << (bits - along_u);
    std::vector<bool> taken(size_t(1) << bits, false);
    for (std::size_t i = 0; i < points.u.size(); ++i) {
      const std::size_t cell = size_t(points.v[i] * float(rows)) * size_t(columns) +
                               size_t(points.u[i] * float(columns));
      if (taken[cell]) return false;
      taken[cell] = true;
    }
  }
  return true;
}

TEST(OwenSampler, EveryAlignedBlockIsANet) {
  for (const std::uint32_t seed : {0u, 1u, 12345u}) {
    const SamplerState state = state_of("owen", seed);
    for (const std::uint32_t pixel : {0u, 1u, 511u, 1000003u}) {
      for (const int pair :
           {pixel_pair, sample_pair(0, Purpose::Light), sample_pair(1, Purpose::Bsdf), 4095}) {
        for (int bits = 0; bits <= 10; ++bits) {
          const std::uint32_t n = 1u << bits;
          for (const std::uint32_t block : {0u, 1u, 2u, 5u}) {
            ASSERT_TRUE(is_net(draw(state, pixel, pair, block * n, n), bits))
                << "seed " << seed << " pixel " << pixel << " pair " << pair << " block " << block
                << " of " << n;
          }
        }
      }
    }
  }
}

TEST(OwenSampler, NoUnalignedBlockHasToBeANet) {
  // Guards the test above: it can tell a net from other points.
  EXPECT_FALSE(is_net(draw(state_of("owen"), 3, 2, 128, 256), 8));
  EXPECT_FALSE(is_net(draw(state_of("random"), 3, 2, 0, 16), 4));
}

TEST(SharedOwenSampler, EveryAlignedBlockIsANet) {
  for (const std::uint32_t pixel : {0u, 77u}) {
    EXPECT_TRUE(is_net(draw(state_of("cpt"), pixel, 2, 256, 256), 8));
  }
}

// A fixed offset keeps every row and column of cells evenly filled, to within the cells that the
// rotation cuts; fresh offsets do not.
TEST(SharedOwenSampler, AConstantOffsetKeepsStratification) {
  const auto worst_row = [](const Values& points, int rows) {
    std::vector<int> count(static_cast<size_t>(rows));
    for (const float x : points.u) ++count[size_t(x * float(rows))];
    const auto [low, high] = std::minmax_element(count.begin(), count.end());
    return *high - *low;
  };
  const Values constant = draw(state_of("rcs:weight=1,offset=constant"), 5, 2, 0, 1024);
  const Values fresh = draw(state_of("rcs:weight=1,offset=fresh"), 5, 2, 0, 1024);
  EXPECT_LE(worst_row(constant, 32), 2);
  EXPECT_GT(worst_row(fresh, 32), 8);
}

// Over seeds every single point is uniform: what makes the sampler unbiased.
TEST(OwenSampler, EachPointIsUniformOverSeedsPixelsAndPairs) {
  const int tests = 3 * 4 * 3;
  for (const char* text : {"owen", "cpt", "random"}) {
    for (const std::uint32_t k : {0u, 1u, 6u, 63u}) {
      std::vector<float> u, v;
      for (std::uint32_t i = 0; i < 8192; ++i) {
        const Values one = draw(state_of(text, i), i % 7, int(i % 5), k, 1);
        u.push_back(one.u[0]);
        v.push_back(one.v[0]);
      }
      EXPECT_GT(evenness_of(u, 64), sidak(significance, tests)) << text << ' ' << k;
      EXPECT_GT(evenness_of(v, 64), sidak(significance, tests)) << text << ' ' << k;
      EXPECT_GT(joint_evenness(u, v, 16), sidak(significance, tests)) << text << ' ' << k;
    }
  }
}

// Uniformity and independence -------------------------------------------------------------------

constexpr std::uint32_t many = 1 << 16;

TEST(RandomSampler, IsUniformInOneAndTwoDimensions) {
  const std::uint32_t seeds[] = {0, 1, 99};
  const double limit = sidak(significance, 3 * 3 * 3);
  for (const std::uint32_t seed : seeds) {
    for (const std::uint32_t pixel : {0u, 1u, 262143u}) {
      const Values x = draw(state_of("random", seed), pixel, 2, 0, many);
      EXPECT_GT(evenness_of(x.u, 1024), limit);
      EXPECT_GT(evenness_of(x.v, 1024), limit);
      EXPECT_GT(joint_evenness(x.u, x.v, 32), limit);
    }
  }
}

TEST(RandomSampler, LowBitsAreUniformToo) {
  const Values x = draw(state_of("random"), 3, 2, 0, many);
  std::vector<float> low;
  for (const float u : x.u) low.push_back(u * 65536.0f - std::floor(u * 65536.0f));
  EXPECT_GT(evenness_of(low, 256), significance);
}

// The series of `text` at neighbouring samples, pixels, pairs and seeds.
void expect_no_correlation(const char* text, bool between_pixels = true) {
  std::vector<std::pair<const char*, double>> z;
  const auto compare = [&](const char* what, const Values& a, const Values& b) {
    z.emplace_back(what, correlation_z(a.u, b.u));
    z.emplace_back(what, correlation_z(a.v, b.v));
    z.emplace_back(what, correlation_z(a.u, b.v));
  };
  const Values base = draw(state_of(text, 7), 100, 2, 0, many);
  z.emplace_back("u and v", correlation_z(base.u, base.v));
  for (const std::uint32_t lag : {1u, 2u, 4u, 16u, 256u}) {
    compare("samples", base, draw(state_of(text, 7), 100, 2, lag, many));
  }
  if (between_pixels) {
    for (const std::uint32_t pixel : {101u, 102u, 612u, 228u}) {
      compare("pixels", base, draw(state_of(text, 7), pixel, 2, 0, many));
    }
  }
  for (const int pair : {0, 3, 4, 6, 10}) {
    compare("pairs", base, draw(state_of(text, 7), 100, pair, 0, many));
  }
  for (const std::uint32_t seed : {6u, 8u, 0u, 0x80000007u}) {
    compare("seeds", base, draw(state_of(text, seed), 100, 2, 0, many));
  }
  for (const auto& [what, value] : z) {
    EXPECT_GT(normal_tail(value), sidak(significance, double(z.size()))) << text << ", " << what;
  }
}

TEST(RandomSampler, IsUncorrelatedAlongEveryAxis) { expect_no_correlation("random"); }

// Stratified sequences are less correlated than chance allows, except that neighbours in k of one
// sequence avoid each other: lags are left to the net tests.
TEST(OwenSampler, IsUncorrelatedBetweenPixelsPairsAndSeeds) {
  constexpr std::uint32_t n = 4096;
  const auto series = [](std::uint32_t seed, std::uint32_t pixel, int pair) {
    return draw(state_of("owen", seed), pixel, pair, 0, n);
  };
  const Values base = series(7, 100, 2);
  std::vector<double> z{correlation_z(base.u, base.v)};
  for (const std::uint32_t pixel : {101u, 102u, 228u, 612u}) {
    z.push_back(correlation_z(base.u, series(7, pixel, 2).u));
    z.push_back(correlation_z(base.v, series(7, pixel, 2).v));
  }
  for (const int pair : {0, 3, 4, 6}) z.push_back(correlation_z(base.u, series(7, 100, pair).u));
  for (const std::uint32_t s : {6u, 8u}) z.push_back(correlation_z(base.u, series(s, 100, 2).u));
  for (const double value : z) {
    EXPECT_GT(normal_tail(value), sidak(significance, double(z.size()))) << value;
  }
}

TEST(OwenSampler, TheFirstPointsOfPixelsAreIndependent) {
  std::vector<float> u, next, other_pair;
  for (std::uint32_t pixel = 0; pixel < many; ++pixel) {
    const Values here = draw(state_of("owen"), pixel, 2, 0, 1);
    u.push_back(here.u[0]);
    other_pair.push_back(draw(state_of("owen"), pixel, 3, 0, 1).u[0]);
    if (pixel > 0) next.push_back(here.u[0]);
  }
  const double limit = sidak(significance, 3);
  EXPECT_GT(joint_evenness(u, other_pair, 16), limit);
  EXPECT_GT(evenness_of(u, 256), limit);
  u.pop_back();
  EXPECT_GT(joint_evenness(u, next, 16), limit);
}

// Shared sequences ------------------------------------------------------------------------------

TEST(SharedSampler, AllPixelsGetTheSamePoint) {
  for (const char* text : {"cpt", "cpt:sequence=random", "rcs:weight=0"}) {
    const Values first = draw(state_of(text), 0, 4, 0, 256);
    for (const std::uint32_t pixel : {1u, 2u, 512u, 999999u}) {
      EXPECT_EQ(draw(state_of(text), pixel, 4, 0, 256), first) << text;
    }
  }
}

TEST(SharedSampler, NoWeightIsCoherentPathTracing) {
  const std::vector<float> zeros(64, 0.0f);
  for (const int pair : {0, 2, 9}) {
    const Values cpt = draw(state_of("cpt"), 9, pair, 0, 256);
    EXPECT_EQ(draw(state_of("rcs:weight=0,offset=fresh"), 9, pair, 0, 256), cpt);
    EXPECT_EQ(draw(state_of("rcs:weight=0,offset=constant"), 9, pair, 0, 256), cpt);
    SamplerState mapped = state_of("rcs:weight=1,offset=fresh");
    mapped.weights = zeros.data();
    EXPECT_EQ(draw(mapped, 9, pair, 0, 256), cpt);
  }
}

TEST(SharedSampler, AMapGivesEachPixelItsWeight) {
  const float map[] = {0.0f, 0.3f, 1.0f};
  SamplerState mapped = state_of("rcs:weight=0.5,offset=fresh");
  mapped.weights = map;
  EXPECT_EQ(draw(mapped, 0, 2, 0, 64), draw(state_of("rcs:weight=0"), 0, 2, 0, 64));
  EXPECT_EQ(draw(mapped, 1, 2, 0, 64), draw(state_of("rcs:weight=0.3,offset=fresh"), 1, 2, 0, 64));
  EXPECT_EQ(draw(mapped, 2, 2, 0, 64), draw(state_of("rcs:weight=1,offset=fresh"), 2, 2, 0, 64));
}

// How far `a` is ahead of `b` on the circle, in [0, 1).
float ahead(float a, float b) { return a < b ? a - b + 1.0f : a - b; }

TEST(SharedSampler, PixelsStayWithinTheirWeightOfTheSequence) {
  for (const char* weight : {"0.01", "0.1", "0.5"}) {
    const float w = std::stof(weight);
    for (const char* offset : {"fresh", "constant"}) {
      const auto text = std::string("rcs:weight=") + weight + ",offset=" + offset;
      const Values shared = draw(state_of("cpt"), 0, 2, 0, 1024);
      const Values own = draw(state_of(text), 44, 2, 0, 1024);
      for (std::size_t k = 0; k < shared.u.size(); ++k) {
        // Rounding may put a value an ulp behind, which reads as nearly 1 ahead.
        const float du = ahead(own.u[k] + 1e-6f, shared.u[k]);
        const float dv = ahead(own.v[k] + 1e-6f, shared.v[k]);
        ASSERT_TRUE(du <= w + 2e-6f && dv <= w + 2e-6f) << text;
      }
    }
  }
}

TEST(SharedSampler, AConstantOffsetDoesNotDependOnTheSample) {
  const Values shared = draw(state_of("cpt"), 0, 2, 0, 512);
  const Values own = draw(state_of("rcs:weight=0.7,offset=constant"), 44, 2, 0, 512);
  const float u = ahead(own.u[0], shared.u[0]), v = ahead(own.v[0], shared.v[0]);
  EXPECT_NE(u, v);
  for (std::size_t k = 0; k < shared.u.size(); ++k) {
    ASSERT_NEAR(ahead(own.u[k], shared.u[k]), u, 1e-6f);
    ASSERT_NEAR(ahead(own.v[k], shared.v[k]), v, 1e-6f);
  }
  // Other pixels and pairs have offsets of their own.
  std::set<float> offsets;
  for (std::uint32_t pixel = 0; pixel < 64; ++pixel) {
    for (const int pair : {2, 3}) {
      const float here = draw(state_of("rcs:weight=0.7,offset=constant"), pixel, pair, 0, 1).u[0];
      offsets.insert(ahead(here, draw(state_of("cpt"), 0, pair, 0, 1).u[0]));
    }
  }
  EXPECT_EQ(offsets.size(), 128u);
}

TEST(SharedSampler, EveryPixelIsUniformAtEveryWeight) {
  const std::vector<std::string> weights = {"0.001", "0.1", "0.3", "0.5", "0.9", "1"};
  const double limit = sidak(significance, 3.0 * double(weights.size()));
  for (const std::string& w : weights) {
    // A random sequence: with a stratified one counts would be too even for chi-square.
    const Values x = draw(state_of("rcs:sequence=random,offset=fresh,weight=" + w), 31, 2, 0, many);
    EXPECT_GT(evenness_of(x.u, 256), limit) << w;
    EXPECT_GT(evenness_of(x.v, 256), limit) << w;
    EXPECT_GT(joint_evenness(x.u, x.v, 16), limit) << w;
  }
}

TEST(SharedSampler, FullWeightMakesNeighboursIndependent) {
  const double limit = sidak(significance, 2 * 4);
  for (const char* text :
       {"rcs:weight=1,offset=fresh", "rcs:weight=1,offset=fresh,sequence=random"}) {
    const Values a = draw(state_of(text), 40, 2, 0, many);
    for (const std::uint32_t neighbour : {41u, 552u}) {
      const Values b = draw(state_of(text), neighbour, 2, 0, many);
      EXPECT_GT(joint_evenness(a.u, b.u, 32), limit) << text;
      EXPECT_GT(joint_evenness(a.u, b.v, 32), limit) << text;
    }
  }
  expect_no_correlation("rcs:weight=1,offset=fresh,sequence=random");
}

TEST(SharedSampler, PartialWeightKeepsNeighboursTogether) {
  // The opposite of the test above, so that it is known to notice.
  const Values a = draw(state_of("rcs:weight=0.3,offset=fresh"), 40, 2, 0, 4096);
  const Values b = draw(state_of("rcs:weight=0.3,offset=fresh"), 41, 2, 0, 4096);
  EXPECT_LT(joint_evenness(a.u, b.u, 16), 1e-9);
}

// At w = 1 the offset alone is what a pixel follows; it must not repeat the sequence's numbers.
TEST(SharedSampler, TheOffsetIsIndependentOfTheSequence) {
  const double limit = sidak(significance, 4);
  const Values own = draw(state_of("random"), 0xffffffffu, 2, 0, many);
  const Values shared = draw(state_of("cpt:sequence=random"), 5, 2, 0, many);
  const Values perturbed =
      draw(state_of("rcs:weight=1,sequence=random,offset=fresh"), 5, 2, 0, many);
  std::vector<float> offset;
  for (std::size_t k = 0; k < many; ++k) offset.push_back(ahead(perturbed.u[k], shared.u[k]));
  for (float& x : offset) x = std::min(x, one_minus_epsilon);
  EXPECT_GT(joint_evenness(shared.u, offset, 32), limit);
  EXPECT_GT(joint_evenness(shared.u, perturbed.u, 32), limit);
  EXPECT_GT(joint_evenness(draw(state_of("random"), 5, 2, 0, many).u, offset, 32), limit);
  EXPECT_EQ(own, shared);  // the shared sequence is that of a pixel no image has
}

TEST(Perturb, NeverReachesOne) {
  const float top = one_minus_epsilon, tiny = 0x1p-25f;
  for (const float u : {0.0f, tiny, 0x1p-24f, 0.5f, 1.0f - 0x1p-23f, top}) {
    for (const float w : {0.0f, 1e-30f, 1e-9f, 0x1p-24f, 0.3f, 1.0f - 0x1p-24f, 1.0f}) {
      for (const float offset : {0.0f, 1e-30f, tiny, 0x1p-24f, 0.5f, 1.0f - 0x1p-23f, top}) {
        const float x = perturb(u, w, offset);
        ASSERT_TRUE(x >= 0.0f && x < 1.0f) << u << ' ' << w << ' ' << offset;
      }
    }
  }
  // x - floor(x) of a tiny negative number rounds to exactly 1.
  for (const float below : {-1e-9f, -1e-30f, -0x1p-26f}) {
    EXPECT_EQ(perturb(below, 0.0f, 0.0f), top);
    EXPECT_EQ(perturb(0.0f, 1.0f, below), top);
  }
}

TEST(Perturb, AddsModuloOne) {
  EXPECT_EQ(perturb(0.25f, 0.5f, 0.5f), 0.5f);
  EXPECT_EQ(perturb(0.75f, 0.5f, 0.5f), 0.0f);
  EXPECT_EQ(perturb(0.75f, 1.0f, 0.75f), 0.5f);
  EXPECT_EQ(perturb(0.75f, 0.0f, 0.9f), 0.75f);
}

TEST(Dimensions, NoTwoPurposesShareAPair) {
  std::set<int> pairs{pixel_pair};
  int count = 1;
  for (int bounce = 0; bounce < max_depth; ++bounce) {
    for (const Purpose p : {Purpose::Light, Purpose::Bsdf, Purpose::Choice, Purpose::Roulette}) {
      EXPECT_TRUE(pairs.insert(sample_pair(bounce, p)).second);
      ++count;
    }
  }
  EXPECT_EQ(int(pairs.size()), count);
  EXPECT_LT(*pairs.rbegin(), 4096);
}

}  // namespace
}  // namespace lockstep
