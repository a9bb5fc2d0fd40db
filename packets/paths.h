// Both ends of a wave's paths: their order and camera rays, and their way into the film.
#pragma once

#include "core/camera.h"
#include "packets/wave.h"
#include "samplers/dimensions.h"
#include "samplers/sampler.h"

#include <algorithm>
#include <limits>

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

// RGB and a count, of a path or a pixel.
typedef float Float4 __attribute__((vector_size(16)));
typedef double Double4 __attribute__((vector_size(32)));

// Blocks of lanes.x * lanes.y pixels and lanes.samples samples, one after the other. With
// interleaved sequences the pixels of a block are those `interleave` apart, which share one.
inline void order_paths(PathOrder& o) {
  const int step = o.interleave, block_x = o.lanes.x * step, block_y = o.lanes.y * step;
  int n = 0;
  for (int s0 = 0; s0 < o.samples; s0 += o.lanes.samples) {
    const int s1 = std::min(s0 + o.lanes.samples, o.samples);
    for (int y0 = 0; y0 < o.height; y0 += block_y) {
      const int y1 = std::min(y0 + block_y, o.height);
      for (int x0 = 0; x0 < o.width; x0 += block_x) {
        const int x1 = std::min(x0 + block_x, o.width);
        for (int group = 0; group < step * step; ++group) {
          for (int y = y0 + group / step; y < y1; y += step) {
            for (int x = x0 + group % step; x < x1; x += step) {
              for (int s = s0; s < s1; ++s, ++n) o.x[n] = x, o.y[n] = y, o.sample[n] = s;
            }
          }
        }
      }
    }
  }
  o.count = n;
  // Lanes behind the last path repeat it, so that what they index stays valid.
  for (int i = n; i < n + 16; ++i) {
    o.x[i] = o.x[n - 1], o.y[i] = o.y[n - 1], o.sample[i] = o.sample[n - 1];
  }
}

template <int W>
void begin_paths(const TileJob& job, Wave& wave) {
  using U = UInt<W>;
  PathOrder& o = wave.order;
  const int width = job.x1 - job.x0, height = job.y1 - job.y0;
  if (o.width != width || o.height != height || o.samples != int(job.samples) ||
      o.lanes != job.lanes || o.interleave != job.sampler->interleave) {
    o.width = width, o.height = height, o.samples = int(job.samples), o.lanes = job.lanes;
    o.interleave = job.sampler->interleave;
    order_paths(o);
  }
  PathTable& paths = wave.paths;
  paths.count = o.count;
  const auto film_width = std::uint32_t(job.film.width);
  const std::uint32_t first_pixel = std::uint32_t(job.y0) * film_width + std::uint32_t(job.x0);
  for (int i = 0; i < o.count + 16 - W + 1; i += W) {
    const U x = as_uint(load<Int<W>>(o.x + i)), y = as_uint(load<Int<W>>(o.y + i));
    store(paths.pixel + i, U(first_pixel) + y * U(film_width) + x);
    store(paths.sample + i, U(job.first_sample) + as_uint(load<Int<W>>(o.sample + i)));
  }
  const Float4 black_sample{0.0f, 0.0f, 0.0f, 1.0f};
  for (int i = 0; i < o.count; ++i) {
    std::memcpy(paths.radiance + 4 * i, &black_sample, sizeof black_sample);
  }
}

