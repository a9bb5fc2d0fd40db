#include "core/error.h"
#include "packets/kernel.h"

#include "compiled_kernels.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <string>

namespace lockstep {

#define LOCKSTEP_KERNELS_OF(isa, apply)                                                            \
  apply(kernel_##isa##_1) apply(kernel_##isa##_4) apply(kernel_##isa##_8) apply(kernel_##isa##_16) \
      apply(kernel_##isa##_quad_lit) apply(kernel_##isa##_sky_lit) apply(kernel_##isa##_interior)
#define LOCKSTEP_DECLARE(kernel) extern const Kernel kernel;
LOCKSTEP_KERNELS(LOCKSTEP_DECLARE)
#undef LOCKSTEP_DECLARE

namespace {

constexpr const Kernel* kernels[] = {
#define LOCKSTEP_ADDRESS(kernel) &kernel,
    LOCKSTEP_KERNELS(LOCKSTEP_ADDRESS)
#undef LOCKSTEP_ADDRESS
};

std::string available_names() {
  std::string names;
  for (const Isa isa : available_isas()) names += fmt::format(" {}", name(isa));
  return names;
}

}  // namespace

bool is_compiled(Isa isa) {
  return std::any_of(std::begin(kernels), std::end(kernels),
                     [&](const Kernel* kernel) { return kernel->isa == isa; });
}

#if defined(__x86_64__)
bool cpu_runs(Isa isa) {
  __builtin_cpu_init();
  switch (isa) {
    case Isa::Sse4:
      return __builtin_cpu_supports("sse4.2");
    case Isa::Avx2:
      return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
    case Isa::Avx512:
      return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
             __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw");
    case Isa::Neon:
      return false;
  }
  return false;
}
#else
bool cpu_runs(Isa isa) { return isa == Isa::Neon; }  // part of every 64-bit ARM
#endif

std::vector<Isa> available_isas() {
  std::vector<Isa> result;
  for (const Isa isa : all_isas) {
    if (is_compiled(isa) && cpu_runs(isa)) result.push_back(isa);
  }
  if (result.empty()) {
    throw Error("this CPU runs none of the instruction sets that this build has kernels for");
  }
  return result;
}

Isa choose_isa(std::string_view text) {
  std::string_view from;
  if (text == "auto") {
    const char* forced = std::getenv("LOCKSTEP_ISA");
    if (!forced || !*forced) return available_isas().back();
    text = forced;
    from = " (from the environment variable LOCKSTEP_ISA)";
  }
  for (const Isa isa : all_isas) {
    if (name(isa) != text) continue;
    if (is_compiled(isa) && cpu_runs(isa)) return isa;
    throw Error(fmt::format("{} {}{}; available are:{}",
                            is_compiled(isa) ? "this CPU does not run" : "this build lacks", text,
                            from, available_names()));
  }
  throw UsageError(fmt::format(
      "unknown instruction set '{}'{}; choose from auto, sse4, avx2, avx512, neon", text, from));
}

std::string embree_isa(Isa isa) {
  return isa == Isa::Sse4 ? "sse4.2" : isa == Isa::Neon ? "" : std::string(name(isa));
}

int default_width(Isa isa) { return isa == Isa::Avx512 ? 16 : isa == Isa::Avx2 ? 8 : 4; }

const Kernel& find_kernel(Isa isa, int width, FeatureMask features) {
  const int wanted = width == 0 ? default_width(isa) : width;
  const Kernel* best = nullptr;
  for (const Kernel* kernel : kernels) {
    if (kernel->isa != isa || kernel->width != wanted || (features & ~kernel->features)) continue;
    if (!best || std::popcount(kernel->features) < std::popcount(best->features)) best = kernel;
  }
  if (best) return *best;
  throw UsageError(fmt::format("no kernel of width {}; choose from auto, 1, 4, 8, 16", width));
}

}  // namespace lockstep
