// Light sampling at a surface: the light, the model's response, the shadow ray.
#pragma once

#include "core/light.h"
#include "packets/absorption.h"
#include "packets/bsdf_models.h"
#include "packets/shade_context.h"
#include "samplers/dimensions.h"

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

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

// How far nothing may be in the way. Ends before the light by more than what rounding makes of the
// distance and of the light's coordinates, which are taken to be those of the surface plus the
// distance: else far from the origin tilted lights would hide themselves.
template <class V>
LOCKSTEP_INLINE V shadow_distance(const Surface<V>& surface, V distance) {
  const V rounding = V(offset_scale) * max_component(abs(surface.origin));
  return max(fma(distance, V(1.0f - 0x1p-12f), -rounding), V(0.0f));
}

// What the textures of the lanes' lights say where these were sampled; 1 for lights without.
template <FeatureMask F, class V>
[[gnu::noinline]] Vec3<V> sampled_glow(const SceneData& scene, const IntOf<V>& index,
                                       const Vec2<V>& place, const MaskOf<V>& lanes) {
  const LightRow<V> light = load_light(scene.lights, index);
  const MaskOf<V> textured = lanes & is_textured(light);
  if (none(textured)) return Vec3<V>(V(1.0f));
  const Glow<V> glow = load_glow(scene.lights, light);
  const Corners<V> corners{light.corner, light.corner + light.edge1, light.corner + light.edge2};
  const TextureCoordinates<V> t = triangle_coordinates(corners, glow.uvs, place.x, place.y);
  TexturePoint<V> at{t.uv, {}};
  if (needs<F>(scene, Feature::Trilinear)) {
    at.footprint = footprint_at<F>(scene, t, corners.at(place.x, place.y), light.normal);
  }
  return glow_color(scene, to_int(select(textured, glow.binding, V(0.0f))), textured, at);
}

// Light sampling: a shadow ray for every lane that may receive something.
template <FeatureMask F, class Bsdf, class V>
LOCKSTEP_INLINE void sample_direct_light(const ShadeContext& c, const Surface<V>& surface,
                                         const Bsdf& bsdf, const Vec3<V>& throughput, int i,
                                         MaskOf<V> active, const IntOf<V>& material, bool alone) {
  using I = IntOf<V>;
  if (all_delta(bsdf)) return;
  const SceneData& scene = *c.scene;
  const ShadeQueue& queue = c.wave->hits_to_shade;
  LightChoice<V> light{
      I(0), {load<V>(queue.u[int(Purpose::Light)] + i), load<V>(queue.v[int(Purpose::Light)] + i)}};
  if (needs<F>(scene, Feature::LightChoice)) light = choose_light(scene.lights, light.u);
  const LightSample<V> s =
      sample_light_at<V, F, transmits<Bsdf>>(scene, light.index, surface, light.u);
  const Vec3<V> wi = surface.frame.to_local(s.wi);
  MaskOf<V> lit = active & (s.pdf > V(0.0f)) & is_possible<Bsdf>(surface, wi, s.wi);
  if (none(lit)) return;
  const BsdfValue<V> f = eval(bsdf, turned<Bsdf>(surface, surface.wo), turned<Bsdf>(surface, wi));
  V divisor = s.pdf;
  if (!alone) {
    divisor = s.pdf * inverse_power_heuristic(s.pdf, f.pdf);
    if (needs_any<F>(scene, delta_light_features)) divisor = select(s.delta, s.pdf, divisor);
  }
  Vec3<V> radiance = throughput * f.f_cos * s.radiance * (V(1.0f) / divisor);
  if (needs<F>(scene, Feature::TexturedLights)) {
    radiance = radiance * sampled_glow<F>(scene, light.index, s.place, lit);
  }
  if (needs<F>(scene, Feature::Absorption)) {
    const I medium =
        medium_beyond(bsdf, surface, material, load<I>(queue.medium + i), wi.z < V(0.0f));
    radiance = radiance * transmittance(scene, medium, s.distance);
  }
  lit = lit & !(max_component(radiance) <= V(0.0f));  // NaN goes on, to be counted

  ShadowQueue& out = c.wave->shadows;
  const Packing<width_of<V>> lanes(lit);
  pack3(lanes, out.origin, out.count, origin_towards<Bsdf>(surface, wi));
  pack3(lanes, out.direction, out.count, s.wi);
  lanes.store(out.distance + out.count, shadow_distance(surface, s.distance));
  pack3(lanes, out.radiance, out.count, radiance);
  lanes.store(out.path + out.count, load<I>(queue.path + i));
  out.count += lanes.count();
}

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
