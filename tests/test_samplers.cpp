// What is true of every sampler: its values lie in [0, 1), are the same bits at every width and
// depend on nothing but seed, pixel, sample and pair; whose sequence it is; and, where pixels are
// meant to be independent, that they are.
//
// Statistics are taken with the widest kernel; that the others agree bit for bit is tested first.
#include "samplers/dimensions.h"
#include "samplers/index_shuffle.h"
#include "tests/t_samples.h"

#include <cmath>
#include <numeric>
#include <set>

namespace lockstep::test_samplers {
namespace {

constexpr float below_one = 1.0f - 0x1p-24f;
const int some_pairs[] = {pixel_pair, sample_pair(0, Purpose::Light), sample_pair(4, Purpose::Bsdf),
                          512, max_pairs - 1};

// Bits ------------------------------------------------------------------------------------------

// 300 paths of one tile, in no order, and no multiple of any width.
Couples paths_of_a_tile(int width) {
  Couples c;
  for (std::uint32_t i = 0; i < 300; ++i) {
    const std::uint32_t place = (i * 79u) % 256u;
    const std::uint32_t x = 16 + place % 16, y = 16 + place / 16;
    c.add(y * std::uint32_t(width) + x, 100u + (i * 31u) % 37u);
  }
  return c;
}

// Some of them in another order, and one of them twice.
std::vector<std::size_t> some_of(std::size_t count) {
  std::vector<std::size_t> some;
  for (std::size_t i = 0; i < 101; ++i) some.push_back((i * 83 + 5) % count);
  some.push_back(some.front());
  return some;
}

void expect_same_at_all_widths(const SamplerState& state, int pair) {
  const Couples all = paths_of_a_tile(state.width);
  const auto some = some_of(all.pixel.size());
  Couples few;
  for (const std::size_t i : some) few.add(all.pixel[i], all.sample[i]);
  const Values expected = draw_batch(find_kernel(available_isas().front(), 1), state, all, pair);
  Values expected_few;
  for (const std::size_t i : some) {
    expected_few.u.push_back(expected.u[i]);
    expected_few.v.push_back(expected.v[i]);
  }
  for (const Isa isa : available_isas()) {
    for (const int width : {1, 4, 8, 16}) {
      const Kernel& kernel = find_kernel(isa, width);
      ASSERT_EQ(draw_batch(kernel, state, all, pair), expected) << name(isa) << ' ' << width;
      ASSERT_EQ(draw_batch(kernel, state, few, pair), expected_few) << name(isa) << ' ' << width;
    }
  }
}

TEST(Samplers, WidthsInstructionSetsAndBatchesGiveTheSameBits) {
  const SamplePlan plan{48, 48, 37};
  std::vector<float> map(48 * 48);
  for (std::size_t i = 0; i < map.size(); ++i) map[i] = float(i % 11) / 10.0f;
  for (const std::string& text : all_samplers()) {
    SCOPED_TRACE(text);
    SamplerState state = state_of(text, 7, plan);
    for (const int pair : some_pairs) expect_same_at_all_widths(state, pair);
    if (state.shared_pairs == 0 || state.perturbation == PerturbationId{}) continue;
    state.weights = map.data();
    state.interleave = 4;
    expect_same_at_all_widths(state, 1);
  }
}

TEST(Samplers, AValueDoesNotDependOnTheSamplesBesideIt) {
  for (const std::string& text : all_samplers()) {
    const SamplerState state = state_of(text, 7, {32, 32, 64});
    const Values all = draw(state, 12, 2, 0, 64);
    for (const std::uint32_t k : {0u, 1u, 17u, 63u}) {
      const Values alone = draw(state, 12, 2, k, 1);
      EXPECT_EQ(alone.u[0], all.u[k]) << text;
      EXPECT_EQ(alone.v[0], all.v[k]) << text;
    }
  }
}

// Range -----------------------------------------------------------------------------------------

void expect_in_unit_interval(const Values& values) {
  for (const float x : values.u) ASSERT_TRUE(x >= 0.0f && x < 1.0f) << x;
  for (const float x : values.v) ASSERT_TRUE(x >= 0.0f && x < 1.0f) << x;
}

// Samplers x weights x blocks of indices, with the other parameters taking turns.
TEST(Samplers, ValuesLieInTheUnitInterval) {
  const std::vector<std::uint32_t> first = {
      0, (1u << 12) - 8, (1u << 16) - 8, 1u << 24, (1u << 31) - 8, 0xfffffff0u, 0xfffffffcu};
  const std::vector<SamplePlan> plans = {{1, 1, 1},           {1, 16384, 2},    {3, 5, 7},
                                         {512, 512, 16},      {512, 300, 1000}, {16384, 16384, 256},
                                         {16384, 2, 1u << 24}};
  const std::vector<std::uint32_t> pixels = {0, 1, 2, 511, 16383, (1u << 20) + 3, (1u << 28) - 1};
  const std::vector<int> pairs = {0, 1, 2, 15, 16, 511, 512, 1023, 4095};
  const std::vector<std::uint32_t> seeds = {0, 1, 0x80000000u, 0xffffffffu};
  std::size_t turn = 0;
  for (const std::string& text : all_samplers()) {
    for (const float weight : {0.0f, 1e-7f, 1.0f / 64, 0.125f, 0.5f, below_one, 1.0f}) {
      for (const std::uint32_t from : first) {
        const SamplePlan plan = plans[turn % plans.size()];
        SamplerState state = state_of(text, seeds[turn % seeds.size()], plan);
        state.weight = weight;
        turn += 1;
        const std::uint32_t pixel = pixels[turn / 5 % pixels.size()];
        const int pair = pairs[turn / 3 % pairs.size()];
        SCOPED_TRACE(text + " w " + std::to_string(weight) + " from " + std::to_string(from) +
                     " pixel " + std::to_string(pixel) + " pair " + std::to_string(pair) +
                     " planned " + std::to_string(plan.samples));
        expect_in_unit_interval(
            draw(state, pixel, pair, from, std::min(16u, 0xffffffffu - from + 1u)));
        if (HasFatalFailure()) return;
      }
    }
  }
}

// Keys ------------------------------------------------------------------------------------------

TEST(Samplers, SeedsPixelsPairsAndSamplesAllCount) {
  const SamplePlan plan{64, 64, 64};
  for (const std::string& text : all_samplers()) {
    const SamplerState state = state_of(text, 7, plan);
    const Values base = draw(state, 12, 1, 0, 64);
    EXPECT_NE(draw(state_of(text, 8, plan), 12, 1, 0, 64), base) << text;
    EXPECT_NE(draw(state, 12, 2, 0, 64), base) << text;
    EXPECT_NE(draw(state, 12, 1, 64, 64), base) << text;
    EXPECT_NE(base.u, base.v) << text;
    const bool moved = state.perturbation != PerturbationId{};
    EXPECT_EQ(draw(state, 13, 1, 0, 64) != base, moved || state.share == Share::Pixel) << text;
    EXPECT_EQ(draw(state, 17, 1, 0, 64) != base, moved || state.share != Share::Image) << text;
  }
}

TEST(Samplers, PairsFromTheLastSharedOnAreThePixelsOwn) {
  for (const std::string& sequence : sequence_names()) {
    const SamplePlan plan{64, 64, 16};
    const SamplerState own = state_of(sequence, 7, plan);
    const SamplerState shared = state_of(sequence + ":share=image,pairs=3", 7, plan);
    for (const std::uint32_t pixel : {0u, 99u}) {
      EXPECT_EQ(draw(shared, pixel, 3, 0, 64), draw(own, pixel, 3, 0, 64)) << sequence;
      EXPECT_EQ(draw(shared, pixel, 9, 0, 64), draw(own, pixel, 9, 0, 64)) << sequence;
      EXPECT_NE(draw(shared, pixel, 2, 0, 64), draw(own, pixel, 2, 0, 64)) << sequence;
    }
    EXPECT_EQ(draw(shared, 0, 2, 0, 64), draw(shared, 99, 2, 0, 64)) << sequence;
  }
}

TEST(Samplers, InterleavedPixelsShareAcrossTheirStride) {
  for (const std::string& sequence : sequence_names()) {
    for (const char* share : {"tile", "image"}) {
      const SamplerState one = state_of(sequence + ":share=" + share, 7, {64, 64, 16});
      for (const int n : {2, 4}) {
        SamplerState state = one;
        state.interleave = n;
        std::set<std::vector<float>> groups;
        for (std::uint32_t y = 0; y < 8; ++y) {
          for (std::uint32_t x = 0; x < 8; ++x) {
            groups.insert(draw(state, y * 64 + x, 1, 0, 16).u);
            const std::uint32_t base = y % std::uint32_t(n) * 64 + x % std::uint32_t(n);
            ASSERT_EQ(draw(state, y * 64 + x, 1, 0, 16), draw(state, base, 1, 0, 16)) << sequence;
          }
        }
        EXPECT_EQ(int(groups.size()), n * n) << sequence;
        EXPECT_EQ(draw(state, 0, 1, 0, 16), draw(one, 0, 1, 0, 16)) << sequence;
      }
    }
  }
}

TEST(PermutedIndex, IsAPermutationOfEveryRange) {
  std::vector<std::uint32_t> counts(200);
  std::iota(counts.begin(), counts.end(), 1u);
  for (const std::uint32_t more : {255u, 256u, 257u, 1000u, 4096u, 65535u, 65536u}) {
    counts.push_back(more);
  }
  for (const std::uint32_t count : counts) {
    for (const std::uint32_t key : {0u, 1u, 0x9e3779b9u, 0xffffffffu}) {
      std::vector<bool> taken(count, false);
      for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint32_t place = permuted_index(i, count, key);
        ASSERT_LT(place, count);
        ASSERT_FALSE(taken[place]) << count << ' ' << key;
        taken[place] = true;
      }
    }
  }
}

// Lanes behind the last path hold any index, and must come to an end too.
TEST(PermutedIndex, PutsIndicesFromOutsideInside) {
  for (std::uint32_t count = 1; count < 70; ++count) {
    for (std::uint32_t key = 0; key < 64; ++key) {
      for (const std::uint32_t i : {count, count + 1, 2 * count, 63u, 127u, 0xffffffffu}) {
        ASSERT_LT(permuted_index(i, count, pcg3d(key, count, 3u).x), count);
      }
    }
  }
}

// Every index comes to every place equally often, or nearly: its hash is no perfect shuffle.
TEST(PermutedIndex, PutsEveryIndexEverywhere) {
  for (const std::uint32_t count : {5u, 12u, 16u, 64u}) {
    const std::uint32_t keys = 1024 * count;
    std::vector<std::uint32_t> places(count * count);
    for (std::uint32_t k = 0; k < keys; ++k) {
      const std::uint32_t key = pcg3d(k, count, 7u).x;
      for (std::uint32_t i = 0; i < count; ++i) {
        ++places[i * count + permuted_index(i, count, key)];
      }
    }
    const auto [low, high] = std::minmax_element(places.begin(), places.end());
    EXPECT_GT(*low, 1024u - 300u) << count;
    EXPECT_LT(*high, 1024u + 300u) << count;
  }
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
  EXPECT_LT(*pairs.rbegin(), max_pairs);
}

// Uniformity and independence -------------------------------------------------------------------

// p-values that are judged together.
class Tests {
 public:
  void add(std::string what, double p) { all_.emplace_back(std::move(what), p); }
  ~Tests() {
    for (const auto& [what, p] : all_) {
      EXPECT_GT(p, sidak(significance, double(all_.size()))) << what << " of " << all_.size();
    }
  }

