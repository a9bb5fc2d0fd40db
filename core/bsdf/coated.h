// A diffuse base under a rough dielectric coat (see CoatedMaterial). Included by core/bsdf.h.
//
// Layered: the base sees light that has crossed the coat, T(wi) and T(wo), and light that the coat
// sends back inside is reflected again and again, in closed form a / (1 - a r) with r the coat's
// inner diffuse reflectance; 1/eta^2 is the change of solid angle at the interface. A base of
// albedo 1 then returns all that enters. A coat of some thickness dims what crosses it, and r; and
// only the first reflections by the base may count: pbrt-v4's walk between the layers, summed up.
//
// Where the coat's single-scattering loss is put back, the base sees what the rough coat passes.
#pragma once

#include "core/boundary_albedo.h"
#include "core/bsdf.h"
#include "core/fresnel.h"
#include "core/microfacet.h"
#include "core/simd_exp.h"
#include "core/warp.h"

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

template <class V>
struct CoatedBsdf {
  Vec3<V> diffuse, specular;
  Ggx<V> ggx;
  V eta;
  V layered;            // 1 or 0
  V inner_reflectance;  // of diffuse light inside, at the coat
  V thickness;
  V reflections;  // by the base that count; 0: all
  V lost{0.0f};   // what boundary_loss() gives for wo; 0: single scattering only
  const float* boundary_albedo = nullptr;  // see core/boundary_albedo.h; none: as if smooth
  IntOf<V> table{0};                       // of these the lanes' own
};

template <class I>
LOCKSTEP_INLINE CoatedBsdf<FloatOf<I>> load_coated(const MaterialTable& t, I index) {
  const auto a = material_rows(t, index, 0), b = material_rows(t, index, 4);
  const auto c = material_rows(t, index, 8);
  const auto alpha = max(b.z, FloatOf<I>(smoothest_alpha));
  return {{a.x, a.y, a.z}, {a.w, b.x, b.y}, {{alpha, alpha}}, b.w, c.x, c.y, c.z, c.w};
}

// By the coat.
template <class V>
LOCKSTEP_INLINE V reflectance_at(const CoatedBsdf<V>& bsdf, V cos_i) {
  if (!bsdf.boundary_albedo) return fresnel_dielectric(cos_i, bsdf.eta);
  return boundary_reflectance(bsdf.boundary_albedo, bsdf.table, cos_i, bsdf.ggx.alpha.x);
}

// Of the coat's reflection, with light of further bounces between facets, which takes the colour
// once more (Turquin 2019, eq. 16).
template <class V>
LOCKSTEP_INLINE Vec3<V> coat_scale(const CoatedBsdf<V>& bsdf) {
  if (none(bsdf.lost > V(0.0f))) return bsdf.specular;
  return bsdf.specular * fma(bsdf.lost, bsdf.specular, Vec3<V>(V(1.0f)));
}

// Share of light that gets through the coat at this angle; 1 where coat and base are just added.
template <class V>
LOCKSTEP_INLINE V transmittance(const CoatedBsdf<V>& bsdf, V cos_i) {
  const V entered = V(1.0f) - bsdf.layered * reflectance_at(bsdf, cos_i);
  if (none(bsdf.thickness > V(0.0f))) return entered;
  const V sin2 = fma(-cos_i, cos_i, V(1.0f)) / (bsdf.eta * bsdf.eta);
  const V cos_inside = sqrt(max(V(1.0f) - sin2, V(1e-6f)));
  return entered * exp(-(bsdf.thickness / cos_inside));
}

// 1 + x + x^2 + ..., as many terms as count, for x below 1.
template <class V>
LOCKSTEP_INLINE V sum_of_reflections(const CoatedBsdf<V>& bsdf, V x) {
  const V all = V(1.0f) / (V(1.0f) - x);
  if (none(bsdf.reflections > V(0.0f))) return all;
  // x^reflections: above 31 nothing is left of it.
  const auto n = to_int(min(bsdf.reflections, V(31.0f)));
  V power(1.0f), square = x;
  for (int i = 0; i < 5; ++i) {
    power = select((n & IntOf<V>(1 << i)) != IntOf<V>(0), power * square, power);
    square = square * square;
  }
  return select(bsdf.reflections > V(0.0f), (V(1.0f) - power) * all, all);
}

// f / T(wi) of the base.
template <class V>
LOCKSTEP_INLINE Vec3<V> base_reflectance(const CoatedBsdf<V>& bsdf, V cos_o) {
  const V solid_angle = fma(bsdf.layered, V(1.0f) / (bsdf.eta * bsdf.eta) - V(1.0f), V(1.0f));
  const V scale = solid_angle * transmittance(bsdf, cos_o);
  const V r = bsdf.layered * bsdf.inner_reflectance;
  return {bsdf.diffuse.x * scale * sum_of_reflections(bsdf, bsdf.diffuse.x * r),
          bsdf.diffuse.y * scale * sum_of_reflections(bsdf, bsdf.diffuse.y * r),
          bsdf.diffuse.z * scale * sum_of_reflections(bsdf, bsdf.diffuse.z * r)};
}

// Probability of sampling the coat, by what each layer reflects at this angle.
template <class V>
LOCKSTEP_INLINE V coat_probability(const CoatedBsdf<V>& bsdf, V cos_o) {
  const V coat = max_component(bsdf.specular) * fresnel_dielectric(cos_o, bsdf.eta);
  const V base = max_component(bsdf.diffuse) * transmittance(bsdf, cos_o);
  const V p = clamp(coat / max(coat + base, V(1e-20f)), V(0.1f), V(0.9f));
  return select(base <= V(0.0f), V(1.0f), select(coat <= V(0.0f), V(0.0f), p));
}

template <class V>
LOCKSTEP_INLINE BsdfValue<V> eval(const CoatedBsdf<V>& bsdf, const Vec3<V>& wo, const Vec3<V>& wi) {
  const Vec3<V> m = normalize(wo + wi);
  const V d = bsdf.ggx.d(m) / (V(4.0f) * wo.z);
  const V f = fresnel_dielectric(min(dot(wo, m), V(1.0f)), bsdf.eta);
  const V base_pdf = cosine_hemisphere_pdf(wi.z);
  const V base = base_pdf * transmittance(bsdf, wi.z);
  const V p = coat_probability(bsdf, wo.z);
  return {coat_scale(bsdf) * (f * d * bsdf.ggx.g2(wo, wi)) + base_reflectance(bsdf, wo.z) * base,
          fma(p, d * bsdf.ggx.g1(wo), (V(1.0f) - p) * base_pdf)};
}

template <class V>
LOCKSTEP_INLINE BsdfSample<V> sample(const CoatedBsdf<V>& bsdf, const Vec3<V>& wo, V lobe,
                                     Vec2<V> u) {
  const Vec3<V> coat = reflect(wo, bsdf.ggx.sample_visible_normal(wo, u));
  const Vec3<V> base = cosine_hemisphere(u);
  const Vec3<V> wi = select(lobe < coat_probability(bsdf, wo.z), coat, base);
  const BsdfValue<V> value = eval(bsdf, wo, wi);
  const MaskOf<V> valid = (wi.z > V(0.0f)) & (value.pdf > V(0.0f));
  const V pdf = select(valid, value.pdf, V(0.0f));
  return {wi, value.f_cos * (V(1.0f) / select(valid, pdf, V(1.0f))), pdf};
}

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
