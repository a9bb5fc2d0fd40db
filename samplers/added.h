// Sequences, perturbations and presets that a program adds to the library's own, before it uses any
// sampler; docs/library.md has an example. They have names on the command line like all others.
//
// A sequence is a type as random.h has one: its `info`, and point() for the fractions of a pixel's
// sample. A perturbation is one as constant.h has: `info` and offset(). Values must depend on
// nothing but the arguments. Kernels call them through a pointer, a packet at a time.
#pragma once

#include "samplers/fractions.h"
#include "samplers/sequence_info.h"

#include <vector>

namespace lockstep {

// Each throws Error where the name is taken, or is not of lower-case letters, digits, - and _. The
// texts must live as long as the program. A sequence becomes a sampler of its name as well; other
// samplers are added by add_preset().
void add_sequence(const SequenceInfo& info, PointsFunction points);
void add_perturbation(const PerturbationInfo& info, PointsFunction offsets);

// The library's own, then those added.
const std::vector<SequenceInfo>& sequence_infos();
const std::vector<PerturbationInfo>& perturbation_infos();

// Throws Error where a sampler cannot have this name.
void check_sampler_name(std::string_view name);

// Null for the library's own.
PointsFunction added_points(SequenceId sequence);
PointsFunction added_offsets(PerturbationId perturbation);

inline namespace LOCKSTEP_ISA_NAMESPACE {

// point() or offset() as a function of arrays; as wide as the registers that the including file is
// compiled for.
template <class F>
LOCKSTEP_INLINE void for_points(F value, const std::uint32_t* pixel, const std::uint32_t* sample,
                                int count, std::uint32_t* x, std::uint32_t* y) {
  int i = 0;
#if defined(__SSE4_1__)
  using U = UInt<native_lanes>;
  for (; i + native_lanes <= count; i += native_lanes) {
    const Fractions<U> f = value(load<U>(pixel + i), load<U>(sample + i));
    store(x + i, f.x);
    store(y + i, f.y);
  }
#endif
  for (; i < count; ++i) {
    const Fractions<std::uint32_t> f = value(pixel[i], sample[i]);
    x[i] = f.x, y[i] = f.y;
  }
}

template <class Sequence>
PointsFunction points_of() {
  return [](const SamplerState& s, const std::uint32_t* pixel, const std::uint32_t* sample,
            int count, int pair, std::uint32_t* x, std::uint32_t* y) {
    for_points([&](auto p, auto k) LOCKSTEP_LAMBDA { return Sequence::point(s, p, k, pair); },
               pixel, sample, count, x, y);
  };
}

template <class Perturbation>
PointsFunction offsets_of() {
  return [](const SamplerState& s, const std::uint32_t* pixel, const std::uint32_t* sample,
            int count, int pair, std::uint32_t* x, std::uint32_t* y) {
    for_points([&](auto p, auto k) LOCKSTEP_LAMBDA { return Perturbation::offset(s, p, k, pair); },
               pixel, sample, count, x, y);
  };
}

template <class Sequence>
void add_sequence() {
  add_sequence(Sequence::info, points_of<Sequence>());
}

template <class Perturbation>
void add_perturbation() {
  add_perturbation(Perturbation::info, offsets_of<Perturbation>());
}

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
