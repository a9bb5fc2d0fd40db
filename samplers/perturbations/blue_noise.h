// An offset for each pixel from a blue-noise mask, moved for each dimension.
#pragma once

#include "samplers/blue_noise_mask.h"
#include "samplers/fractions.h"
#include "samplers/pixel_position.h"
#include "samplers/sequence_info.h"

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

struct BlueNoiseOffset {
  static constexpr PerturbationInfo info{"bluenoise", "one for each pixel, from a blue-noise mask",
                                         "Georgiev and Fajardo 2016, Blue-Noise Dithered Sampling",
                                         blue_noise_mask};

  // The mask around the pixel, moved by the key's bits. The rank's place below its digits is
  // random.
  template <class U>
  LOCKSTEP_INLINE static U value(const SamplerState& s, const PixelPosition<U>& p,
                                 std::uint32_t move, U jitter) {
    const U last(std::uint32_t(blue_noise_side - 1));
    const U x = (p.x + U(move)) & last, y = (p.y + U(move >> 16)) & last;
    const U rank = gather(s.mask, as_int(y * U(std::uint32_t(blue_noise_side)) + x));
    return (rank << (32 - blue_noise_bits)) | (jitter >> blue_noise_bits);
  }

  template <class U>
  LOCKSTEP_INLINE static Fractions<U> offset(const SamplerState& s, U pixel, U, int pair) {
    const PixelPosition<U> p = position_of(pixel, s.width);
    const Hash3<std::uint32_t> moves = pcg3d(s.seed, std::uint32_t(pair), 0xb10eu);
    const auto jitter = random_fractions(pixel, U(0u), pair, s.seed, Stream::Jitter);
    return {value(s, p, folded(moves.x), jitter.x), value(s, p, folded(moves.y), jitter.y)};
  }
};

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
