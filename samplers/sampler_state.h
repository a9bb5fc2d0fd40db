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

// The paths that a batch of values is for. `path[i]` indexes the two arrays; a path is one sample
// of one pixel, with sample numbers in [first_sample, first_sample + samples). Arrays may be read
// up to a full packet past `count`.
struct SampleBatch {
  const std::int32_t* path = nullptr;
  int count = 0;
  const std::uint32_t* pixel = nullptr;  // y * width + x
  const std::uint32_t* sample = nullptr;
  std::uint32_t first_sample = 0;
  int samples = 1;
};

inline constexpr int max_samples_per_batch = 256;

}  // namespace lockstep
