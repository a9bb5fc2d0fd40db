// run_with_isa ISA PROGRAM [ARGUMENT...]: runs a test program where this CPU has its instruction
// set, else exits with 77, which CTest reports as skipped. Not compiled for any instruction set
// itself: a test program might use one before its main() is reached.
#include <unistd.h>

#include <cstdio>
#include <string_view>

namespace {

bool cpu_has(std::string_view isa) {
  if (isa == "sse4") return __builtin_cpu_supports("sse4.2");
  if (isa == "avx2") {
    return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
           __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2");
  }
  return isa == "avx512" && __builtin_cpu_supports("avx512f") &&
         __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512cd") &&
         __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
}

}  // namespace

int main(int count, char** arguments) {
  if (count < 3) {
    std::fprintf(stderr, "usage: run_with_isa sse4|avx2|avx512 PROGRAM [ARGUMENT...]\n");
    return 2;
  }
  if (!cpu_has(arguments[1])) {
    std::printf("skipped: this CPU has no %s\n", arguments[1]);
    return 77;
  }
  execv(arguments[2], arguments + 2);
  std::perror(arguments[2]);
  return 1;
}