 private:
  std::vector<std::pair<std::string, double>> all_;
};

// Over seeds every single point is uniform, and points of two pairs are independent, whatever is
// shared and however pixels leave it: what makes samplers unbiased.
TEST(Samplers, EachPathIsUniformOverSeeds) {
  Tests tests;
  for (const std::string& text : all_samplers()) {
    for (const float weight : {1.0f, 1.0f / 64, 0.3f}) {
      SamplerState state = state_of(text, 0, {20, 20, 12});
      state.weight = weight;
      Values one, two;
      for (std::uint32_t seed = 0; seed < 2048; ++seed) {
        state.seed = pcg3d(seed, 0u, 0x1ec5u).x;  // as renders have them
        one.append(draw(state, 399, 1, 5, 1));
        two.append(draw(state, 399, 3, 5, 1));
      }
      tests.add(text + ": u", evenness_of(one.u, 64));
      tests.add(text + ": v", evenness_of(one.v, 64));
      tests.add(text + ": u and v", joint_evenness(one.u, one.v, 8));
      tests.add(text + ": pairs", joint_evenness(one.u, two.u, 16));
      tests.add(text + ": pairs, crossed", joint_evenness(one.v, two.u, 16));
      if (state.perturbation == PerturbationId{}) break;
    }
  }
}

// Those whose pixels are to be independent, with one sample of each in an image of this side.
constexpr int side = 128;

std::vector<std::string> independent_samplers() {
  std::vector<std::string> all;
  for (const std::string& sequence : sequence_names()) {
    if (sequence != "zsobol") all.push_back(sequence);  // neighbours avoid each other
    for (const char* offset : {"fresh", "constant"}) {
      for (const char* mix : {"add", "xor"}) {
        all.push_back(sequence + ":share=image,offset=" + offset + ",mix=" + mix);
      }
    }
  }
  return all;
}

// Every second value along x or y, and what follows it there.
std::pair<std::vector<float>, std::vector<float>> neighbours(const std::vector<float>& image,
                                                             int dx, int dy) {
  std::vector<float> a, b;
  for (int y = 0; y + dy < side; y += 1 + dy) {
    for (int x = 0; x + dx < side; x += 1 + dx) {
      a.push_back(image[std::size_t(y * side + x)]);
      b.push_back(image[std::size_t((y + dy) * side + x + dx)]);
    }
  }
  return {a, b};
}

TEST(Samplers, PixelsPairsAndBouncesAreIndependentWhereTheyShouldBe) {
  Tests tests;
  for (const std::string& text : independent_samplers()) {
    const SamplerState state = state_of(text, 11, {side, side, 16});
    for (const std::uint32_t sample : {0u, 6u}) {
      const Values pixel = draw_image(state, pixel_pair, sample);
      const Values light = draw_image(state, sample_pair(0, Purpose::Light), sample);
      const Values bsdf = draw_image(state, sample_pair(0, Purpose::Bsdf), sample);
      const Values next = draw_image(state, sample_pair(1, Purpose::Light), sample);
      for (const Values* pair : {&pixel, &light, &bsdf, &next}) {
        tests.add(text + ": u and v", joint_evenness(pair->u, pair->v, 16));
      }
      tests.add(text + ": pixel and light", joint_evenness(pixel.u, light.u, 16));
      tests.add(text + ": light and bsdf", joint_evenness(light.u, bsdf.u, 16));
      tests.add(text + ": light and bsdf, crossed", joint_evenness(light.u, bsdf.v, 16));
      tests.add(text + ": bounces", joint_evenness(light.v, next.v, 16));
      for (const auto& [dx, dy] : {std::pair{1, 0}, {0, 1}, {1, 1}}) {
        const auto [a, b] = neighbours(light.u, dx, dy);
        tests.add(text + ": neighbours", joint_evenness(a, b, 16));
      }
    }
    if (text != "random" && text.find("fresh") == std::string::npos) continue;
    const Values here = draw_image(state, 1, 3), there = draw_image(state, 1, 4);
    tests.add(text + ": samples", joint_evenness(here.u, there.u, 16));
  }
}

// The opposites of the test above, so that it is known to notice. By design neighbours depend on
// each other where offsets are stratified over them, and where pixels share.
TEST(Samplers, NeighboursDependOnEachOtherWhereTheyShould) {
  for (const char* text : {"zsobol", "bluenoise", "strata", "rcs:weight=0.3", "owen:share=tile",
                           "owen:share=image,offset=morton"}) {
    const SamplerState state = state_of(text, 11, {side, side, 1});
    const auto [a, b] = neighbours(draw_image(state, 1, 0).u, 1, 0);
    EXPECT_LT(joint_evenness(a, b, 16), 1e-9) << text;
  }
}

// Correlation of two equally long series, as a standard normal under independence.
double correlation_z(const std::vector<float>& a, const std::vector<float>& b) {
  Moments ma, mb;
  for (const float x : a) ma.add(double(x));
  for (const float x : b) mb.add(double(x));
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    sum += (double(a[i]) - ma.mean) * (double(b[i]) - mb.mean);
  }
  return sum / std::sqrt(ma.squares * mb.squares) * std::sqrt(double(a.size()));
}

