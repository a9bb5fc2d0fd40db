// Metal of any roughness: the rough conductor, and perfect mirrors in lanes whose alpha is below
// smoothest_alpha along both axes; with a scale, and what single scattering loses put back.
//
// Row of MaterialTable: 0 eta, 3 k, 6 alpha x, 7 alpha y, 8 specular.
#pragma once

#include "core/bsdf/conductor.h"
#include "core/bsdf/scatter.h"

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

template <class V>
struct MetalBsdf {
  ConductorBsdf<V> conductor;  // alpha may be 0
  Vec3<V> specular;            // scales the reflection
  V lost;                      // what ggx_loss() gives for wo; 0: single scattering only
};

template <class I>
LOCKSTEP_INLINE MetalBsdf<FloatOf<I>> load_metal(const MaterialTable& t, I index) {
  using V = FloatOf<I>;
  const auto c = material_rows(t, index, 8);
  return {load_conductor(t, index), {c.x, c.y, c.z}, V(0.0f)};
}

// Light of further bounces between microfacets takes the colour at normal incidence once more
// (Turquin 2019, eq. 16). Never above 1 in all, but not reciprocal: it depends on wo alone.
template <class V>
LOCKSTEP_INLINE Vec3<V> rough_scale(const MetalBsdf<V>& bsdf) {
  const MaskOf<V> compensated = bsdf.lost > V(0.0f);
  if (none(compensated)) return bsdf.specular;
  const Vec3<V> f0 = fresnel(bsdf.conductor, V(1.0f)) * bsdf.specular;
  const Vec3<V> one(V(1.0f));
  return bsdf.specular * select<V>(compensated, fma(bsdf.lost, f0, one), one);
}

template <class V>
LOCKSTEP_INLINE ConductorBsdf<V> rough_conductor(const MetalBsdf<V>& bsdf) {
  return {bsdf.conductor.eta, bsdf.conductor.k, at_least_smoothest(bsdf.conductor.ggx)};
}

template <class V>
LOCKSTEP_INLINE BsdfValue<V> eval(const MetalBsdf<V>& bsdf, const Vec3<V>& wo, const Vec3<V>& wi) {
  const MaskOf<V> smooth = is_smooth(bsdf.conductor.ggx);
  const Vec3<V> none_of_it(V(0.0f));
  if (all(smooth)) return {none_of_it, V(0.0f)};
  const BsdfValue<V> rough = eval(rough_conductor(bsdf), wo, wi);
  return {select<V>(smooth, none_of_it, rough.f_cos * rough_scale(bsdf)),
          select(smooth, V(0.0f), rough.pdf)};
}

template <class V>
LOCKSTEP_INLINE ScatterSample<V> sample_mirror(const MetalBsdf<V>& bsdf, const Vec3<V>& wo,
                                               MaskOf<V> smooth) {
  const Vec3<V> f = fresnel(bsdf.conductor, min(wo.z, V(1.0f))) * bsdf.specular;
  return {{{-wo.x, -wo.y, wo.z}, f, V(1.0f)}, smooth, V(1.0f)};
}

template <class V>
LOCKSTEP_INLINE ScatterSample<V> sample(const MetalBsdf<V>& bsdf, const Vec3<V>& wo, V lobe,
                                        Vec2<V> u) {
  const MaskOf<V> smooth = is_smooth(bsdf.conductor.ggx);
  if (all(smooth)) return sample_mirror(bsdf, wo, smooth);
  BsdfSample<V> s = sample(rough_conductor(bsdf), wo, lobe, u);
  s.weight *= rough_scale(bsdf);
  if (any(smooth)) {
    const ScatterSample<V> mirror = sample_mirror(bsdf, wo, smooth);
    s.wi = select<V>(smooth, mirror.wi, s.wi);
    s.weight = select<V>(smooth, mirror.weight, s.weight);
    s.pdf = select(smooth, mirror.pdf, s.pdf);
  }
  return {s, smooth, V(1.0f)};
}

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
