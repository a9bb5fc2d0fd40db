// The path integrator: a tile's samples as small waves that are generated, traced in packets,
// compacted, shaded by material, and added to the film. One source for every width.
//
// Which paths share a packet follows from the lane layout and from who is still alive; no value
// depends on it, so every width, layout, thread count and tile order gives the same image.
#pragma once

#include "core/camera.h"
#include "packets/intersect.h"
#include "packets/shade.h"

#include <algorithm>
#include <cmath>

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

// Lists the job's paths in packet order: blocks of x * y pixels and `samples` samples.
inline void list_paths(const TileJob& job, PathTable& paths) {
  const LaneLayout& lanes = job.path.lanes;
  const int samples = int(job.samples);
  int n = 0;
  for (int s0 = 0; s0 < samples; s0 += lanes.samples) {
    const int s1 = std::min(s0 + lanes.samples, samples);
    for (int y0 = job.y0; y0 < job.y1; y0 += lanes.y) {
      const int y1 = std::min(y0 + lanes.y, job.y1);
      for (int x0 = job.x0; x0 < job.x1; x0 += lanes.x) {
        const int x1 = std::min(x0 + lanes.x, job.x1);
        for (int y = y0; y < y1; ++y) {
          for (int x = x0; x < x1; ++x) {
            for (int s = s0; s < s1; ++s, ++n) {
              paths.pixel[n] = std::uint32_t(y) * std::uint32_t(job.film.width) + std::uint32_t(x);
              paths.sample[n] = job.first_sample + std::uint32_t(s);
              paths.column[n] = float(x);
              paths.row[n] = float(y);
            }
          }
        }
      }
    }
  }
  paths.count = n;
  // Lanes behind the last path repeat it, so that what they index stays valid.
  for (int i = n; i < n + 16; ++i) {
    paths.pixel[i] = paths.pixel[n - 1];
    paths.sample[i] = paths.sample[n - 1];
  }
  std::fill_n(paths.radiance.x, n, 0.0f);
  std::fill_n(paths.radiance.y, n, 0.0f);
  std::fill_n(paths.radiance.z, n, 0.0f);
}

template <int W>
void generate_camera_rays(const TileJob& job, Wave& wave) {
  using V = Float<W>;
  const PathTable& paths = wave.paths;
  RayQueue& rays = wave.rays[0];
  rays.count = paths.count;
  for (int i = 0; i < paths.count; i += W) store(rays.path + i, Int<W>(i) + lane_indices<W>());
  const SampleBatch batch{rays.path,    paths.count,      paths.pixel,
                          paths.sample, job.first_sample, int(job.samples)};
  float* u = wave.list.u[0];
  float* v = wave.list.v[0];
  fill_pair<W>(*job.sampler, batch, pixel_pair, u, v);
  for (int i = 0; i < paths.count; i += W) {
    const Vec3<V> direction =
        camera_direction(job.scene->camera, load<V>(paths.column + i), load<V>(paths.row + i),
                         Vec2<V>(load<V>(u + i), load<V>(v + i)));
    store3(rays.origin, i, splat<V>(job.scene->camera.origin));
    store3(rays.direction, i, direction);
    store3(rays.throughput, i, Vec3<V>(V(1.0f)));
  }
}

// Radiance that rays of the queue find at their ends: emitting surfaces and the environment.
template <int W>
void add_emission(const ShadeContext& c) {
  using V = Float<W>;
  using I = Int<W>;
  const SceneData& scene = *c.scene;
  const RayQueue& rays = c.rays();
  const HitArray& hits = c.wave->hits;
  const auto add = [&](int i, const Vec3<V>& radiance, V light_pdf, Mask<W> m) LOCKSTEP_LAMBDA {
    const V weight =
        c.bounce == 0 ? V(1.0f) : power_heuristic(load<V>(rays.bsdf_pdf + i), light_pdf);
    add_radiance(c.wave->paths, load<I>(rays.path + i),
                 load3<V>(rays.throughput, i) * radiance * weight, m);
  };
  for (int i = 0; i < rays.count; i += W) {
    const Mask<W> active = lanes_below<W>(i, rays.count);
    const I geometry = load<I>(hits.geometry + i);
    const Mask<W> miss = active & (geometry < I(0));
    if (scene.environment >= 0 && any(miss)) {
      const LightRow<V> light = load_light(scene.lights, I(scene.environment));
      add(i, light.radiance, load<V>(rays.environment_pdf + i) * light.probability, miss);
    }
    if (!scene.area_lights) continue;
    const Mask<W> hit = active & !(geometry < I(0));
    const I first = gather(scene.geometry.first_light, select(hit, geometry, I(0)));
    const Mask<W> emitting = hit & !(first < I(0));
    if (none(emitting)) continue;
    const I entry = select(emitting, first + load<I>(hits.primitive + i), I(0));
    const Emitted<V> e =
        hit_light(scene, gather(scene.light_of_primitive, entry), load3<V>(rays.origin, i),
                  load3<V>(rays.direction, i), load<V>(hits.distance + i));
    // NaN is added too, to be counted.
    add(i, e.radiance, e.pdf, emitting & !(max_component(e.radiance) <= V(0.0f)));
  }
}

