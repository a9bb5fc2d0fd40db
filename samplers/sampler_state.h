// A sampler as kernels see it: plain data, the same for every instruction set and width.
#pragma once

#include "samplers/sampler_spec.h"

#include <cstdint>

namespace lockstep {

struct SamplerState {
  std::uint32_t seed = 0;
  bool shared = false;
  Sequence sequence = Sequence::Random;
  Perturbation perturbation = Perturbation::None;
  float weight = 1.0f;             // w where there is no map
  const float* weights = nullptr;  // w per pixel, row by row
};

// What a batch of values is for: samples of pixels (y * width + x), with sample numbers in
// [first_sample, first_sample + samples). Arrays may be read up to a full packet past `count`.
struct SampleBatch {
  const std::uint32_t* pixel = nullptr;
  const std::uint32_t* sample = nullptr;
  int count = 0;
  std::uint32_t first_sample = 0;
  int samples = 1;
};

inline constexpr int max_samples_per_batch = 256;

}  // namespace lockstep
