// Compiled once per instruction set.
#include "samplers/added_kernels.h"
#include "samplers/sampler.h"

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {
namespace {

// Sequences that can do part of their work for a sample, whatever the pixel, say so by prepare().
template <class S>
concept HasPrepare = requires(const SamplerState& s) {
  S::prepare(s, std::uint32_t(0), 0);
};

// And those that can do part of it for a tile of pixels by prepare_tile().
template <class S>
concept HasPrepareTile = requires(const SamplerState& s, const SampleBatch& batch) {
  S::prepare_tile(s, batch, 0);
};

// One point, alone.
template <class S>
Fractions<std::uint32_t> single_point(const SamplerState& s, std::uint32_t pixel,
                                      std::uint32_t sample, int pair) {
  if constexpr (HasPrepare<S>) {
    return S::point(s, pixel, S::prepare(s, sample, pair), pair);
  } else {
    return S::point(s, pixel, sample, pair);
  }
}

// The number of a sample in the batch. Lanes behind the last path may hold anything.
template <class U>
LOCKSTEP_INLINE auto place_in_batch(const SampleBatch& batch, U sample) {
  using I = decltype(as_int(sample));
  return as_int(sample - U(batch.first_sample)) & I(max_samples_per_batch - 1);
}

template <int W>
LOCKSTEP_INLINE void store_point(const Fractions<UInt<W>>& point, int i, float* u, float* v) {
  const auto values = unit_floats(point);
  store(u + i, values.x);
  store(v + i, values.y);
}

template <int W, class S>
void fill_own(const SamplerState& state, const SampleBatch& batch, int pair, float* u, float* v) {
  using U = UInt<W>;
  if constexpr (HasPrepare<S>) {
    std::uint32_t x[max_samples_per_batch], y[max_samples_per_batch];
    for (int k = 0; k < batch.samples; ++k) {
      const auto prepared = S::prepare(state, batch.first_sample + std::uint32_t(k), pair);
      x[k] = prepared.x, y[k] = prepared.y;
    }
    for (int i = 0; i < batch.count; i += W) {
      const auto k = place_in_batch(batch, load<U>(batch.sample + i));
      const Fractions<U> prepared{gather(x, k), gather(y, k)};
      store_point<W>(S::point(state, load<U>(batch.pixel + i), prepared, pair), i, u, v);
    }
  } else if constexpr (HasPrepareTile<S>) {
    const auto tile = S::prepare_tile(state, batch, pair);
    for (int i = 0; i < batch.count; i += W) {
      const U pixel = load<U>(batch.pixel + i), sample = load<U>(batch.sample + i);
      store_point<W>(S::point(state, pixel, sample, pair, tile), i, u, v);
    }
  } else {
    for (int i = 0; i < batch.count; i += W) {
      const U pixel = load<U>(batch.pixel + i), sample = load<U>(batch.sample + i);
      store_point<W>(S::point(state, pixel, sample, pair), i, u, v);
    }
  }
}

// Shared sequences are those of a pixel that no image has, with a seed of their own for each tile
// and group of interleaved pixels that share one.
constexpr std::uint32_t no_pixel = 0xffffffffu;

SamplerState shared_state(const SamplerState& state, const SampleBatch& batch, int group) {
  std::uint32_t tile = 0;
  if (state.share == Share::Tile) {
    const PixelPosition<std::uint32_t> p = position_of(batch.pixel[0], state.width);
    tile = 1 + (p.y / share_tile << 16 | p.x / share_tile);
  }
  SamplerState shared = state;
  shared.seed = pcg3d(state.seed, tile, std::uint32_t(group)).x;
  return shared;
}

// The points that pixels share: those of a group of interleaved pixels after those of another.
struct SharedPoints {
  static constexpr int most = max_samples_per_batch * max_interleave * max_interleave;
  std::uint32_t x[most], y[most];
};

template <class S>
void make_shared_points(const SamplerState& state, const SampleBatch& batch, int pair,
                        SharedPoints& points) {
  for (int group = 0; group < state.interleave * state.interleave; ++group) {
    const SamplerState shared = shared_state(state, batch, group);
    for (int k = 0; k < batch.samples; ++k) {
      const auto point =
          single_point<S>(shared, no_pixel, batch.first_sample + std::uint32_t(k), pair);
      points.x[group * max_samples_per_batch + k] = point.x;
      points.y[group * max_samples_per_batch + k] = point.y;
    }
  }
}

template <int W>
LOCKSTEP_INLINE Fractions<UInt<W>> shared_point(const SamplerState& state, const SampleBatch& batch,
                                                const SharedPoints& points, UInt<W> pixel,
                                                UInt<W> sample) {
  using I = Int<W>;
  I place = place_in_batch(batch, sample);
  if (state.interleave > 1) {
    const auto p = position_of(pixel, state.width);
    const UInt<W> mask(std::uint32_t(state.interleave - 1));
    const I group = as_int((p.y & mask) * UInt<W>(std::uint32_t(state.interleave)) + (p.x & mask));
    place = place + group * I(max_samples_per_batch);
  }
  return {gather(points.x, place), gather(points.y, place)};
}

// The power of two that is at least w, in (0, 1].
template <class V>
LOCKSTEP_INLINE V power_of_two_above(V w) {
  return as_float(((as_uint(w) - decltype(as_uint(w))(1u)) & decltype(as_uint(w))(0xff800000u)) +
                  decltype(as_uint(w))(0x00800000u));
}

template <int W>
LOCKSTEP_INLINE Fractions<UInt<W>> moved(Mix mix, const Fractions<UInt<W>>& point, Float<W> w,
                                         const Fractions<UInt<W>>& offset) {
  if (mix == Mix::Add) return {point.x + scaled(w, offset.x), point.y + scaled(w, offset.y)};
  const Float<W> digits = select(w > Float<W>(0.0f), power_of_two_above(w), Float<W>(0.0f));
  return {point.x ^ scaled(digits, offset.x), point.y ^ scaled(digits, offset.y)};
}

template <int W, class P>
void fill_perturbed(const SamplerState& state, const SampleBatch& batch, const SharedPoints& points,
                    int pair, float* u, float* v) {
  using U = UInt<W>;
  using V = Float<W>;
  for (int i = 0; i < batch.count; i += W) {
    const U pixel = load<U>(batch.pixel + i), sample = load<U>(batch.sample + i);
    Fractions<U> point = shared_point<W>(state, batch, points, pixel, sample);
    // What is not a number counts as 0. A packet must not move lanes that would stay if alone.
    const V w = clamp(state.weights ? gather(state.weights, as_int(pixel)) : V(state.weight),
                      V(0.0f), V(1.0f));
    if (any(w > V(0.0f))) {
      point = moved<W>(state.mix, point, w, P::offset(state, pixel, sample, pair));
    }
    store_point<W>(point, i, u, v);
  }
}

}  // namespace

template <int W>
void fill_pair(const SamplerState& state, const SampleBatch& batch, int pair, float* u, float* v) {
  if (pair >= state.shared_pairs) {
    return visit_sequence(
        state, [&](auto sequence) { fill_own<W, decltype(sequence)>(state, batch, pair, u, v); });
  }
  SharedPoints points;
  visit_sequence(state, [&](auto sequence) {
    make_shared_points<decltype(sequence)>(state, batch, pair, points);
  });
  visit_perturbation(state, [&](auto perturbation) {
    fill_perturbed<W, decltype(perturbation)>(state, batch, points, pair, u, v);
  });
}

template void fill_pair<1>(const SamplerState&, const SampleBatch&, int, float*, float*);
template void fill_pair<4>(const SamplerState&, const SampleBatch&, int, float*, float*);
template void fill_pair<8>(const SamplerState&, const SampleBatch&, int, float*, float*);
template void fill_pair<16>(const SamplerState&, const SampleBatch&, int, float*, float*);

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
