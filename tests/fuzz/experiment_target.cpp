// Experiment files: what is read can be written, and read again gives the same.
#include "experiments/compare/experiment_file.h"
#include "tests/fuzz/fuzz_target.h"
#include "tests/fuzz/own_errors.h"
#include "tests/fuzz/playground.h"

#include <string>
#include <vector>

namespace lockstep::fuzz {
namespace {

void check_experiment(const Playground& playground, const std::string& path) {
  const std::vector<ExperimentEntry> entries = read_experiment(path);
  const std::string text = experiment_text(entries);
  const auto again = read_experiment(playground.write("again.toml", text.data(), text.size()));
  require(again.size() == entries.size(), "keys are lost: " + text);
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const ExperimentEntry &a = entries[i], &b = again[i];
    require(a.values.size() == b.values.size(), "values are lost: " + text);
    require(a.key->kind != ValueKind::Text || a.key != b.key || a.values == b.values,
            "text differs: " + text);
  }
}

}  // namespace
}  // namespace lockstep::fuzz

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace lockstep::fuzz;
  static const Playground playground;
  const std::string path = playground.write("input.toml", data, size);
  expect_own_errors("experiment", [&] { check_experiment(playground, path); });
  return 0;
}
