// What a sequence or a perturbation tells about itself, and what it needs beside its code.
#pragma once

#include "samplers/sampler_state.h"

#include <cstdint>
#include <string_view>

namespace lockstep {

struct SequenceInfo {
  std::string_view name, summary, paper;
  bool planned = false;  // its points depend on SamplerState::samples
  const std::uint32_t* table = nullptr;
};

struct PerturbationInfo {
  std::string_view name, summary, paper;
  const std::uint32_t* mask = nullptr;
};

}  // namespace lockstep
