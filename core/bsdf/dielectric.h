// A boundary between two transparent media, or a thin sheet of one: reflection and transmission,
// smooth or with GGX microfacets (Walter et al. 2007). Visible normals are sampled, and one of the
// two by what the microfacet reflects.
//
// wo and wi may lie on either side, at any sign of z: above (z > 0) is the outside, and eta the
// index inside over that outside. Radiance is carried, as for paths from the camera: where it is
// refracted, f holds the factor (index at wo / index at wi)^2.
//
// Row of MaterialTable: 0 reflectance, 3 transmittance, 6 alpha x, 7 alpha y, 8 eta, 9 thin
// (0 or 1). The colours scale what is reflected and what passes.
#pragma once

#include "core/bsdf/scatter.h"

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

template <class V>
struct DielectricBsdf {
  Vec3<V> reflectance, transmittance;
  Ggx<V> ggx;  // alpha below smoothest_alpha along both axes: a delta lane
  V eta;
  MaskOf<V> thin;  // both faces of a sheet at once: what passes goes on as it came
  V lost{0.0f};    // what boundary_loss() gives for wo; 0: single scattering only
};

template <class V>
inline constexpr bool transmits<DielectricBsdf<V>> = true;

template <class I>
LOCKSTEP_INLINE DielectricBsdf<FloatOf<I>> load_dielectric(const MaterialTable& t, I index) {
  using V = FloatOf<I>;
  const auto a = material_rows(t, index, 0), b = material_rows(t, index, 4);
  const auto c = material_rows(t, index, 8);
  return {{a.x, a.y, a.z}, {a.w, b.x, b.y}, {{b.z, b.w}}, c.x, c.y != V(0.0f)};
}

// Media whose indices differ by less do not refract: the half vector would be lost in rounding.
inline constexpr float least_refraction = 1e-3f;

// wo turned to z > 0, and with it the boundary.
template <class V>
struct BoundarySide {
  Vec3<V> wo;
  V sign;  // of z before; multiplies that of wi
  V eta;   // index on the other side / index at wo
};

template <class V>
LOCKSTEP_INLINE BoundarySide<V> boundary_side(const Vec3<V>& wo, V eta, MaskOf<V> refracts) {
  const MaskOf<V> inside = (wo.z < V(0.0f)) & refracts;
  return {{wo.x, wo.y, max(abs(wo.z), V(1e-6f))},
          copysign(V(1.0f), wo.z),
          select(inside, V(1.0f) / eta, eta)};
}

// What happens under cos_i in (0, 1]. In g = eta cos_t nothing cancels, even where eta is near 1
// (Cook and Torrance 1982, appendix).
template <class V>
struct Crossing {
  V reflectance;
  V g;  // 0 under total reflection
};

template <class V>
LOCKSTEP_INLINE Crossing<V> cross_boundary(V cos_i, V eta) {
  const V g2 = fma(cos_i, cos_i, fma(eta, eta, V(-1.0f)));
  const V g = sqrt(max(g2, V(0.0f)));
  const V e = eta * eta * cos_i;
  const V perpendicular = (cos_i - g) / (cos_i + g), parallel = (e - g) / (e + g);
  const V r = V(0.5f) * fma(parallel, parallel, perpendicular * perpendicular);
  return {select(g2 <= V(0.0f), V(1.0f), r), g};
}

// Reflectance of a sheet, R + T^2 R / (1 - R^2) with T = 1 - R: all orders of reflection inside.
template <class V>
LOCKSTEP_INLINE V sheet_reflectance(V r) {
  return V(2.0f) * r / (V(1.0f) + r);
}

// Direction of light that passes the facet m: the exact refraction of wo.
template <class V>
LOCKSTEP_INLINE Vec3<V> refract(const Vec3<V>& wo, const Vec3<V>& m, V cos_o, V g, V eta) {
  return fma(cos_o - g, m, -wo) * (V(1.0f) / eta);
}

// The facet, in the upper hemisphere, that sends wi to wo; eta = 1 where wi is reflected.
template <class V>
LOCKSTEP_INLINE Vec3<V> half_vector(const Vec3<V>& wo, const Vec3<V>& wi, V eta) {
  const Vec3<V> h = fma(eta, wi, wo);
  return h * copysign(rsqrt(dot(h, h)), h.z);
}

// (wo . m) dm / dwi: facets, as seen from wo, per solid angle of wi. Reflection: Walter et al.
// 2007, eq. 14. Refraction: eq. 17 where wi obeys Snell's law, so that -eta (wi . m) = g and the
// difference of the squares of g and wo . m is eta^2 - 1.
template <class V>
LOCKSTEP_INLINE V facets_per_solid_angle(V cos_o, V g, V eta, MaskOf<V> refracted) {
  const V reflection(0.25f);
  if (none(refracted)) return reflection;
  const V ratio = (cos_o + g) / fma(eta, eta, V(-1.0f));
  return select(refracted, eta * cos_o * g * ratio * ratio, reflection);
}

// Of radiance: a cone of light changes its solid angle where it is refracted.
template <class V>
LOCKSTEP_INLINE V refraction_scale(V eta, MaskOf<V> refracted) {
  return select(refracted, V(1.0f) / (eta * eta), V(1.0f));
}

// Lanes that are Dirac distributions.
template <class V>
LOCKSTEP_INLINE MaskOf<V> is_delta(const DielectricBsdf<V>& bsdf) {
  const MaskOf<V> smooth = is_smooth(bsdf.ggx);
  const MaskOf<V> matched = (abs(bsdf.eta - V(1.0f)) < V(least_refraction)) & !bsdf.thin;
  return smooth | matched;
}

