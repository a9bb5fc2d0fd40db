// A perturbation: `offset=gradient` of samplers that share a sequence.
#include "samplers/added.h"
#include "samplers/pixel_position.h"

namespace {

using namespace lockstep;

// Interleaved gradient noise (Jimenez 2014, "Next Generation Post Processing in Call of Duty"): any
// 3x3 pixels have evenly spread offsets. The second axis and each pair have a noise moved
// elsewhere.
struct GradientOffset {
  static constexpr PerturbationInfo info{"gradient", "interleaved gradient noise",
                                         "Jimenez 2014, Next Generation Post Processing"};

  template <class V>
  static V noise(V x, V y) {
    const V inner = V(0.06711056f) * x + V(0.00583715f) * y;
    const V outer = V(52.9829189f) * (inner - floor(inner));
    return outer - floor(outer);
  }

  template <class U>
  static Fractions<U> offset(const SamplerState& state, U pixel, U, int pair) {
    using V = FloatOf<U>;
    const PixelPosition<U> p = position_of(pixel, state.width);
    const Hash4<std::uint32_t> moved = pixel_keys(0u, pair, state.seed);
    const V x = to_float(as_int(p.x)), y = to_float(as_int(p.y));
    return {fraction_of(noise(x + V(float(moved.x % 1024)), y + V(float(moved.y % 1024)))),
            fraction_of(noise(x + V(float(moved.z % 1024)), y + V(float(moved.w % 1024))))};
  }
};

}  // namespace

void add_gradient_offset() { add_perturbation<GradientOffset>(); }
