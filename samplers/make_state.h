// From a sampler's specification to what kernels read.
#pragma once

#include "samplers/sampler_state.h"

namespace lockstep {

// Without a weight map, which is the caller's to make and set.
SamplerState make_state(const SamplerSpec& spec, std::uint32_t seed);

}  // namespace lockstep
