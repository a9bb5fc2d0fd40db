// GGX microfacets with Smith's height-correlated masking-shadowing. Local frame, normal +z; wo and
// wi point away from the surface; alpha is the roughness along local x and y.
#pragma once

#include "core/simd_math.h"
#include "core/vec.h"
#include "core/warp.h"

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

// Below this roughness a lobe is taken as perfectly smooth, or kept at it where it may not be.
inline constexpr float smoothest_alpha = 1e-3f;

template <class V>
struct Ggx {
  Vec2<V> alpha;

  // Density of microfacet normals, per unit area and solid angle (Heitz 2014, eq. 85).
  // Written so that tiny alpha neither overflows nor loses the peak.
  LOCKSTEP_INLINE V d(const Vec3<V>& m) const {
    const V x = m.x / alpha.x, y = m.y / alpha.y;
    const V s = fma(x, x, fma(y, y, m.z * m.z));
    return V(inv_pi) / (alpha.x * alpha.y * s * s);
  }

  // Smith's Lambda (Heitz 2014, eq. 72).
  LOCKSTEP_INLINE V lambda(const Vec3<V>& w) const {
    const V x = w.x * alpha.x, y = w.y * alpha.y;
    const V tan2 = fma(x, x, y * y) / (w.z * w.z);
    return V(0.5f) * (sqrt(V(1.0f) + tan2) - V(1.0f));
  }

  LOCKSTEP_INLINE V g1(const Vec3<V>& w) const { return V(1.0f) / (V(1.0f) + lambda(w)); }

  // Height-correlated masking and shadowing (Heitz 2014, eq. 99).
  LOCKSTEP_INLINE V g2(const Vec3<V>& wo, const Vec3<V>& wi) const {
    return V(1.0f) / (V(1.0f) + lambda(wo) + lambda(wi));
  }

  // A normal visible from wo (wo.z > 0): spherical caps (Dupuy and Benyoub 2023).
  LOCKSTEP_INLINE Vec3<V> sample_visible_normal(const Vec3<V>& wo, Vec2<V> u) const {
    const Vec3<V> w = normalize(Vec3<V>(wo.x * alpha.x, wo.y * alpha.y, wo.z));
    const V z = fma(V(1.0f) - u.x, V(1.0f) + w.z, -w.z);
    const V r = sqrt(clamp(V(1.0f) - z * z, V(0.0f), V(1.0f)));
    const SinCos<V> phi = sincos_turns(u.y);
    const Vec3<V> h = Vec3<V>(r * phi.cos, r * phi.sin, z) + w;
    return normalize(Vec3<V>(h.x * alpha.x, h.y * alpha.y, max(h.z, V(1e-7f))));
  }

  // Solid-angle density of wi = reflect(wo, m) for visible normals: D G1(wo) / (4 cos_o).
  LOCKSTEP_INLINE V reflection_pdf(const Vec3<V>& wo, const Vec3<V>& m) const {
    return d(m) * g1(wo) / (V(4.0f) * wo.z);
  }
};

// wo mirrored at the unit vector m.
template <class V>
LOCKSTEP_INLINE Vec3<V> reflect(const Vec3<V>& wo, const Vec3<V>& m) {
  return fma(V(2.0f) * dot(wo, m), m, -wo);
}

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
