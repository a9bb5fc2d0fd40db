// The named samplers.
#pragma once

#include "samplers/sampler_spec.h"
#include "samplers/sequence_info.h"

#include <string_view>
#include <vector>

namespace lockstep {

struct Preset {
  std::string_view summary, paper;
  SamplerSpec spec;
};

// One for each sequence, every pixel having its own, then the methods that share one.
const std::vector<Preset>& presets();

// A sampler composed of what there is. Throws Error where its name is taken, or is not of
// lower-case letters, digits, - and _. For programs that build on the library, before they use any
// sampler.
void add_preset(const Preset& preset);

// What each pixel's own sequence is as a sampler.
Preset preset_of(const SequenceInfo& sequence);

// Throws UsageError naming the valid choices.
const Preset& find_preset(std::string_view name);

}  // namespace lockstep
