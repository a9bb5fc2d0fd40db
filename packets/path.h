// The path integrator: a tile's samples as small waves that are generated, traced in packets,
// compacted, shaded by material, and added to the film. One source for every width.
//
// Which paths share a packet follows from the lane layout and from who is still alive; no value
// depends on it, so every width, layout, thread count and tile order gives the same image.
#pragma once

#include "packets/absorption.h"
#include "packets/emission.h"
#include "packets/flush_denormals.h"
#include "packets/hits.h"
#include "packets/paths.h"
#include "packets/shade.h"
#include "packets/traversal.h"

#include <algorithm>

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

template <int W, MaterialKind K, FeatureMask F>
LOCKSTEP_INLINE void shade_kind(const ShadeContext& c) {
  if (!needs<F>(*c.scene, material_feature(K))) return;
  queue_hits<W, F>(*c.scene, K, c.rays(), *c.wave);
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

// For whoever must tell where a crash was.
inline void note_site(const TileJob& job) {
  RenderSite& site = *job.site;
  site.x0 = job.x0, site.y0 = job.y0, site.x1 = job.x1, site.y1 = job.y1;
  site.first_sample = job.first_sample, site.samples = job.samples;
}

// One wave: at most wave_paths paths, from camera to film.
template <int W, FeatureMask F>
void trace_wave(const TileJob& job, Wave& wave, TileCounts& counts) {
  const SceneData& scene = *job.scene;
  StageClock clock(counts.ticks, Stage::Shading);
  if (job.site) note_site(job);
  begin_paths<W>(job, wave);
  generate_camera_rays<W, F>(job, wave, clock);
  ShadeContext c{&scene, &job, &wave, &clock, 0, false};
  for (c.bounce = 0; c.rays().count > 0; ++c.bounce) {
    if (job.site) job.site->bounce = c.bounce;
    const RayKind kind = c.bounce == 0 ? RayKind::Camera : RayKind::Bounce;
    if (job.log) log_closest(*job.log, kind, c.bounce, c.rays());
    clock.enter(Stage::Traversal);
    trace_closest(scene, *job.traversal_policy, kind, c.bounce, c.rays(), wave.hits, counts);
    clock.enter(Stage::Shading);
    if (needs<F>(scene, Feature::Absorption))
      absorb_on_the_way<W>(scene, wave.hits, wave.rays[c.bounce & 1]);
    if (scene.lights.count > 0) add_emission<W, F>(c);
    if (c.bounce >= job.path.depth) break;
    if (needs<F>(scene, Feature::Mix)) {
      resolve_mixes<W, F>(job, wave.paths, c.rays(), c.bounce, wave.hits);
    }
    c.last = c.bounce + 1 >= job.path.depth;
    c.next_rays().count = 0;
    wave.shadows.count = 0;
    shade_kind<W, MaterialKind::Diffuse, F>(c);
    shade_kind<W, MaterialKind::Conductor, F>(c);
    shade_kind<W, MaterialKind::Coated, F>(c);
    shade_kind<W, MaterialKind::RoughDiffuse, F>(c);
    shade_kind<W, MaterialKind::DiffuseTransmission, F>(c);
    shade_kind<W, MaterialKind::Dielectric, F>(c);
    shade_kind<W, MaterialKind::Principled, F>(c);
    shade_kind<W, MaterialKind::Measured, F>(c);
    if (job.log) log_shadows(*job.log, c.bounce, wave.shadows);
    clock.enter(Stage::Traversal);
    trace_occluded(scene, *job.traversal_policy, c.bounce, wave.shadows, counts);
    clock.enter(Stage::Shading);
    add_direct_light<W>(wave.shadows, wave.paths);
  }
  clock.enter(Stage::Film);
  end_paths<F>(job, wave.paths, counts);
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
