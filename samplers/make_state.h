// From a sampler's specification to what kernels read.
#pragma once

#include "samplers/sampler_spec.h"
#include "samplers/sampler_state.h"

namespace lockstep {

// What a sampler is to fill: the image, and how many samples each pixel will get as far as is
// known.
struct SamplePlan {
  int width = 1;
  int height = 1;
  std::uint32_t samples = 16;
};

// `weights` stay unset: maps are the caller's. Makes the tables that the sampler needs.
SamplerState make_state(const SamplerSpec& spec, std::uint32_t seed, const SamplePlan& plan = {});

}  // namespace lockstep