template <class V>
LOCKSTEP_INLINE Crossing<V> cross_boundary(const DielectricBsdf<V>& bsdf, V cos_i, V eta) {
  Crossing<V> c = cross_boundary(cos_i, eta);
  c.reflectance = select(bsdf.thin, sheet_reflectance(c.reflectance), c.reflectance);
  return c;
}

// Probability of going on with the reflection, from a facet of this reflectance.
template <class V>
LOCKSTEP_INLINE V reflection_probability(const DielectricBsdf<V>& bsdf, V reflectance) {
  const V r = reflectance * max_component(bsdf.reflectance);
  const V t = (V(1.0f) - reflectance) * max_component(bsdf.transmittance);
  return r / max(r + t, V(1e-20f));
}

// Of light that goes that way, with that of further bounces between facets, which takes the colour
// once more (Turquin 2019, eq. 16). Not reciprocal: it depends on wo alone.
template <class V>
LOCKSTEP_INLINE Vec3<V> compensated(const DielectricBsdf<V>& bsdf, const Vec3<V>& color) {
  if (none(bsdf.lost > V(0.0f))) return color;
  return color * fma(bsdf.lost, color, Vec3<V>(V(1.0f)));
}

// What such a facet reflects, or lets pass.
template <class V>
LOCKSTEP_INLINE Vec3<V> facet_share(const DielectricBsdf<V>& bsdf, V reflectance, MaskOf<V> passed,
                                    V scale) {
  return select<V>(passed,
                   compensated(bsdf, bsdf.transmittance) * ((V(1.0f) - reflectance) * scale),
                   compensated(bsdf, bsdf.reflectance) * reflectance);
}

template <class V>
[[gnu::noinline]] BsdfValue<V> eval(const DielectricBsdf<V>& bsdf, const Vec3<V>& to_viewer,
                                    const Vec3<V>& to_light) {
  const MaskOf<V> delta = is_delta(bsdf);
  if (all(delta)) return {Vec3<V>(V(0.0f)), V(0.0f)};
  const Ggx<V> ggx = at_least_smoothest(bsdf.ggx);
  const BoundarySide<V> side = boundary_side(to_viewer, bsdf.eta, !bsdf.thin);
  Vec3<V> wi(to_light.x, to_light.y, to_light.z * side.sign);
  const MaskOf<V> passed = wi.z < V(0.0f), refracted = passed & !bsdf.thin;
  wi.z = select(refracted, wi.z, abs(wi.z));

  const Vec3<V> m = half_vector(side.wo, wi, select(refracted, side.eta, V(1.0f)));
  const V facing = dot(side.wo, m), cos_o = clamp(facing, V(1e-6f), V(1.0f));
  const Crossing<V> c = cross_boundary(bsdf, cos_o, side.eta);
  const MaskOf<V> possible = (facing > V(0.0f)) & !(refracted & (dot(wi, m) >= V(0.0f))) & !delta;
  const V density = ggx.d(m) / side.wo.z * facets_per_solid_angle(cos_o, c.g, side.eta, refracted);
  const V d = select(possible, density, V(0.0f));
  const V p = reflection_probability(bsdf, c.reflectance);
  const Vec3<V> share =
      facet_share(bsdf, c.reflectance, passed, refraction_scale(side.eta, refracted));
  return {share * (d * ggx.g2(side.wo, wi)),
          select(passed, V(1.0f) - p, p) * (d * ggx.g1(side.wo))};
}

template <class V>
[[gnu::noinline]] ScatterSample<V> sample(const DielectricBsdf<V>& bsdf, const Vec3<V>& to_viewer,
                                          V lobe, Vec2<V> u) {
  const MaskOf<V> delta = is_delta(bsdf);
  const Ggx<V> ggx = at_least_smoothest(bsdf.ggx);
  const BoundarySide<V> side = boundary_side(to_viewer, bsdf.eta, !bsdf.thin);
  Vec3<V> m(V(0.0f), V(0.0f), V(1.0f));
  if (!all(delta)) m = select<V>(delta, m, ggx.sample_visible_normal(side.wo, u));

  const V facing = dot(side.wo, m), cos_o = clamp(facing, V(1e-6f), V(1.0f));
  const Crossing<V> c = cross_boundary(bsdf, cos_o, side.eta);
  const V p_reflect = reflection_probability(bsdf, c.reflectance);
  const MaskOf<V> passed = !(lobe < p_reflect), refracted = passed & !bsdf.thin;
  const Vec3<V> mirrored = reflect(side.wo, m);
  const Vec3<V> wi = select<V>(refracted, refract(side.wo, m, cos_o, c.g, side.eta), mirrored);
  const V wi_side = select(refracted, -wi.z, wi.z);  // > 0 where wi lies where it should

  const V p = select(passed, V(1.0f) - p_reflect, p_reflect);
  V density(1.0f), shadowing(1.0f);
  if (!all(delta)) {
    const V g1 = ggx.g1(side.wo);
    const V facets = facets_per_solid_angle(cos_o, c.g, side.eta, refracted);
    density = select(delta, density, ggx.d(m) / side.wo.z * facets * g1);
    shadowing = select(delta, shadowing, ggx.g2(side.wo, wi) / g1);
  }
  const V scale = refraction_scale(side.eta, refracted);
  const MaskOf<V> possible = (facing > V(0.0f)) & (wi_side > V(0.0f));
  const V z = select(passed & bsdf.thin, -wi.z, wi.z) * side.sign;
  return {{{wi.x, wi.y, z},
           facet_share(bsdf, c.reflectance, passed, scale) * (shadowing / p),
           select(possible, p * density, V(0.0f))},
          delta,
          scale};
}

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
