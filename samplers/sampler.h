// Sample values for batches of paths: a pure function of (seed, pixel, sample, pair), evaluated a
// packet at a time. A sampler is a sequence, a perturbation and a weight; see sampler_spec.h.
#pragma once

#include "core/simd.h"
#include "samplers/sampler_state.h"

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

// Writes the pair's values, in [0, 1), for the batch's paths to u[0..count) and v[0..count), W at a
// time: the arrays hold a full packet more. For W = 1, 4, 8 and 16.
template <int W>
void fill_pair(const SamplerState& state, const SampleBatch& batch, int pair, float* u, float* v);

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
