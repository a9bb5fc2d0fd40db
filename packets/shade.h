// Shading, one kind of material at a time in full packets: direct light by light sampling, then a
// direction to go on. Both techniques are weighted by the power heuristic (Veach 1997, section
// 9.2), in which emission found by the next ray takes its part.
//
// At the last interaction a diffuse surface relies on light sampling alone: it needs no further
// ray, and cosine sampling would rarely win there.
#pragma once

#include "core/bsdf.h"
#include "core/bsdf/dielectric.h"
#include "core/bsdf/diffuse_transmission.h"
#include "core/bsdf/metal.h"
#include "core/bsdf/oren_nayar.h"
#include "core/bsdf/principled.h"
#include "core/ggx_albedo.h"
#include "core/light.h"
#include "packets/absorption.h"
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
  if constexpr (K == MaterialKind::Conductor) return load_metal(table, material);
  if constexpr (K == MaterialKind::Coated) return load_coated(table, material);
  if constexpr (K == MaterialKind::RoughDiffuse) return load_oren_nayar(table, material);
  if constexpr (K == MaterialKind::DiffuseTransmission) {
    return load_diffuse_transmission(table, material);
  }
  if constexpr (K == MaterialKind::Dielectric) return load_dielectric(table, material);
  if constexpr (K == MaterialKind::Principled) return load_principled(table, material);
}

// Models that choose between lobes by a sample of their own.
constexpr bool has_lobes(MaterialKind kind) {
  return kind == MaterialKind::Coated || kind == MaterialKind::DiffuseTransmission ||
         kind == MaterialKind::Dielectric || kind == MaterialKind::Principled;
}

// What single scattering loses, where it is to be put back.
template <class V, class Bsdf>
LOCKSTEP_INLINE void compensate(const SceneData&, const Vec3<V>&, Bsdf&) {}
template <class V>
LOCKSTEP_INLINE void compensate(const SceneData& scene, const Vec3<V>& wo, MetalBsdf<V>& bsdf) {
  const float* table = scene.materials.ggx_albedo;
  if (table) bsdf.lost = ggx_loss(table, wo.z, bsdf.conductor.ggx.alpha);
}
template <class V>
LOCKSTEP_INLINE void compensate(const SceneData& scene, const Vec3<V>& wo,
                                PrincipledBsdf<V>& bsdf) {
  const float* table = scene.materials.ggx_albedo;
  if (table) bsdf.lost = ggx_loss(table, wo.z, Vec2<V>(bsdf.alpha));
}

