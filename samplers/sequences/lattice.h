// A rank-1 lattice in every pair, in the order of van der Corput's sequence, so that its first 2^m
// points are a lattice too (Hickernell, Hong, L'Ecuyer and Lemieux 2000, "Extensible Lattice
// Sequences for Quasi-Monte Carlo Quadrature"); shifted for each pixel (Cranley and Patterson
// 1976).
#pragma once

#include "samplers/sequence_info.h"
#include "samplers/sobol.h"

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

struct LatticeSequence {
  static constexpr SequenceInfo info{
      "lattice", "a rank-1 lattice sequence in pairs, shifted for each pixel",
      "Cranley and Patterson 1976, Randomization of Number Theoretic Methods"};

  // The generating vector is (1, generator): among the odd numbers below 2^20 the one whose
  // lattices of 2^2...2^16 points have, at worst, the longest shortest vector: 0.66 of what is
  // possible.
  static constexpr std::uint32_t generator = 17939;

  template <class U>
  LOCKSTEP_INLINE static Fractions<U> point(const SamplerState& s, U pixel, U sample, int pair) {
    const Hash4<U> keys = pixel_keys(pixel, pair, s.seed);
    const U x = scramble_mirrored(reverse_bits(sample), keys.z);  // in another order
    return {x + keys.x, x * U(generator) + keys.y};
  }
};

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
