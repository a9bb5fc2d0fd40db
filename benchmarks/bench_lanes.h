// Loops over arrays that stay in the first-level cache, a packet at a time: the throughput of
// header code by width. Programs that use it are compiled for the machine that builds them.
#pragma once

#include "core/hash.h"

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <string>
#include <type_traits>

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

inline constexpr std::uint32_t seed = 1;
inline constexpr int lane_count = 1024;

using FloatLanes = float[lane_count + 16];
using IntLanes = std::int32_t[lane_count + 16];
using UIntLanes = std::uint32_t[lane_count + 16];

constexpr const char* compiled_isa = native_lanes == 16  ? "avx512"
                                     : native_lanes == 8 ? "avx2"
#if defined(__aarch64__)
                                                         : "neon";
#else
                                                         : "sse4";
#endif

// Input values in [0, 1), independent for every purpose.
inline float uniform(int i, std::uint32_t purpose) {
  return unit_float(pcg3d(std::uint32_t(i), purpose, seed).x);
}

// Calls op.run<W>(data, i) for packets i, i + W, ...; the counter is the time per lane.
template <class Op, int W, class Data>
void run_lanes(benchmark::State& loop, Data* data) {
  for (auto _ : loop) {
    Op op;
    for (int i = 0; i < lane_count; i += W) op.template run<W>(*data, i);
    benchmark::ClobberMemory();
  }
  loop.counters["per_lane"] = benchmark::Counter(
      lane_count, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

template <class Op, class Data>
void register_widths(const std::string& name, Data* data) {
  const auto add = [&]<int W>(std::integral_constant<int, W>) {
    const std::string label = fmt::format("{}/{}/width:{}/seed:{}", name, compiled_isa, W, seed);
    benchmark::RegisterBenchmark(label.c_str(), run_lanes<Op, W, Data>, data)->MinTime(0.1);
  };
  add(std::integral_constant<int, 1>());
  add(std::integral_constant<int, 4>());
  add(std::integral_constant<int, 8>());
  add(std::integral_constant<int, 16>());
}

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
