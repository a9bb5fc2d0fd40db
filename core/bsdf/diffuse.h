// Lambert's ideal diffuse reflection. Included by core/bsdf.h.
#pragma once

#include "core/bsdf.h"
#include "core/warp.h"

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

template <class V>
struct DiffuseBsdf {
  Vec3<V> reflectance;
};

template <class I>
LOCKSTEP_INLINE DiffuseBsdf<FloatOf<I>> load_diffuse(const MaterialTable& t, I index) {
  const auto row = material_rows(t, index, 0);
  return {{row.x, row.y, row.z}};
}

template <class V>
LOCKSTEP_INLINE BsdfValue<V> eval(const DiffuseBsdf<V>& bsdf, const Vec3<V>&, const Vec3<V>& wi) {
  const V pdf = cosine_hemisphere_pdf(wi.z);
  return {bsdf.reflectance * pdf, pdf};
}

template <class V>
LOCKSTEP_INLINE BsdfSample<V> sample(const DiffuseBsdf<V>& bsdf, const Vec3<V>&, V, Vec2<V> u) {
  const Vec3<V> wi = cosine_hemisphere(u);
  return {wi, bsdf.reflectance, cosine_hemisphere_pdf(wi.z)};
}

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
