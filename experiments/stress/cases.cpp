// All cases of the battery, family by family.
#include "experiments/stress/parts.h"

#include <iterator>

namespace lockstep {

std::vector<StressCase> stress_cases() {
  std::vector<StressCase> all;
  for (const auto& family : {stress::scale_cases, stress::light_cases, stress::material_cases,
                             stress::sampling_cases, stress::stiff_cases}) {
    std::vector<StressCase> cases = family();
    all.insert(all.end(), std::make_move_iterator(cases.begin()),
               std::make_move_iterator(cases.end()));
  }
  return all;
}

}  // namespace lockstep
