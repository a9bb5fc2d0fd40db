// Samplers as kernels see them, for benchmarks that call kernels directly.
#pragma once

#include "samplers/sampler_state.h"

#include <string_view>

namespace lockstep {

// For samplers with a constant weight.
inline SamplerState sampler_state(std::string_view text, std::uint32_t seed) {
  const SamplerSpec spec = parse_sampler(text);
  SamplerState state;
  state.seed = seed;
  state.shared = spec.shared;
  state.sequence = spec.sequence;
  state.perturbation = spec.perturbation;
  state.weight = spec.weight;
  return state;
}

}  // namespace lockstep
