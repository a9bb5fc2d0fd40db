// The named samplers.
#pragma once

#include "samplers/sampler_spec.h"

#include <string_view>
#include <vector>

namespace lockstep {

struct Preset {
  std::string_view summary, paper;
  SamplerSpec spec;
};

// One for each sequence, every pixel having its own, then the methods that share one.
const std::vector<Preset>& presets();

// Throws UsageError naming the valid choices.
const Preset& find_preset(std::string_view name);

}  // namespace lockstep
