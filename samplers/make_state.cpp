#include "samplers/make_state.h"

#include "samplers/added.h"
#include "samplers/dimensions.h"

#include <algorithm>
#include <bit>

namespace lockstep {
namespace {

// 2^-m, for 4^m samples or more: the first 4^m points of a (0, 2)-sequence fill cells of that side.
float cell_side(std::uint32_t samples) {
  float width = 1.0f;
  for (; samples >= 4; samples /= 4) width *= 0.5f;
  return width;
}

}  // namespace

SamplerState make_state(const SamplerSpec& spec, std::uint32_t seed, const SamplePlan& plan) {
  SamplerState state;
  state.seed = seed;
  state.share = spec.share;
  state.shared_pairs = !spec.shared() ? 0 : spec.pairs > 0 ? spec.pairs : max_pairs;
  state.interleave = spec.interleave;
  state.sequence = spec.sequence;
  state.perturbation = spec.perturbation;
  state.mix = spec.mix;
  state.samples = std::max(plan.samples, 1u);
  state.width = plan.width;
  state.pixel_bits = std::bit_width(unsigned(std::max(plan.width, plan.height) - 1));
  state.table = sequence_infos()[std::size_t(spec.sequence)].table;
  state.added_points = added_points(spec.sequence);
  if (spec.perturbation == PerturbationId{}) return state;
  state.weight = spec.weight_source == WeightSource::Cells ? cell_side(state.samples) : spec.weight;
  state.mask = perturbation_infos()[std::size_t(spec.perturbation)].mask;
  state.added_offsets = added_offsets(spec.perturbation);
  return state;
}

}  // namespace lockstep
