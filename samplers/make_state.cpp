#include "samplers/make_state.h"

namespace lockstep {

SamplerState make_state(const SamplerSpec& spec, std::uint32_t seed) {
  SamplerState state;
  state.seed = seed;
  state.shared = spec.shared;
  state.sequence = spec.sequence;
  state.perturbation = spec.perturbation;
  state.weight = spec.perturbation == Perturbation::None ? 0.0f : spec.weight;
  return state;
}

}  // namespace lockstep
