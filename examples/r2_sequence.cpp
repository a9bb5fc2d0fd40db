// A sequence: the sampler `r2`, and `sequence=r2` of samplers that share one.
#include "samplers/added.h"

namespace {

using namespace lockstep;

// Multiples of the plastic number's inverse powers (Roberts 2018, "The Unreasonable Effectiveness
// of Quasirandom Sequences"), shifted for each pixel and pair.
struct R2Sequence {
  static constexpr SequenceInfo info{"r2", "multiples of two irrational numbers, shifted",
                                     "Roberts 2018, Quasirandom Sequences"};

  // U is an unsigned integer or a packet of them; the fractions are x / 2^32 and y / 2^32.
  template <class U>
  static Fractions<U> point(const SamplerState& state, U pixel, U sample, int pair) {
    const Hash4<U> shift = pixel_keys(pixel, pair, state.seed);
    return {sample * U(0xc13fa9a9u) + shift.x, sample * U(0x91e10da5u) + shift.y};
  }
};

}  // namespace

void add_r2_sequence() { add_sequence<R2Sequence>(); }
