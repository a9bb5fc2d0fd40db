// Light spread by the cosine on both sides of a sheet (pbrt-v4 diffusetransmission).
// wo and wi may lie on either side of the surface, at any sign of z.
//
// Row of MaterialTable: 0 reflectance, 3 transmittance.
#pragma once

#include "core/bsdf/scatter.h"
#include "core/warp.h"

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

template <class V>
struct DiffuseTransmissionBsdf {
  Vec3<V> reflectance, transmittance;
};

template <class V>
inline constexpr bool transmits<DiffuseTransmissionBsdf<V>> = true;

template <class I>
LOCKSTEP_INLINE DiffuseTransmissionBsdf<FloatOf<I>> load_diffuse_transmission(
    const MaterialTable& t, I index) {
  const auto a = material_rows(t, index, 0), b = material_rows(t, index, 4);
  return {{a.x, a.y, a.z}, {a.w, b.x, b.y}};
}

// Probability of sampling the side of wo.
template <class V>
LOCKSTEP_INLINE V reflection_probability(const DiffuseTransmissionBsdf<V>& bsdf) {
  const V r = max_component(bsdf.reflectance), t = max_component(bsdf.transmittance);
  return r / max(r + t, V(1e-20f));
}

template <class V>
LOCKSTEP_INLINE BsdfValue<V> eval(const DiffuseTransmissionBsdf<V>& bsdf, const Vec3<V>& wo,
                                  const Vec3<V>& wi) {
  const MaskOf<V> reflected = wo.z * wi.z > V(0.0f);
  const V p = reflection_probability(bsdf);
  const V density = cosine_hemisphere_pdf(abs(wi.z));
  return {select<V>(reflected, bsdf.reflectance, bsdf.transmittance) * density,
          select(reflected, p, V(1.0f) - p) * density};
}

template <class V>
LOCKSTEP_INLINE BsdfSample<V> sample(const DiffuseTransmissionBsdf<V>& bsdf, const Vec3<V>& wo,
                                     V lobe, Vec2<V> u) {
  const V p_reflect = reflection_probability(bsdf);
  const MaskOf<V> reflected = lobe < p_reflect;
  const V p = select(reflected, p_reflect, V(1.0f) - p_reflect);
  Vec3<V> wi = cosine_hemisphere(u);
  const V pdf = p * cosine_hemisphere_pdf(wi.z);
  wi.z = copysign(wi.z, select(reflected, wo.z, -wo.z));
  return {wi, select<V>(reflected, bsdf.reflectance, bsdf.transmittance) * (V(1.0f) / p), pdf};
}

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
