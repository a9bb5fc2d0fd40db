// Instruction sets that kernels are compiled for, and the choice among them at start.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace lockstep {

enum class Isa { Sse4, Avx2, Avx512, Neon };
inline constexpr Isa all_isas[] = {Isa::Sse4, Isa::Avx2, Isa::Avx512, Isa::Neon};

constexpr std::string_view name(Isa isa) {
  constexpr std::string_view names[] = {"sse4", "avx2", "avx512", "neon"};
  return names[int(isa)];
}

bool is_compiled(Isa isa);  // kernels for it are in this build
bool cpu_runs(Isa isa);

// Instruction sets that were compiled in and this CPU runs, narrowest first.
std::vector<Isa> available_isas();

// "auto" (the environment variable LOCKSTEP_ISA if set, else the widest available) or a name.
// Throws UsageError for an unknown name, Error where this CPU cannot run it.
Isa choose_isa(std::string_view text = "auto");

// Embree's name of the instruction set, for Scene's constructor; none for neon, the only one that
// Embree has for ARM.
std::string embree_isa(Isa isa);

// Lanes that --width auto stands for: the packet width measured fastest on that instruction set.
int default_width(Isa isa);

}  // namespace lockstep
