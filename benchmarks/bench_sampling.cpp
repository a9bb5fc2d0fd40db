// Cost of sample values: nanoseconds of CPU time per value, by sampler, instruction set and width.
// One batch is what the path integrator asks for: 256 pixels of a tile, four samples of each.
#include "bench_main.h"
#include "packets/kernel.h"
#include "samplers/make_state.h"

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <vector>

namespace lockstep {
namespace {

constexpr std::uint32_t seed = 1;
constexpr int pixels = 256, samples = 4, count = pixels * samples;

void sample(benchmark::State& loop, const Kernel& kernel, const std::string& text) {
  std::vector<std::uint32_t> pixel(count + 16), number(count + 16);
  for (int i = 0; i < count; ++i) {
    pixel[size_t(i)] = std::uint32_t(i % pixels);
    number[size_t(i)] = std::uint32_t(i / pixels);
  }
  std::vector<float> u(count + 16), v(count + 16);
  const SamplerState state = make_state(parse_sampler(text), seed, {16, 16, 64});
  const SampleBatch batch{pixel.data(), number.data(), count, 0, samples};
  int pair = 0;
  for (auto _ : loop) {
    kernel.fill_pair(state, batch, pair++ & 31, u.data(), v.data());
    benchmark::ClobberMemory();
  }
  loop.counters["per_value"] = benchmark::Counter(
      2.0 * count, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void register_all() {
  std::vector<std::string> texts = sampler_names();
  std::erase(texts, "rcs");  // a map is the image's
  for (const char* offset : {"fresh", "constant"}) {
    texts.push_back(fmt::format("rcs:weight=0.3,offset={}", offset));
  }
  for (const Isa isa : available_isas()) {
    for (const std::string& text : texts) {
      for (const int width : {1, 4, 8, 16}) {
        const std::string label =
            fmt::format("sampling/{}/{}/width:{}/seed:{}", text, name(isa), width, seed);
        benchmark::RegisterBenchmark(label.c_str(), sample, find_kernel(isa, width), text)
            ->MinTime(0.1);
      }
    }
  }
}

}  // namespace
}  // namespace lockstep

int main(int argc, char** argv) {
  return lockstep::run_benchmarks(argc, argv, lockstep::register_all);
}
