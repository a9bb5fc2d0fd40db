// Shading, one kind of material at a time in full packets: direct light by light sampling, then a
// direction to go on. Both techniques are weighted by the power heuristic (Veach 1997, section
// 9.2), in which emission found by the next ray takes its part.
//
// At the last interaction a diffuse surface relies on light sampling alone: it needs no further
// ray, and cosine sampling would rarely win there.
#pragma once

#include "packets/direct_light.h"
#include "samplers/sampler.h"

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

// True where a surface of this kind sends a ray on from here.
template <MaterialKind K, FeatureMask F>
LOCKSTEP_INLINE bool continues(const ShadeContext& c) {
  return !(c.last && K == MaterialKind::Diffuse) || needs<F>(*c.scene, Feature::TexturedLights);
}

template <FeatureMask F>
LOCKSTEP_INLINE bool plays_roulette(const ShadeContext& c) {
  if (needs<F>(*c.scene, Feature::Lens) && c.bounce == 0) return false;  // see lens_pair
  return c.bounce + 1 >= c.job->path.roulette_depth;
}

template <int W, FeatureMask F>
[[gnu::noinline]] void load_surface_apart(const SceneData& scene, const ShadeQueue& queue, int i,
                                          const Rows<Int<W>>& geometry, Surface<Float<W>>& out) {
  out = load_surface<W, F>(scene, queue, i, geometry);
}
template <int W, FeatureMask F>
LOCKSTEP_INLINE Surface<Float<W>> load_surface_at(const SceneData& scene, const ShadeQueue& queue,
                                                  int i, const Rows<Int<W>>& geometry) {
  if constexpr (!is_general<F>) return load_surface<W, F>(scene, queue, i, geometry);
  Surface<Float<W>> s;
  load_surface_apart<W, F>(scene, queue, i, geometry, s);
  return s;
}

// Draws the values that this interaction needs, and no others, for all paths in the queue.
template <int W, MaterialKind K, FeatureMask F>
void draw_samples(const ShadeContext& c) {
  ShadeQueue& queue = c.wave->hits_to_shade;
  const PathTable& paths = c.wave->paths;
  for (int i = 0; i < queue.count; i += W) {
    const Int<W> path = load<Int<W>>(queue.path + i);
    store(queue.pixel + i, gather(paths.pixel, path));
    store(queue.sample + i, gather(paths.sample, path));
  }
  const SampleBatch batch{queue.pixel, queue.sample, queue.count, c.job->first_sample,
                          int(c.job->samples)};
  const auto draw = [&](Purpose purpose) {
    fill_pair<W>(*c.job->sampler, batch, sample_pair(c.bounce, purpose), queue.u[int(purpose)],
                 queue.v[int(purpose)]);
  };
  if (c.scene->lights.count > 0) draw(Purpose::Light);
  if (has_lobes(K)) draw(Purpose::Choice);
  if (continues<K, F>(c)) draw(Purpose::Bsdf);
  if (continues<K, F>(c) && plays_roulette<F>(c)) draw(Purpose::Roulette);
}

