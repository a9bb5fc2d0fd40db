// Sample values as tests draw them: through the kernels, in batches that lanes do not divide.
#pragma once

#include "packets/kernel.h"
#include "samplers/make_state.h"
#include "samplers/perturbations.h"
#include "samplers/sequences.h"
#include "tests/t_statistics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace lockstep {

// (pixel, sample) couples, in their order.
struct Couples {
  std::vector<std::uint32_t> pixel, sample;

  void add(std::uint32_t p, std::uint32_t s) {
    pixel.push_back(p);
    sample.push_back(s);
  }
};

struct Values {
  std::vector<float> u, v;

  bool operator==(const Values&) const = default;
  void append(const Values& other) {
    u.insert(u.end(), other.u.begin(), other.u.end());
    v.insert(v.end(), other.v.begin(), other.v.end());
  }
};

inline const Kernel& widest_kernel() { return find_kernel(available_isas().back(), 0); }

inline Values draw_batch(const Kernel& kernel, const SamplerState& state, Couples c, int pair) {
  const std::size_t n = c.pixel.size();
  const auto [low, high] = std::minmax_element(c.sample.begin(), c.sample.end());
  SampleBatch batch;
  batch.count = int(n), batch.first_sample = *low, batch.samples = int(*high - *low) + 1;
  EXPECT_LE(batch.samples, max_samples_per_batch);
  // Behind the end: a pixel that exists, and any sample.
  c.pixel.resize(n + 16, c.pixel.back());
  c.sample.resize(n + 16, 0xffffffffu);
  batch.pixel = c.pixel.data(), batch.sample = c.sample.data();
  Values values{std::vector<float>(n + 16), std::vector<float>(n + 16)};
  kernel.fill_pair(state, batch, pair, values.u.data(), values.v.data());
  values.u.resize(n);
  values.v.resize(n);
  return values;
}

// Samples [first, first + count) of one pixel.
inline Values draw(const SamplerState& state, std::uint32_t pixel, int pair, std::uint32_t first,
                   std::uint32_t count) {
  Values all;
  for (std::uint32_t done = 0; done < count; done += max_samples_per_batch) {
    Couples c;
    const std::uint32_t n = std::min<std::uint32_t>(max_samples_per_batch, count - done);
    for (std::uint32_t k = 0; k < n; ++k) c.add(pixel, first + done + k);
    all.append(draw_batch(widest_kernel(), state, std::move(c), pair));
  }
  return all;
}

// One sample of all pixels of a block of side x side, row by row; a batch is part of one tile.
inline Values draw_block(const SamplerState& state, int x0, int y0, int side, int pair,
                         std::uint32_t sample) {
  Values all;
  for (int y = y0; y < y0 + side; ++y) {
    for (int x = x0; x < x0 + side;) {
      Couples c;
      const int end = std::min(x0 + side, (x / share_tile + 1) * share_tile);
      for (; x < end; ++x) c.add(std::uint32_t(y * state.width + x), sample);
      all.append(draw_batch(widest_kernel(), state, std::move(c), pair));
    }
  }
  return all;
}

// One sample of every pixel of a square image whose side tiles divide, row by row.
inline Values draw_image(const SamplerState& state, int pair, std::uint32_t sample) {
  const int side = state.width;
  const std::size_t pixels = std::size_t(side) * std::size_t(side);
  Values all{std::vector<float>(pixels), std::vector<float>(pixels)};
  for (int y0 = 0; y0 < side; y0 += share_tile) {
    for (int x0 = 0; x0 < side; x0 += share_tile) {
      const Values tile = draw_block(state, x0, y0, share_tile, pair, sample);
      for (int i = 0; i < share_tile * share_tile; ++i) {
        const int x = x0 + i % share_tile, y = y0 + i / share_tile;
        all.u[std::size_t(y * side + x)] = tile.u[std::size_t(i)];
        all.v[std::size_t(y * side + x)] = tile.v[std::size_t(i)];
      }
    }
  }
  return all;
}

inline SamplerState state_of(std::string_view text, std::uint32_t seed = 7,
                             const SamplePlan& plan = {}) {
  return make_state(parse_sampler(text), seed, plan);
}

inline std::vector<std::string> sequence_names() {
  std::vector<std::string> names;
  for (const SequenceInfo& info : Sequences::infos()) names.emplace_back(info.name);
  return names;
}

// But for none, which is the first.
inline std::vector<std::string> offset_names() {
  std::vector<std::string> names;
  for (const PerturbationInfo& info : Perturbations::infos()) names.emplace_back(info.name);
  names.erase(names.begin());
  return names;
}

// Every sequence x share x offset x mix, and every preset. Weights are left as they are: 1 where
// there are offsets.
inline std::vector<std::string> all_samplers() {
  std::vector<std::string> all = sampler_names();
  for (const std::string& sequence : sequence_names()) {
    for (const char* share : {"tile", "image"}) {
      const std::string shared = sequence + ":share=" + share;
      all.push_back(shared);
      for (const std::string& offset : offset_names()) {
        all.push_back(shared + ",offset=" + offset);
        all.push_back(shared + ",offset=" + offset + ",mix=xor");
      }
    }
  }
  return all;
}

// True where every elementary interval of area 1/n holds exactly one of the n = 2^bits points.
inline bool is_net(const Values& points, int bits) {
  if (points.u.size() != std::size_t(1) << bits) return false;
  for (int along_u = 0; along_u <= bits; ++along_u) {
    const int columns = 1 << along_u, rows = 1 << (bits - along_u);
    std::vector<bool> taken(std::size_t(1) << bits, false);
    for (std::size_t i = 0; i < points.u.size(); ++i) {
      const auto cell = std::size_t(points.v[i] * float(rows)) * std::size_t(columns) +
                        std::size_t(points.u[i] * float(columns));
      if (taken[cell]) return false;
      taken[cell] = true;
    }
  }
  return true;
}

// True where every n-th of the unit interval holds exactly one of n values.
inline bool is_stratified(const std::vector<float>& values) {
  std::vector<bool> taken(values.size(), false);
  for (const float x : values) {
    const auto cell = std::size_t(double(x) * double(values.size()));
    if (taken[cell]) return false;
    taken[cell] = true;
  }
  return true;
}

// How far `a` is ahead of `b` on the circle, in [0, 1); exact.
inline float ahead(float a, float b) { return a < b ? a - b + 1.0f : a - b; }

// Evenness of points over n x n cells, and of values over n.
inline double joint_evenness(const std::vector<float>& a, const std::vector<float>& b, int n) {
  std::vector<std::uint32_t> cells(std::size_t(n) * std::size_t(n));
  for (std::size_t i = 0; i < a.size(); ++i) {
    ++cells[std::size_t(a[i] * float(n)) * std::size_t(n) + std::size_t(b[i] * float(n))];
  }
  return evenness(cells);
}
inline double evenness_of(const std::vector<float>& a, int n) {
  std::vector<std::uint32_t> cells(static_cast<std::size_t>(n));
  for (const float x : a) ++cells[std::size_t(x * float(n))];
  return evenness(cells);
}

}  // namespace lockstep