// Lists the hits on materials of one kind, in the order of their rays.
template <int W>
void list_hits(const ShadeContext& c, MaterialKind kind) {
  using I = Int<W>;
  ShadeList& list = c.wave->list;
  list.count = 0;
  for (int i = 0; i < c.rays().count; i += W) {
    const I geometry = load<I>(c.wave->hits.geometry + i);
    const Mask<W> hit = lanes_below<W>(i, c.rays().count) & !(geometry < I(0));
    const I material = gather(c.scene->geometry.material, select(hit, geometry, I(0)));
    const Mask<W> listed = hit & (gather(c.scene->materials.kinds, material) == I(int(kind)));
    list.count += compress_store(list.ray + list.count, I(i) + lane_indices<W>(), listed);
  }
  for (int i = list.count; list.count > 0 && i < list.count + 16; ++i) {
    list.ray[i] = list.ray[list.count - 1];
  }
}

template <int W, MaterialKind K>
LOCKSTEP_INLINE void shade_kind(const ShadeContext& c) {
  if (!c.scene->has_material[int(K)]) return;
  list_hits<W>(c, K);
  if (c.wave->list.count > 0) shade<W, K>(c);
}

// Adds the wave's paths to the film, a pixel's samples in ascending order.
inline void deposit(const TileJob& job, const PathTable& paths, TileCounts& counts) {
  for (int i = 0; i < paths.count; ++i) {
    const float r = paths.radiance.x[i], g = paths.radiance.y[i], b = paths.radiance.z[i];
    const std::size_t pixel = paths.pixel[i];
    if (!(is_finite(r) && is_finite(g) && is_finite(b))) {
      if (counts.nonfinite < TileCounts::kept) {
        const auto width = std::size_t(job.film.width);
        counts.bad[counts.nonfinite] = {int(pixel % width), int(pixel / width), paths.sample[i]};
      }
      ++counts.nonfinite;
      continue;
    }
    double* sum = job.film.sum + pixel * 3;
    sum[0] += double(r), sum[1] += double(g), sum[2] += double(b);
    ++job.film.count[pixel];
  }
}

// One wave: at most wave_paths paths, from camera to film. Camera rays are coherent; bounce rays
// are traced as incoherent even where all lanes share their random numbers: the coherent flag gains
// a third in a box of flat walls and loses as much on fine geometry, whose normals scatter them.
template <int W>
void trace_wave(const TileJob& job, Wave& wave, TileCounts& counts) {
  list_paths(job, wave.paths);
  generate_camera_rays<W>(job, wave);
  ShadeContext c{job.scene, &job, &wave, 0, false};
  for (c.bounce = 0; c.rays().count > 0; ++c.bounce) {
    const bool camera = c.bounce == 0;
    intersect<W>(*job.scene, camera, c.rays(), wave.hits, counts);
    (camera ? counts.rays.camera : counts.rays.bounce) += std::uint64_t(c.rays().count);
    if (job.scene->lights.count > 0) add_emission<W>(c);
    if (c.bounce >= job.path.depth) break;
    c.last = c.bounce + 1 >= job.path.depth;
    c.next_rays().count = 0;
    wave.shadows.count = 0;
    shade_kind<W, MaterialKind::Diffuse>(c);
    shade_kind<W, MaterialKind::Conductor>(c);
    shade_kind<W, MaterialKind::Coated>(c);
    trace_shadows<W>(*job.scene, camera && job.path.coherent_shadows, wave.shadows, wave.paths,
                     counts);
  }
  deposit(job, wave.paths, counts);
}

// Splits a tile's job into waves. With many samples per block of lanes a wave covers fewer pixels.
template <int W>
void trace_tile(const TileJob& tile, void* scratch, TileCounts& counts) {
  const unsigned saved_mode = _mm_getcsr();
  _mm_setcsr(saved_mode | 0x8040);  // flush denormals to zero, in results and operands
  Wave& wave = *static_cast<Wave*>(scratch);
  constexpr int tile_pixels = tile_size * tile_size;
  const int wave_samples = std::max(tile.path.lanes.samples, wave_paths / tile_pixels);
  int side = tile_size;
  while (side * side * wave_samples > wave_paths) side /= 2;
  for (std::uint32_t s = 0; s < tile.samples; s += std::uint32_t(wave_samples)) {
    for (int y = tile.y0; y < tile.y1; y += side) {
      for (int x = tile.x0; x < tile.x1; x += side) {
        TileJob job = tile;
        job.x0 = x, job.x1 = std::min(x + side, tile.x1);
        job.y0 = y, job.y1 = std::min(y + side, tile.y1);
        job.first_sample = tile.first_sample + s;
        job.samples = std::min(tile.samples - s, std::uint32_t(wave_samples));
        trace_wave<W>(job, wave, counts);
      }
    }
  }
  _mm_setcsr(saved_mode);
}

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
