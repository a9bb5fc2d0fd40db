// The path integrator: a tile's samples as small waves that are generated, traced in packets,
// compacted, shaded by material, and added to the film. One source for every width.
//
// Which paths share a packet follows from the lane layout and from who is still alive; no value
// depends on it, so every width, layout, thread count and tile order gives the same image.
#pragma once

#include "packets/flush_denormals.h"
#include "packets/paths.h"
#include "packets/shade.h"
#include "packets/traversal.h"

#include <algorithm>

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

// Radiance that rays of the queue find at their ends: emitting surfaces and the environment.
template <int W, FeatureMask F>
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
    if (needs<F>(scene, Feature::Environment) && any(miss)) {
      const LightRow<V> light = load_light(scene.lights, I(scene.environment));
      add(i, light.radiance, load<V>(rays.environment_pdf + i) * light.probability, miss);
    }
    if (!has_area_lights<F>(scene)) continue;
    const Mask<W> hit = active & !(geometry < I(0));
    const I first =
        gather(scene.geometry.rows + 2, select(hit, geometry, I(0)) * I(geometry_stride));
    const Mask<W> emitting = hit & !(first < I(0));
    if (none(emitting)) continue;
    const I entry = select(emitting, first + load<I>(hits.primitive + i), I(0));
    const Emitted<V> e =
        hit_light<V, F>(scene, gather(scene.light_of_primitive, entry), load3<V>(rays.origin, i),
                        load3<V>(rays.direction, i), load<V>(hits.distance + i));
    // NaN is added too, to be counted.
    add(i, e.radiance, e.pdf, emitting & !(max_component(e.radiance) <= V(0.0f)));
  }
}

// Copies the hits on materials of kind K side by side, in the order of their rays.
template <int W, MaterialKind K, FeatureMask F>
void queue_hits(const ShadeContext& c) {
  using V = Float<W>;
  using I = Int<W>;
  const SceneData& scene = *c.scene;
  const RayQueue& rays = c.rays();
  const HitArray& hits = c.wave->hits;
  ShadeQueue& out = c.wave->hits_to_shade;
  const bool other_kinds =
      (scene.features & F & material_features & ~bit(material_feature(K))) != 0;
  int n = 0;
  for (int i = 0; i < rays.count; i += W) {
    const I geometry = load<I>(hits.geometry + i);
    Mask<W> taken = lanes_below<W>(i, rays.count) & !(geometry < I(0));
    if (other_kinds) {
      const I row = select(taken, geometry, I(0)) * I(geometry_stride);
      const I kind = as_int(as_uint(gather(scene.geometry.rows + 3, row)) >> geometry_kind_shift);
      taken = taken & (kind == I(int(K)));
    }
    const Packing<W> lanes(taken);
    pack3(lanes, out.direction, n, load3<V>(rays.direction, i));
    pack3(lanes, out.throughput, n, load3<V>(rays.throughput, i));
    lanes.store(out.barycentric_u + n, load<V>(hits.u + i));
    lanes.store(out.barycentric_v + n, load<V>(hits.v + i));
    lanes.store(out.geometry + n, geometry);
    lanes.store(out.primitive + n, load<I>(hits.primitive + i));
    lanes.store(out.path + n, load<I>(rays.path + i));
    if (needs<F>(scene, Feature::Spheres)) {
      pack3(lanes, out.origin, n, load3<V>(rays.origin, i));
      lanes.store(out.distance + n, load<V>(hits.distance + i));
    }
    n += lanes.count();
  }
  out.count = n;
  if (n == 0) return;
  // Lanes behind the last hit repeat what is used as an index.
  for (int i = n; i < n + W; ++i) {
    out.geometry[i] = out.geometry[n - 1];
    out.primitive[i] = out.primitive[n - 1];
    out.path[i] = out.path[n - 1];
  }
}

template <int W, MaterialKind K, FeatureMask F>
LOCKSTEP_INLINE void shade_kind(const ShadeContext& c) {
  if (!needs<F>(*c.scene, material_feature(K))) return;
  queue_hits<W, K, F>(c);
  if (c.wave->hits_to_shade.count > 0) shade<W, K, F>(c);
}

// Adds the radiance of every shadow ray that reached its light.
template <int W>
void add_direct_light(const ShadowQueue& shadows, PathTable& paths) {
  using V = Float<W>;
  for (int i = 0; i < shadows.count; i += W) {
    const Mask<W> lit =
        lanes_below<W>(i, shadows.count) & (load<V>(shadows.distance + i) >= V(0.0f));
    add_radiance(paths, load<Int<W>>(shadows.path + i), load3<V>(shadows.radiance, i), lit);
  }
}

