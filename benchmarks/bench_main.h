// What every benchmark program's main does.
#pragma once

#include <benchmark/benchmark.h>

#include <string>
#include <vector>

namespace lockstep {

// Runs what `register_all` registers; gives the exit status. Counters come as columns unless the
// command line, which is read later, says otherwise.
template <class Register>
int run_benchmarks(int argc, char** argv, Register register_all) {
  std::string tabular = "--benchmark_counters_tabular=true";
  std::vector<char*> arguments(argv, argv + argc);
  arguments.insert(arguments.begin() + 1, tabular.data());
  int count = int(arguments.size());
  arguments.push_back(nullptr);
  benchmark::Initialize(&count, arguments.data());
  if (benchmark::ReportUnrecognizedArguments(count, arguments.data())) return 2;
  register_all();
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}

}  // namespace lockstep
