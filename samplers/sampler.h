// Sample values for batches of paths: a pure function of (seed, pixel, sample, pair), evaluated a
// packet at a time. A sampler is a sequence, a perturbation and a weight; see sampler_spec.h.
#pragma once

#include "samplers/sampler_state.h"
#include "samplers/sobol.h"

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

// Keys of streams that must be independent of each other, though pixel, sample and pair agree.
enum class Stream : std::uint32_t { Sequence = 0x5e9u, Offset = 0x0ff5e7u };

// u_{i,k} of an independent sequence: x and y of a hash of all that it is for.
template <class U>
LOCKSTEP_INLINE Vec2<FloatOf<U>> random_point(U pixel, U sample, int pair, std::uint32_t seed,
                                              Stream stream) {
  const U purpose(std::uint32_t(pair) | std::uint32_t(stream) << 12);
  const Hash4<U> h = pcg4d(pixel, sample, purpose, U(seed));
  return {unit_float(h.x), unit_float(h.y)};
}

// Point `sample` of the sequence of `pixel`. The shared sequence is that of pixel 2^32 - 1.
template <class U>
LOCKSTEP_INLINE Vec2<FloatOf<U>> sequence_point(Sequence sequence, U pixel, U sample, int pair,
                                                std::uint32_t seed) {
  if (sequence == Sequence::Random) {
    return random_point(pixel, sample, pair, seed, Stream::Sequence);
  }
  const Hash4<U> keys = pcg4d(pixel, U(std::uint32_t(pair)), U(seed), U(0x50b01u));
  return owen_sobol(sample, Hash3<U>{keys.x, keys.y, keys.z});
}

inline constexpr std::uint32_t shared_pixel = 0xffffffffu;

// (u_k + w u_{i,k}) mod 1, in [0, 1): rounding may give 1 exactly, which is not a valid sample.
template <class V>
LOCKSTEP_INLINE V perturb(V shared, V weight, V offset) {
  const V x = fma(weight, offset, shared);
  return min(x - floor(x), V(one_minus_epsilon));
}

// Writes the pair's values for the batch's paths to u[0..count) and v[0..count).
template <int W>
LOCKSTEP_INLINE void fill_own_sequence(const SamplerState& state, const SampleBatch& batch,
                                       int pair, float* u, float* v) {
  for (int i = 0; i < batch.count; i += W) {
    const auto point = sequence_point(state.sequence, load<UInt<W>>(batch.pixel + i),
                                      load<UInt<W>>(batch.sample + i), pair, state.seed);
    store(u + i, point.x);
    store(v + i, point.y);
  }
}

template <int W>
LOCKSTEP_INLINE void fill_shared_sequence(const SamplerState& state, const SampleBatch& batch,
                                          int pair, float* u, float* v) {
  using V = Float<W>;
  float shared_u[max_samples_per_batch], shared_v[max_samples_per_batch];
  for (int k = 0; k < batch.samples; ++k) {
    const auto point = sequence_point(state.sequence, shared_pixel,
                                      batch.first_sample + std::uint32_t(k), pair, state.seed);
    shared_u[k] = point.x;
    shared_v[k] = point.y;
  }
  const bool perturbed = state.perturbation != Perturbation::None;
  const bool fresh = state.perturbation == Perturbation::Fresh;
  for (int i = 0; i < batch.count; i += W) {
    const UInt<W> sample = load<UInt<W>>(batch.sample + i);
    // Lanes behind the last path may hold anything.
    const Int<W> k =
        as_int(sample - UInt<W>(batch.first_sample)) & Int<W>(max_samples_per_batch - 1);
    Vec2<V> point(gather(shared_u, k), gather(shared_v, k));
    if (perturbed) {
      const UInt<W> pixel = load<UInt<W>>(batch.pixel + i);
      const V w = state.weights ? gather(state.weights, as_int(pixel)) : V(state.weight);
      if (any(w > V(0.0f))) {
        const auto offset =
            random_point(pixel, fresh ? sample : UInt<W>(0u), pair, state.seed, Stream::Offset);
        point = {perturb(point.x, w, offset.x), perturb(point.y, w, offset.y)};
      }
    }
    store(u + i, point.x);
    store(v + i, point.y);
  }
}

template <int W>
void fill_pair(const SamplerState& state, const SampleBatch& batch, int pair, float* u, float* v) {
  if (state.shared) {
    fill_shared_sequence<W>(state, batch, pair, u, v);
  } else {
    fill_own_sequence<W>(state, batch, pair, u, v);
  }
}

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
