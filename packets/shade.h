// Shading, one kind of material at a time in full packets: direct light by light sampling, then a
// direction to go on. Both techniques are weighted by the power heuristic (Veach 1997, section
// 9.2), in which emission found by the next ray takes its part.
//
// At the last interaction a diffuse surface relies on light sampling alone: it needs no further
// ray, and cosine sampling would rarely win there.
#pragma once

#include "core/bsdf.h"
#include "core/light.h"
#include "packets/stage_clock.h"
#include "packets/surface.h"
#include "samplers/dimensions.h"
#include "samplers/sampler.h"

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

// Weight of a technique with density `a` against one with density `b`, power heuristic, beta = 2.
template <class V>
LOCKSTEP_INLINE V power_heuristic(V a, V b) {
  const V ratio = b / a;
  return V(1.0f) / fma(ratio, ratio, V(1.0f));
}

template <MaterialKind K, class I>
LOCKSTEP_INLINE auto load_bsdf(const MaterialTable& table, I material) {
  if constexpr (K == MaterialKind::Diffuse) return load_diffuse(table, material);
  if constexpr (K == MaterialKind::Conductor) return load_conductor(table, material);
  if constexpr (K == MaterialKind::Coated) return load_coated(table, material);
}

struct ShadeContext {
  const SceneData* scene;
  const TileJob* job;
  Wave* wave;
  StageClock* clock;
  int bounce;  // of this interaction, from 0
  bool last;   // no further interaction is lit

  const RayQueue& rays() const { return wave->rays[bounce & 1]; }
  RayQueue& next_rays() const { return wave->rays[(bounce + 1) & 1]; }
};

// True where a surface of this kind sends a ray on from here.
template <MaterialKind K>
LOCKSTEP_INLINE bool continues(const ShadeContext& c) {
  return !(c.last && K == MaterialKind::Diffuse);
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
  if (needs<F>(*c.scene, Feature::LightChoice) || K == MaterialKind::Coated) draw(Purpose::Choice);
  if (continues<K>(c)) draw(Purpose::Bsdf);
  if (continues<K>(c) && c.bounce + 1 >= c.job->path.roulette_depth) draw(Purpose::Roulette);
}

// Light sampling: a shadow ray for every lane that may receive something.
template <FeatureMask F, class Bsdf, class V>
LOCKSTEP_INLINE void sample_direct_light(const ShadeContext& c, const Surface<V>& surface,
                                         const Bsdf& bsdf, const Vec3<V>& throughput, int i,
                                         MaskOf<V> active, bool alone) {
  using I = IntOf<V>;
  const ShadeQueue& queue = c.wave->hits_to_shade;
  const auto value = [&](const FloatArray* a, Purpose p)
                         LOCKSTEP_LAMBDA { return load<V>(a[int(p)] + i); };
  const I light = needs<F>(*c.scene, Feature::LightChoice)
                      ? choose_light(c.scene->lights, value(queue.u, Purpose::Choice))
                      : I(0);
  const LightSample<V> s =
      sample_light<V, F>(*c.scene, light, surface.origin, surface.frame,
                         Vec2<V>(value(queue.u, Purpose::Light), value(queue.v, Purpose::Light)));
  const Vec3<V> wi = surface.frame.to_local(s.wi);
  MaskOf<V> lit = active & (s.pdf > V(0.0f)) & (wi.z > V(0.0f)) &
                  (dot(surface.geometric_normal, s.wi) > V(0.0f));
  if (none(lit)) return;
  const BsdfValue<V> f = eval(bsdf, surface.wo, wi);
  const V weight = alone ? V(1.0f) : select(s.delta, V(1.0f), power_heuristic(s.pdf, f.pdf));
  const Vec3<V> radiance = throughput * f.f_cos * s.radiance * (weight / s.pdf);
  lit = lit & !(max_component(radiance) <= V(0.0f));  // NaN goes on, to be counted

  ShadowQueue& out = c.wave->shadows;
  const Packing<width_of<V>> lanes(lit);
  pack3(lanes, out.origin, out.count, surface.origin);
  pack3(lanes, out.direction, out.count, s.wi);
  lanes.store(out.distance + out.count, s.distance * V(1.0f - 0x1p-12f));
  pack3(lanes, out.radiance, out.count, radiance);
  lanes.store(out.path + out.count, load<I>(queue.path + i));
  out.count += lanes.count();
}