// BSDF sampling: the next ray of every path that survives.
template <FeatureMask F, class Bsdf, class V>
LOCKSTEP_INLINE void continue_paths(const ShadeContext& c, const Surface<V>& surface,
                                    const Bsdf& bsdf, Vec3<V> throughput, int i, MaskOf<V> active,
                                    V lobe, IntOf<V> material) {
  using I = IntOf<V>;
  const SceneData& scene = *c.scene;
  const ShadeQueue& queue = c.wave->hits_to_shade;
  const auto s = sample(
      bsdf, turned<Bsdf>(surface, surface.wo), lobe,
      Vec2<V>(load<V>(queue.u[int(Purpose::Bsdf)] + i), load<V>(queue.v[int(Purpose::Bsdf)] + i)));
  const Vec3<V> wi = turned<Bsdf>(surface, s.wi);
  const Vec3<V> direction = surface.frame.to_world(wi);
  throughput = throughput * s.weight;
  MaskOf<V> alive = active & (s.pdf > V(0.0f)) & is_possible<Bsdf>(surface, wi, direction) &
                    !(max_component(throughput) <= V(0.0f));
  V eta_scale(1.0f);
  if (refracts<F>(scene)) eta_scale = load<V>(queue.eta_scale + i) * radiance_scale(s);
  if (plays_roulette<F>(c)) {
    V survival = max_component(throughput);
    if (refracts<F>(scene)) survival = survival / eta_scale;
    survival = min(survival, V(1.0f));
    alive = alive & !(load<V>(queue.u[int(Purpose::Roulette)] + i) >= survival);
    throughput = throughput * (V(1.0f) / survival);
  }
  if (none(alive)) return;

  RayQueue& out = c.next_rays();
  const Packing<width_of<V>> lanes(alive);
  pack3(lanes, out.origin, out.count, origin_towards<Bsdf>(surface, wi));
  pack3(lanes, out.direction, out.count, direction);
  pack3(lanes, out.throughput, out.count, throughput);
  // No other technique finds what a mirror shows: as if with infinite density.
  const V infinite(std::numeric_limits<float>::infinity());
  lanes.store(out.bsdf_pdf + out.count, select(is_delta(s), infinite, s.pdf));
  if (needs<F>(scene, Feature::Environment)) {
    lanes.store(out.environment_pdf + out.count, environment_pdf<transmits<Bsdf>>(wi.z));
  }
  if (refracts<F>(scene)) lanes.store(out.eta_scale + out.count, eta_scale);
  if (needs<F>(scene, Feature::Absorption)) {
    lanes.store(out.medium + out.count,
                medium_beyond(bsdf, surface, material, load<I>(queue.medium + i), wi.z < V(0.0f)));
  }
  lanes.store(out.path + out.count, load<I>(queue.path + i));
  out.count += lanes.count();
}

// Shades the queued hits, all on materials of kind K.
template <int W, MaterialKind K, FeatureMask F>
void shade(const ShadeContext& c) {
  using V = Float<W>;
  using I = Int<W>;
  const SceneData& scene = *c.scene;
  c.clock->enter(Stage::Sampling);
  draw_samples<W, K, F>(c);
  c.clock->enter(Stage::Shading);
  const ShadeQueue& queue = c.wave->hits_to_shade;
  const bool go_on = continues<K, F>(c);
  constexpr FeatureMask listed = feature_set(Feature::Textures, Feature::SurfaceMaps, Feature::Mix);
  for (int i = 0; i < queue.count; i += W) {
    Mask<W> active = lanes_below<W>(i, queue.count);
    const Rows<I> geometry =
        gather_rows(scene.geometry.rows, load<I>(queue.geometry + i) * I(geometry_stride));
    const I material = needs_any<F>(scene, listed) ? load<I>(queue.material + i) : geometry.y;
    const Surface<V> surface = load_surface_at<W, F>(scene, queue, i, geometry);
    if (needs<F>(scene, Feature::OneSided)) {
      const Mask<W> one_sided = (geometry.w & I(geometry_is_one_sided)) != I(0);
      active = active & !(one_sided & !surface.outside);
      if (none(active)) continue;
    }
    const auto bsdf = load_bsdf_at<W, K, F>(scene, surface, material, active);
    const Vec3<V> throughput = load3<V>(queue.throughput, i);
    if (scene.lights.count > 0) {
      sample_direct_light<F>(c, surface, bsdf, throughput, i, active, material, !go_on);
    }
    if (go_on) {
      const V lobe = has_lobes(K) ? load<V>(queue.v[int(Purpose::Choice)] + i) : V(0.0f);
      continue_paths<F>(c, surface, bsdf, throughput, i, active, lobe, material);
    }
  }
}

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
