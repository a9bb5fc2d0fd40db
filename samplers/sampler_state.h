// A sampler as kernels see it: plain data, the same for every instruction set and width.
#pragma once

#include "samplers/sampler_spec.h"

#include <cstdint>

namespace lockstep {

struct SamplerState;

// Points of an added sequence, or offsets of an added perturbation (added.h): for i in [0, count)
// the pair's of sample[i] of pixel[i] to x[i] and y[i], as 32-bit binary fractions.
using PointsFunction = void (*)(const SamplerState& state, const std::uint32_t* pixel,
                                const std::uint32_t* sample, int count, int pair, std::uint32_t* x,
                                std::uint32_t* y);

struct SamplerState {
  std::uint32_t seed = 0;
  Share share = Share::Pixel;
  int shared_pairs = 0;  // pairs from this one on are every pixel's own
  int interleave = 1;    // pixels (x, y) and (x + interleave, y) share
  SequenceId sequence{};
  PerturbationId perturbation{};
  Mix mix = Mix::Add;
  float weight = 0.0f;             // w where there is no map; beyond [0, 1] the nearer end
  const float* weights = nullptr;  // w per pixel, row by row
  int width = 1;                   // of the image; pixels are numbered y * width + x
  int pixel_bits = 1;              // of a pixel's x and y
  std::uint32_t samples = 16;      // per pixel that are planned; a multiple of them is as good
  const std::uint32_t* table = nullptr;    // the sequence's, if it has one
  const std::uint32_t* mask = nullptr;     // the perturbation's, if it has one
  PointsFunction added_points = nullptr;   // set where the sequence is an added one
  PointsFunction added_offsets = nullptr;  // set where the perturbation is
};

// What a batch of values is for: samples of pixels (y * width + x), with sample numbers in
// [first_sample, first_sample + samples), all pixels in one tile of share_tile x share_tile. Arrays
// may be read up to a full packet past `count`.
struct SampleBatch {
  const std::uint32_t* pixel = nullptr;
  const std::uint32_t* sample = nullptr;
  int count = 0;
  std::uint32_t first_sample = 0;
  int samples = 1;
};

inline constexpr int share_tile = 16;
inline constexpr int max_samples_per_batch = 256;
inline constexpr int max_interleave = 4;

}  // namespace lockstep