// BSDF sampling: the next ray of every path that survives.
template <FeatureMask F, class Bsdf, class V>
LOCKSTEP_INLINE void continue_paths(const ShadeContext& c, const Surface<V>& surface,
                                    const Bsdf& bsdf, Vec3<V> throughput, int i, MaskOf<V> active,
                                    V lobe) {
  const ShadeQueue& queue = c.wave->hits_to_shade;
  const BsdfSample<V> s = sample(
      bsdf, surface.wo, lobe,
      Vec2<V>(load<V>(queue.u[int(Purpose::Bsdf)] + i), load<V>(queue.v[int(Purpose::Bsdf)] + i)));
  const Vec3<V> direction = surface.frame.to_world(s.wi);
  throughput = throughput * s.weight;
  MaskOf<V> alive = active & (s.pdf > V(0.0f)) & (s.wi.z > V(0.0f)) &
                    (dot(surface.geometric_normal, direction) > V(0.0f)) &
                    !(max_component(throughput) <= V(0.0f));
  if (c.bounce + 1 >= c.job->path.roulette_depth) {
    const V survival = min(max_component(throughput), V(1.0f));
    alive = alive & !(load<V>(queue.u[int(Purpose::Roulette)] + i) >= survival);
    throughput = throughput * (V(1.0f) / survival);
  }
  if (none(alive)) return;

  RayQueue& out = c.next_rays();
  const Packing<width_of<V>> lanes(alive);
  pack3(lanes, out.origin, out.count, surface.origin);
  pack3(lanes, out.direction, out.count, direction);
  pack3(lanes, out.throughput, out.count, throughput);
  lanes.store(out.bsdf_pdf + out.count, s.pdf);
  if (needs<F>(*c.scene, Feature::Environment)) {
    lanes.store(out.environment_pdf + out.count, cosine_hemisphere_pdf(s.wi.z));
  }
  lanes.store(out.path + out.count, load<IntOf<V>>(queue.path + i));
  out.count += lanes.count();
}

// Shades the queued hits, all on materials of kind K.
template <int W, MaterialKind K, FeatureMask F>
void shade(const ShadeContext& c) {
  using V = Float<W>;
  using I = Int<W>;
  c.clock->enter(Stage::Sampling);
  draw_samples<W, K, F>(c);
  c.clock->enter(Stage::Shading);
  const ShadeQueue& queue = c.wave->hits_to_shade;
  const bool go_on = continues<K>(c);
  for (int i = 0; i < queue.count; i += W) {
    const Mask<W> active = lanes_below<W>(i, queue.count);
    const Rows<I> geometry =
        gather_rows(c.scene->geometry.rows, load<I>(queue.geometry + i) * I(geometry_stride));
    const Surface<V> surface = load_surface<W, F>(*c.scene, queue, i, geometry);
    const auto bsdf = load_bsdf<K>(c.scene->materials, geometry.y);
    const Vec3<V> throughput = load3<V>(queue.throughput, i);
    if (c.scene->lights.count > 0) {
      sample_direct_light<F>(c, surface, bsdf, throughput, i, active, !go_on);
    }
    if (go_on) {
      const V lobe =
          K == MaterialKind::Coated ? load<V>(queue.v[int(Purpose::Choice)] + i) : V(0.0f);
      continue_paths<F>(c, surface, bsdf, throughput, i, active, lobe);
    }
  }
}

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
