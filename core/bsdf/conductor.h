// Rough metal: GGX microfacets with conductor Fresnel; single scattering. Included by core/bsdf.h.
#pragma once

#include "core/bsdf.h"
#include "core/fresnel.h"
#include "core/microfacet.h"

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

template <class V>
struct ConductorBsdf {
  Vec3<V> eta, k;
  Ggx<V> ggx;
};

template <class I>
LOCKSTEP_INLINE ConductorBsdf<FloatOf<I>> load_conductor(const MaterialTable& t, I index) {
  const auto a = material_rows(t, index, 0), b = material_rows(t, index, 4);
  return {{a.x, a.y, a.z}, {a.w, b.x, b.y}, {{b.z, b.w}}};
}

template <class V>
LOCKSTEP_INLINE Vec3<V> fresnel(const ConductorBsdf<V>& bsdf, V cos_i) {
  return {fresnel_conductor(cos_i, bsdf.eta.x, bsdf.k.x),
          fresnel_conductor(cos_i, bsdf.eta.y, bsdf.k.y),
          fresnel_conductor(cos_i, bsdf.eta.z, bsdf.k.z)};
}

template <class V>
LOCKSTEP_INLINE BsdfValue<V> eval(const ConductorBsdf<V>& bsdf, const Vec3<V>& wo,
                                  const Vec3<V>& wi) {
  const Vec3<V> m = normalize(wo + wi);
  const V d = bsdf.ggx.d(m) / (V(4.0f) * wo.z);
  const Vec3<V> f = fresnel(bsdf, min(dot(wo, m), V(1.0f)));
  return {f * (d * bsdf.ggx.g2(wo, wi)), d * bsdf.ggx.g1(wo)};
}

template <class V>
LOCKSTEP_INLINE BsdfSample<V> sample(const ConductorBsdf<V>& bsdf, const Vec3<V>& wo, V,
                                     Vec2<V> u) {
  const Vec3<V> m = bsdf.ggx.sample_visible_normal(wo, u);
  const Vec3<V> wi = reflect(wo, m);
  const V pdf = select(wi.z > V(0.0f), bsdf.ggx.reflection_pdf(wo, m), V(0.0f));
  const Vec3<V> f = fresnel(bsdf, min(dot(wo, m), V(1.0f)));
  return {wi, f * (bsdf.ggx.g2(wo, wi) / bsdf.ggx.g1(wo)), pdf};
}

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