inline void log_closest(RayLog& log, RayKind kind, int bounce, const RayQueue& q) {
  log.append(kind, bounce, q.count,
             {{q.origin.x, q.origin.y, q.origin.z},
              {q.direction.x, q.direction.y, q.direction.z},
              nullptr});
}
inline void log_shadows(RayLog& log, int bounce, const ShadowQueue& q) {
  log.append(RayKind::Shadow, bounce, q.count,
             {{q.origin.x, q.origin.y, q.origin.z},
              {q.direction.x, q.direction.y, q.direction.z},
              q.distance});
}

// One wave: at most wave_paths paths, from camera to film.
template <int W, FeatureMask F>
void trace_wave(const TileJob& job, Wave& wave, TileCounts& counts) {
  const SceneData& scene = *job.scene;
  StageClock clock(counts.ticks, Stage::Shading);
  begin_paths<W>(job, wave);
  generate_camera_rays<W, F>(job, wave, clock);
  ShadeContext c{&scene, &job, &wave, &clock, 0, false};
  for (c.bounce = 0; c.rays().count > 0; ++c.bounce) {
    const RayKind kind = c.bounce == 0 ? RayKind::Camera : RayKind::Bounce;
    if (job.log) log_closest(*job.log, kind, c.bounce, c.rays());
    clock.enter(Stage::Traversal);
    trace_closest(scene, *job.traversal_policy, kind, c.bounce, c.rays(), wave.hits, counts);
    clock.enter(Stage::Shading);
    if (scene.lights.count > 0) add_emission<W, F>(c);
    if (c.bounce >= job.path.depth) break;
    c.last = c.bounce + 1 >= job.path.depth;
    c.next_rays().count = 0;
    wave.shadows.count = 0;
    shade_kind<W, MaterialKind::Diffuse, F>(c);
    shade_kind<W, MaterialKind::Conductor, F>(c);
    shade_kind<W, MaterialKind::Coated, F>(c);
    if (job.log) log_shadows(*job.log, c.bounce, wave.shadows);
    clock.enter(Stage::Traversal);
    trace_occluded(scene, *job.traversal_policy, c.bounce, wave.shadows, counts);
    clock.enter(Stage::Shading);
    add_direct_light<W>(wave.shadows, wave.paths);
  }
  clock.enter(Stage::Film);
  end_paths(job, wave.paths, counts);
}

// Samples of a tile in waves. With many samples per block of lanes a wave covers fewer pixels.
template <int W, FeatureMask F>
void trace_samples(const TileJob& part, Wave& wave, TileCounts& counts) {
  constexpr int tile_pixels = tile_size * tile_size;
  const int wave_samples = std::max(part.lanes.samples, wave_paths / tile_pixels);
  int side = tile_size;
  while (side * side * wave_samples > wave_paths) side /= 2;
  for (std::uint32_t s = 0; s < part.samples; s += std::uint32_t(wave_samples)) {
    for (int y = part.y0; y < part.y1; y += side) {
      for (int x = part.x0; x < part.x1; x += side) {
        TileJob job = part;
        job.x0 = x, job.x1 = std::min(x + side, part.x1);
        job.y0 = y, job.y1 = std::min(y + side, part.y1);
        job.first_sample = part.first_sample + s;
        job.samples = std::min(part.samples - s, std::uint32_t(wave_samples));
        trace_wave<W, F>(job, wave, counts);
      }
    }
  }
  count_layout(counts, {part.lanes, std::uint64_t(part.x1 - part.x0) *
                                        std::uint64_t(part.y1 - part.y0) * part.samples});
}

template <int W, FeatureMask F>
void trace_in_layouts(TileJob tile, Wave& wave, TileCounts& counts) {
  const LayoutPlan plan = tile.layout_policy->plan(tile.samples);
  tile.lanes = plan.lanes;
  if (!plan.trial) return trace_samples<W, F>(tile, wave, counts);
  const std::uint32_t all = tile.samples, half = all / 2;
  double ticks_per_sample[2];  // in the plan's layout, in the trial's
  for (const bool second : {false, true}) {
    const bool trial = second != plan.trial_first;
    tile.lanes = trial ? *plan.trial : plan.lanes;
    tile.samples = second ? all - half : half;
    const std::uint64_t start = read_ticks();
    trace_samples<W, F>(tile, wave, counts);
    ticks_per_sample[trial] = double(read_ticks() - start) / tile.samples;
    tile.first_sample += tile.samples;
  }
  tile.layout_policy->record(ticks_per_sample[1], ticks_per_sample[0]);
}

template <int W, FeatureMask F>
void trace_tile(const TileJob& tile, void* scratch, TileCounts& counts) {
  const FlushDenormals flush;
  trace_in_layouts<W, F>(tile, *static_cast<Wave*>(scratch), counts);
}

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