template <int W, FeatureMask F>
void generate_camera_rays(const TileJob& job, Wave& wave, StageClock& clock) {
  using V = Float<W>;
  PathTable& paths = wave.paths;
  const PathOrder& order = wave.order;
  const CameraData& camera = job.scene->camera;
  RayQueue& rays = wave.rays[0];
  rays.count = paths.count;
  float* u = wave.hits_to_shade.u[0];
  float* v = wave.hits_to_shade.v[0];
  clock.enter(Stage::Sampling);
  const SampleBatch batch{paths.pixel, paths.sample, paths.count, job.first_sample,
                          int(job.samples)};
  fill_pair<W>(*job.sampler, batch, pixel_pair, u, v);
  float* lens_u = wave.hits_to_shade.u[1];
  float* lens_v = wave.hits_to_shade.v[1];
  const bool lens = needs<F>(*job.scene, Feature::Lens);
  if (lens) fill_pair<W>(*job.sampler, batch, lens_pair, lens_u, lens_v);
  clock.enter(Stage::Shading);
  const auto ray_through = [&](const Vec2<V>& point, int i) LOCKSTEP_LAMBDA {
    if (lens) return lens_ray(camera, point, Vec2<V>(load<V>(lens_u + i), load<V>(lens_v + i)));
    if (needs<F>(*job.scene, Feature::Orthographic)) return orthographic_ray(camera, point);
    return pinhole_ray(camera, point);
  };
  for (int i = 0; i < paths.count; i += W) {
    const V column = to_float(load<Int<W>>(order.x + i) + Int<W>(job.x0));
    const V row = to_float(load<Int<W>>(order.y + i) + Int<W>(job.y0));
    const Vec2<V> at(load<V>(u + i), load<V>(v + i));
    if (needs<F>(*job.scene, Feature::FilterSigns)) {
      store(paths.weight + i, filter_weight(camera, at));
    }
    const Vec2<V> point = image_point<V, F>(camera, column, row, at);
    const CameraRay<V> ray = ray_through(point, i);
    store3(rays.origin, i, ray.origin);
    store3(rays.direction, i, ray.direction);
    store3(rays.throughput, i, Vec3<V>(V(1.0f)));
    if (refracts<F>(*job.scene)) store(rays.eta_scale + i, V(1.0f));
    if (needs<F>(*job.scene, Feature::Absorption)) store(rays.medium + i, Int<W>(-1));
    store(rays.path + i, Int<W>(i) + lane_indices<W>());
  }
}

// A sample that was not finite: remembered, and kept out of the film.
inline void count_nonfinite(const TileJob& job, const PathTable& paths, int i, TileCounts& counts) {
  if (counts.nonfinite < TileCounts::kept) {
    const auto width = std::uint32_t(job.film.width);
    counts.bad[counts.nonfinite] = {int(paths.pixel[i] % width), int(paths.pixel[i] / width),
                                    paths.sample[i]};
  }
  ++counts.nonfinite;
}

// Scales a sample down to the luminance that it may have at most. One of infinite luminance stays
// as it is: it is left out, and counted as that.
inline void clamp_sample(float most, Float4& radiance, TileCounts& counts) {
  const float l = luminance(Vec3<float>(radiance[0], radiance[1], radiance[2]));
  if (!(l > most && l < std::numeric_limits<float>::infinity())) return;
  const float scale = most / l;
  radiance *= Float4{scale, scale, scale, 1.0f};
  ++counts.clamped;
}

// Adds the wave's paths to the film, a pixel's samples in ascending order.
template <FeatureMask F>
void end_paths(const TileJob& job, const PathTable& paths, TileCounts& counts) {
  const bool clamps = job.path.clamp < std::numeric_limits<float>::infinity();
  for (int i = 0; i < paths.count; ++i) {
    Float4 radiance;
    std::memcpy(&radiance, paths.radiance + 4 * i, sizeof radiance);
    if (clamps) clamp_sample(job.path.clamp, radiance, counts);
    if (needs<F>(*job.scene, Feature::FilterSigns)) {
      const float weight = paths.weight[i];
      radiance *= Float4{weight, weight, weight, 1.0f};
    }
    const Float4 zero = radiance * 0.0f;  // NaN where not finite
    if (!(zero[0] + zero[1] + zero[2] == 0.0f)) {
      count_nonfinite(job, paths, i, counts);
      continue;
    }
    double* at = job.film.sums + std::size_t(paths.pixel[i]) * 4;
    Double4 sum;
    std::memcpy(&sum, at, sizeof sum);
    sum += __builtin_convertvector(radiance, Double4);
    std::memcpy(at, &sum, sizeof sum);
  }
}

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
