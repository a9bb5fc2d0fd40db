// Jittered strata: the planned samples of a pixel lie in different cells of a grid, in an order and
// at places of the pixel's own.
#pragma once

#include "samplers/index_shuffle.h"
#include "samplers/sequence_info.h"

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

struct StratifiedSequence {
  static constexpr SequenceInfo info{"stratified", "jittered strata, in random order",
                                     "Kensler 2013, Correlated Multi-Jittered Sampling", true};

  // As square as can be, with at least as many cells as samples.
  struct Grid {
    std::uint32_t columns, rows;
  };
  LOCKSTEP_INLINE static Grid grid(std::uint32_t samples) {
    const auto columns = std::uint32_t(__builtin_sqrt(double(samples)));
    return {columns, (samples + columns - 1) / columns};
  }

  // The number of the sample among those planned, and of the plan that it belongs to.
  LOCKSTEP_INLINE static Fractions<std::uint32_t> prepare(const SamplerState& s,
                                                          std::uint32_t sample, int) {
    return {sample % s.samples, sample / s.samples};
  }

  // A place in the cell, kept off its end, where rounding would take it into the next.
  template <class V, class U>
  LOCKSTEP_INLINE static V inside(V cell, U jitter) {
    return min(cell + unit_float(jitter), (cell + V(1.0f)) * V(1.0f - 0x1p-22f));
  }

  template <class U>
  LOCKSTEP_INLINE static Fractions<U> point(const SamplerState& s, U pixel, Fractions<U> prepared,
                                            int pair) {
    using V = FloatOf<U>;
    const Grid g = grid(s.samples);
    const Hash4<U> keys = pixel_keys(pixel ^ (prepared.y * U(0x9e3779b9u)), pair, s.seed);
    const U cell = permuted_index(prepared.x, g.columns * g.rows, keys.x);
    // Exact: cells are far fewer than 2^24.
    const V row = floor((to_float(as_int(cell)) + V(0.5f)) * V(1.0f / float(g.columns)));
    const V column = to_float(as_int(cell)) - row * V(float(g.columns));
    const Hash3<U> jitter = pcg3d(keys.y, keys.z, prepared.x);
    return {fraction_of(inside(column, jitter.x) * V(1.0f / float(g.columns))),
            fraction_of(inside(row, jitter.y) * V(1.0f / float(g.rows)))};
  }
};

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