// Over the samples of a pixel. By design two pixels have the same points, each scrambled or shifted
// in its own way, where the order is the sequence's; and pairs belong together in Halton's and
// Sobol's sequence.
TEST(Samplers, SeriesOfAPixelAreUncorrelated) {
  constexpr std::uint32_t count = 4096;
  const std::set<std::string> one_order{"sobol", "pmj02", "halton", "linked"};
  const std::set<std::string> one_sequence{"sobol", "halton"};
  Tests tests;
  for (const std::string& text : sequence_names()) {
    const auto series = [&](std::uint32_t seed, std::uint32_t pixel, int pair) {
      return draw(state_of(text, seed, {512, 512, count}), pixel, pair, 0, count);
    };
    const auto add = [&](const char* what, const Values& a, const Values& b) {
      tests.add(text + what, normal_tail(correlation_z(a.u, b.u)));
      tests.add(text + what, normal_tail(correlation_z(a.u, b.v)));
    };
    const Values base = series(7, 100, 2);
    tests.add(text + ": u and v", normal_tail(correlation_z(base.u, base.v)));
    if (!one_order.contains(text)) {
      for (const std::uint32_t seed : {6u, 8u, 1u << 31})
        add(": seeds", base, series(seed, 100, 2));
      for (const std::uint32_t p : {101u, 102u, 228u, 612u}) add(": pixels", base, series(7, p, 2));
    }
    if (!one_sequence.contains(text)) {
      for (const int pair : {0, 1, 3, 4, 6, 18, 100}) add(": pairs", base, series(7, 100, pair));
    }
  }
}

}  // namespace
}  // namespace lockstep::test_samplers
