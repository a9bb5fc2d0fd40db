// Readers of measured reflectance. Which of them it is, LOCKSTEP_FUZZ_FORMAT says when this is
// compiled.

#include "core/measured_file.h"
#include "tests/fuzz/fuzz_target.h"
#include "tests/fuzz/own_errors.h"
#include "tests/fuzz/playground.h"

#include <cmath>

namespace lockstep::fuzz {
namespace {

// Each is named as LOCKSTEP_FUZZ_FORMAT has it; a target uses one of them.
[[maybe_unused]] constexpr const char* brdf = "input.brdf";
[[maybe_unused]] constexpr const char* bsdf = "input.bsdf";

void read_and_check(const std::string& path) {
  const MeasuredFile file = read_measured_file(path);
  if (!file.warning.empty()) check_message(LOCKSTEP_FUZZ_FORMAT, file.warning);
  for (const float value : file.table.values) {
    require(std::isfinite(value) && value >= 0.0f, "a table holds no reflectance");
  }
}

}  // namespace
}  // namespace lockstep::fuzz

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace lockstep::fuzz;
  static const Playground playground;
  const std::string path = playground.write(LOCKSTEP_FUZZ_FORMAT, data, size);
  expect_own_errors(LOCKSTEP_FUZZ_FORMAT, [&] { read_and_check(path); });
  return 0;
}
