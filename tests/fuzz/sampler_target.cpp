// Samplers as the command line names them: a list is split, each sampler is parsed, its text names
// the same sampler, and the values that it gives lie in [0, 1).
#include "samplers/make_state.h"
#include "samplers/sampler.h"
#include "tests/fuzz/fuzz_target.h"
#include "tests/fuzz/mutate.h"
#include "tests/fuzz/own_errors.h"

#include <algorithm>
#include <string>
#include <vector>

namespace lockstep::fuzz {
namespace {

void check_values(const SamplerSpec& spec, Random& random) {
  constexpr int count = 8, side = 512;
  constexpr int pairs = 4096;
  const SamplePlan plan{1 + int(random.below(side)), 1 + int(random.below(side)),
                        1 + std::uint32_t(random.below(1 << 12))};
  const SamplerState state = make_state(spec, std::uint32_t(random.next()), plan);
  const std::size_t pixels = std::size_t(plan.width) * std::size_t(plan.height);
  std::vector<std::uint32_t> pixel(2 * count, std::uint32_t(random.below(pixels)));
  std::vector<std::uint32_t> sample(2 * count);
  SampleBatch batch;
  batch.pixel = pixel.data(), batch.sample = sample.data();
  batch.count = count, batch.samples = count;
  batch.first_sample = std::uint32_t(random.below(plan.samples));
  for (int i = 0; i < count; ++i) sample[std::size_t(i)] = batch.first_sample + std::uint32_t(i);
  std::vector<float> u(2 * count), v(2 * count);
  fill_pair<1>(state, batch, int(random.below(pairs)), u.data(), v.data());
  for (std::size_t i = 0; i < count; ++i) {
    require(u[i] >= 0.0f && u[i] < 1.0f && v[i] >= 0.0f && v[i] < 1.0f,
            to_string(spec) + ": a value is outside [0, 1)");
  }
}

void check_sampler(const std::string& text, Random& random) {
  const SamplerSpec spec = parse_sampler(text);
  const std::string canonical = to_string(spec);
  require(to_string(parse_sampler(canonical)) == canonical, canonical + " is another sampler");
  check_values(spec, random);
}

}  // namespace
}  // namespace lockstep::fuzz

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace lockstep;
  const std::string text = fuzz::typed(data, size);
  fuzz::Random random(size + (size > 0 ? data[0] : 0u));
  std::vector<std::string> samplers = split_sampler_list(text);
  constexpr std::size_t most = 64;  // of a list of thousands
  samplers.resize(std::min(samplers.size(), most));
  for (const std::string& sampler : samplers) {
    fuzz::expect_own_errors("sampler", [&] { fuzz::check_sampler(sampler, random); });
  }
  return 0;
}
