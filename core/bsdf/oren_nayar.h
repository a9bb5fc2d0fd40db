// Rough diffuse reflection: V-shaped grooves of Lambert's reflectors (Oren and Nayar 1994, the
// qualitative model, eq. 30), without interreflection as in pbrt-v3's matte.
//
// Row of MaterialTable: 0 reflectance, 3 sigma in degrees.
#pragma once

#include "core/bsdf.h"
#include "core/warp.h"

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

template <class V>
struct OrenNayarBsdf {
  Vec3<V> reflectance;
  V a, b;
};

// sigma: standard deviation of the facets' slope angle in degrees; 0 gives Lambert's model.
template <class V>
LOCKSTEP_INLINE OrenNayarBsdf<V> oren_nayar(const Vec3<V>& reflectance, V sigma) {
  const V radians = sigma * V(pi / 180.0f);
  const V sigma2 = radians * radians;
  return {reflectance, V(1.0f) - V(0.5f) * sigma2 / (sigma2 + V(0.33f)),
          V(0.45f) * sigma2 / (sigma2 + V(0.09f))};
}

template <class I>
LOCKSTEP_INLINE OrenNayarBsdf<FloatOf<I>> load_oren_nayar(const MaterialTable& t, I index) {
  const auto row = material_rows(t, index, 0);
  return oren_nayar<FloatOf<I>>({row.x, row.y, row.z}, row.w);
}

// f / Lambert's f. sin alpha tan beta cos(phi_i - phi_o) is the dot product of what lies in the
// surface over the larger cosine: no angle has to be known.
template <class V>
LOCKSTEP_INLINE V groove_factor(const OrenNayarBsdf<V>& bsdf, const Vec3<V>& wo,
                                const Vec3<V>& wi) {
  const V in_plane = max(fma(wo.x, wi.x, wo.y * wi.y), V(0.0f));
  return fma(bsdf.b, in_plane / max(max(wo.z, wi.z), V(1e-6f)), bsdf.a);
}

template <class V>
LOCKSTEP_INLINE BsdfValue<V> eval(const OrenNayarBsdf<V>& bsdf, const Vec3<V>& wo,
                                  const Vec3<V>& wi) {
  const V pdf = cosine_hemisphere_pdf(wi.z);
  return {bsdf.reflectance * (groove_factor(bsdf, wo, wi) * pdf), pdf};
}

template <class V>
LOCKSTEP_INLINE BsdfSample<V> sample(const OrenNayarBsdf<V>& bsdf, const Vec3<V>& wo, V,
                                     Vec2<V> u) {
  const Vec3<V> wi = cosine_hemisphere(u);
  return {wi, bsdf.reflectance * groove_factor(bsdf, wo, wi), cosine_hemisphere_pdf(wi.z)};
}

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
