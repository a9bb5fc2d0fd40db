#include "samplers/presets.h"

#include "core/error.h"
#include "samplers/added.h"
#include "samplers/sequences.h"

#include <fmt/format.h>

namespace lockstep {
namespace {

SamplerSpec shared(std::string_view name, std::string_view offset, WeightSource source) {
  SamplerSpec s;
  s.name = name;
  s.share = Share::Image;
  s.sequence = sequence_named("owen");
  s.perturbation = perturbation_named(offset);
  s.weight_source = source;
  return s;
}

SamplerSpec strata() {
  SamplerSpec s = shared("strata", "bluenoise", WeightSource::Cells);
  s.sequence = sequence_named("linked");
  s.mix = Mix::Xor;
  s.pairs = 3;
  return s;
}

std::vector<Preset> make_presets() {
  std::vector<Preset> list;
  for (const SequenceInfo& info : Sequences::infos()) list.push_back(preset_of(info));
  using enum WeightSource;
  list.push_back({"one sequence for all pixels",
                  "Sadeghi, Chen and Jensen 2009, Coherent Path Tracing",
                  shared("cpt", "none", Constant)});
  list.push_back({"one sequence, left by each pixel as far as its weight from a pilot image says",
                  "Staal and Hachisuka, Randomized Coherent Sampling",
                  shared("rcs", "constant", Map)});
  list.push_back({"one sequence, moved for each pixel by a blue-noise mask",
                  "Georgiev and Fajardo 2016, Blue-Noise Dithered Sampling",
                  shared("bluenoise", "bluenoise", Constant)});
  list.push_back(
      {"one order of the strata for all pixels, places in them moved by a blue-noise mask",
       "stratum-coherent sampling, see docs/samplers.md", strata()});
  return list;
}

std::vector<Preset>& preset_list() {
  static std::vector<Preset> list = make_presets();
  return list;
}

}  // namespace

const std::vector<Preset>& presets() { return preset_list(); }

void add_preset(const Preset& preset) {
  check_sampler_name(preset.spec.name);
  preset_list().push_back(preset);
}

Preset preset_of(const SequenceInfo& sequence) {
  SamplerSpec s;
  s.name = sequence.name;
  s.sequence = sequence_named(sequence.name);
  return {sequence.summary, sequence.paper, s};
}

const Preset& find_preset(std::string_view name) {
  std::string known;
  for (const Preset& p : presets()) {
    if (p.spec.name == name) return p;
    known += (known.empty() ? "" : ", ") + p.spec.name;
  }
  throw UsageError(fmt::format("unknown sampler '{}'; choose from {}", name, known));
}

}  // namespace lockstep