// True where no light can be sampled: all lanes are mirrors or clear glass.
template <class Bsdf>
LOCKSTEP_INLINE bool all_delta(const Bsdf&) {
  return false;
}
template <class V>
LOCKSTEP_INLINE bool all_delta(const MetalBsdf<V>& bsdf) {
  return all(is_smooth(bsdf.conductor.ggx));
}
template <class V>
LOCKSTEP_INLINE bool all_delta(const DielectricBsdf<V>& bsdf) {
  return all(is_delta(bsdf));
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
template <MaterialKind K, FeatureMask F>
LOCKSTEP_INLINE bool continues(const ShadeContext& c) {
  return !(c.last && K == MaterialKind::Diffuse) || needs<F>(*c.scene, Feature::TexturedLights);
}

template <FeatureMask F>
LOCKSTEP_INLINE bool plays_roulette(const ShadeContext& c) {
  if (needs<F>(*c.scene, Feature::Lens) && c.bounce == 0) return false;  // see lens_pair
  return c.bounce + 1 >= c.job->path.roulette_depth;
}

// General kernels share what all kinds of material need as functions; others have it inlined.
template <FeatureMask F>
inline constexpr bool is_general = F == all_features;

template <class V, FeatureMask F, bool both_sides>
[[gnu::noinline]] void sample_light_apart(const SceneData& scene, const IntOf<V>& light,
                                          const Surface<V>& surface, const Vec2<V>& u,
                                          LightSample<V>& out) {
  out = sample_light<V, F, both_sides>(scene, light, surface.origin, surface.frame, u);
}
template <class V, FeatureMask F, bool both_sides>
LOCKSTEP_INLINE LightSample<V> sample_light_at(const SceneData& scene, const IntOf<V>& light,
                                               const Surface<V>& surface, const Vec2<V>& u) {
  if constexpr (!is_general<F>) {
    return sample_light<V, F, both_sides>(scene, light, surface.origin, surface.frame, u);
  }
  LightSample<V> s;
  sample_light_apart<V, F, both_sides>(scene, light, surface, u, s);
  return s;
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
  if (needs<F>(*c.scene, Feature::LightChoice) || has_lobes(K)) draw(Purpose::Choice);
  if (continues<K, F>(c)) draw(Purpose::Bsdf);
  if (continues<K, F>(c) && plays_roulette<F>(c)) draw(Purpose::Roulette);
}

// A direction between the viewer's frame (wo.z > 0) and that of a model that takes both sides,
// where the outside has z > 0.
template <class Bsdf, class V>
LOCKSTEP_INLINE Vec3<V> turned(const Surface<V>& surface, const Vec3<V>& w) {
  if constexpr (!transmits<Bsdf>) return w;
  return {w.x, w.y, select(surface.outside, w.z, -w.z)};
}

// True where a direction, local and in the world, leads to where the model may send light; z > 0 is
// the viewer's side.
template <class Bsdf, class V>
LOCKSTEP_INLINE MaskOf<V> is_possible(const Surface<V>& surface, const Vec3<V>& local,
                                      const Vec3<V>& world) {
  const V side = dot(surface.geometric_normal, world);
  if constexpr (transmits<Bsdf>) return side * local.z > V(0.0f);
  return (local.z > V(0.0f)) & (side > V(0.0f));
}

template <class Bsdf, class V>
LOCKSTEP_INLINE Vec3<V> origin_towards(const Surface<V>& surface, const Vec3<V>& local) {
  if constexpr (!transmits<Bsdf>) return surface.origin;
  return select<V>(local.z > V(0.0f), surface.origin, surface.origin_beyond);
}

// Light sampling: a shadow ray for every lane that may receive something.
template <FeatureMask F, class Bsdf, class V>
LOCKSTEP_INLINE void sample_direct_light(const ShadeContext& c, const Surface<V>& surface,
                                         const Bsdf& bsdf, const Vec3<V>& throughput, int i,
                                         MaskOf<V> active, bool alone) {
  using I = IntOf<V>;
  if (all_delta(bsdf)) return;
  const SceneData& scene = *c.scene;
  const ShadeQueue& queue = c.wave->hits_to_shade;
  const auto value = [&](const FloatArray* a, Purpose p)
                         LOCKSTEP_LAMBDA { return load<V>(a[int(p)] + i); };
  const I light = needs<F>(scene, Feature::LightChoice)
                      ? choose_light(scene.lights, value(queue.u, Purpose::Choice))
                      : I(0);
  const LightSample<V> s = sample_light_at<V, F, transmits<Bsdf>>(
      scene, light, surface,
      Vec2<V>(value(queue.u, Purpose::Light), value(queue.v, Purpose::Light)));
  const Vec3<V> wi = surface.frame.to_local(s.wi);
  MaskOf<V> lit = active & (s.pdf > V(0.0f)) & is_possible<Bsdf>(surface, wi, s.wi);
  if (none(lit)) return;
  const BsdfValue<V> f = eval(bsdf, turned<Bsdf>(surface, surface.wo), turned<Bsdf>(surface, wi));
  V weight = alone ? V(1.0f) : power_heuristic(s.pdf, f.pdf);
  if (needs_any<F>(scene, delta_light_features)) weight = select(s.delta, V(1.0f), weight);
  Vec3<V> radiance = throughput * f.f_cos * s.radiance * (weight / s.pdf);
  if (needs<F>(scene, Feature::Absorption)) {
    radiance = radiance * transmittance(scene, load<I>(queue.medium + i), s.distance);
  }
  lit = lit & !(max_component(radiance) <= V(0.0f));  // NaN goes on, to be counted

  ShadowQueue& out = c.wave->shadows;
  const Packing<width_of<V>> lanes(lit);
  pack3(lanes, out.origin, out.count, origin_towards<Bsdf>(surface, wi));
  pack3(lanes, out.direction, out.count, s.wi);
  lanes.store(out.distance + out.count, s.distance * V(1.0f - 0x1p-12f));
  pack3(lanes, out.radiance, out.count, radiance);
  lanes.store(out.path + out.count, load<I>(queue.path + i));
  out.count += lanes.count();
}

// The medium after crossing a dielectric's boundary, or not.
template <class V>
LOCKSTEP_INLINE IntOf<V> medium_beyond(const DielectricBsdf<V>& bsdf, const Surface<V>& surface,
                                       IntOf<V> material, IntOf<V> medium, MaskOf<V> crossed) {
  using I = IntOf<V>;
  return select(crossed & !bsdf.thin, select(surface.outside, material, I(-1)), medium);
}
template <class Bsdf, class V>
LOCKSTEP_INLINE IntOf<V> medium_beyond(const Bsdf&, const Surface<V>&, IntOf<V>, IntOf<V> medium,
                                       MaskOf<V>) {
  return medium;
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

// The models of the hits at i..., all of kind K.
template <int W, MaterialKind K, FeatureMask F>
LOCKSTEP_INLINE auto load_bsdf_at(const SceneData& scene, const Surface<Float<W>>& surface,
                                  const Int<W>& material, const Mask<W>& active) {
  MaterialRows<W> rows;
  MaterialTable table = scene.materials;
  Int<W> row = material;
  if (needs<F>(scene, Feature::Textures)) {
    load_textured_rows<W>(scene, material, active, surface.uv, rows);
    table.parameters = rows.parameters;
    row = lane_indices<W>();
  }
  auto bsdf = load_bsdf<K>(table, row);
  compensate(scene, surface.wo, bsdf);
  return bsdf;
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
      sample_direct_light<F>(c, surface, bsdf, throughput, i, active, !go_on);
    }
    if (go_on) {
      const V lobe = has_lobes(K) ? load<V>(queue.v[int(Purpose::Choice)] + i) : V(0.0f);
      continue_paths<F>(c, surface, bsdf, throughput, i, active, lobe, material);
    }
  }
}

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
