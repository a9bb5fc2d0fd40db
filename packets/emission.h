// What rays find at their ends: emitting surfaces and the environment.
#pragma once

#include "core/light.h"
#include "packets/hits.h"
#include "packets/shade_context.h"

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

// What the light textures of the lanes' bindings say at the hits at i...
template <int W, FeatureMask F>
[[gnu::noinline]] Vec3<Float<W>> glow_colors(const SceneData& scene, const RayQueue& rays,
                                             const HitArray& hits, int i, const Mask<W>& glows,
                                             const Int<W>& binding) {
  using V = Float<W>;
  using I = Int<W>;
  const Rows<I> geometry = geometry_of_hits(scene, load<I>(hits.geometry + i), glows);
  const TexturePoint<V> at = texture_point<W, F>(scene, rays, hits, i, glows, geometry);
  return glow_color(scene, binding, glows, at);
}

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
    if (needs<F>(scene, Feature::EnvironmentMap) && any(miss)) {
      const LightRow<V> light = load_light(scene.lights, I(scene.environment));
      const MapLight<V> seen =
          evaluate_environment_map(scene.environment_map, load3<V>(rays.direction, i));
      add(i, seen.radiance, seen.pdf * light.probability, miss);
    }
    if (!needs_any<F>(scene, area_light_features)) continue;
    const Mask<W> hit = active & !(geometry < I(0));
    const I first =
        gather(scene.geometry.rows + 2, select(hit, geometry, I(0)) * I(geometry_stride));
    const Mask<W> emitting = hit & !(first < I(0));
    if (none(emitting)) continue;
    const I entry = select(emitting, first + load<I>(hits.primitive + i), I(0));
    Emitted<V> e =
        hit_light<V, F>(scene, gather(scene.light_of_primitive, entry), load3<V>(rays.origin, i),
                        load3<V>(rays.direction, i), load<V>(hits.distance + i));
    if (needs<F>(scene, Feature::TexturedLights) && any(emitting & e.glows)) {
      const Mask<W> glows = emitting & e.glows;
      e.radiance = e.radiance * glow_colors<W, F>(scene, rays, hits, i, glows, e.binding);
    }
    // NaN is added too, to be counted.
    add(i, e.radiance, e.pdf, emitting & !(max_component(e.radiance) <= V(0.0f)));
  }
}

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
