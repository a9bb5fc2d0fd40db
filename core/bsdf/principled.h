// glTF 2.0's metallic-roughness model (specification, appendix B) with the extensions
// KHR_materials_transmission, _volume, _ior, _specular and _clearcoat: from the top
//   a coat of index 1.5 over a share `coat` of the surface,
//   GGX facets: a metal of colour `base_color` for a share `metallic`, else a dielectric,
//   below those that are dielectric a base, diffuse or, for a share `transmission`, transparent.
// Never a delta distribution: alpha is kept at smoothest_alpha or more.
//
// Departures from the appendix, so that no light is gained and paths may be reversed: masking is
// correlated; the dielectric's Fresnel term is exact; the diffuse base gets what the boundary lets
// through at wi and at wo, with light that it sends back inside (Kelemen and Szirmay-Kalos 2001),
// instead of 1 - F of the half vector; the coat dims by the more grazing of the two directions.
//
// wo and wi may lie on either side. Seen from z < 0, a transparent share that refracts is left from
// within (and the coat, which is outside, reflects nothing); all else looks as from above.
//
// Row of MaterialTable: 0 base colour, 3 metallic, 4 alpha, 5 eta, 6 specular, 7 transmission,
// 8 coat, 9 coat alpha, 10 thin (0 or 1: what passes is not refracted, as without a volume).
#pragma once

#include "core/bsdf/dielectric.h"
#include "core/warp.h"

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

template <class V>
struct PrincipledBsdf {
  Vec3<V> base_color;
  V metallic, alpha, eta, specular, transmission, coat, coat_alpha;
  MaskOf<V> thin;
  V lost{0.0f};           // what ggx_loss() gives for wo and alpha; 0: single scattering only
  V lost_by_clear{0.0f};  // what boundary_loss() gives for it, or ggx_loss() where thin
};

template <class V>
inline constexpr bool transmits<PrincipledBsdf<V>> = true;

template <class I>
LOCKSTEP_INLINE PrincipledBsdf<FloatOf<I>> load_principled(const MaterialTable& t, I index) {
  using V = FloatOf<I>;
  const auto a = material_rows(t, index, 0), b = material_rows(t, index, 4);
  const auto c = material_rows(t, index, 8);
  return {{a.x, a.y, a.z}, a.w, b.x, b.y, b.z, b.w, c.x, c.y, c.z != V(0.0f)};
}

// (1 - cos)^5: Schlick's step from the reflectance at normal incidence to 1.
template <class V>
LOCKSTEP_INLINE V schlick_step(V cos_i) {
  const V x = max(V(1.0f) - cos_i, V(0.0f)), x2 = x * x;
  return x2 * x2 * x;
}

// Reflectance of a dielectric to diffuse light. From outside a fit of ours, exact to 4e-4 up to eta
// = 3 and too low beyond; from inside 1 - (1 - R) / eta^2.
template <class V>
LOCKSTEP_INLINE V mean_reflectance(V eta) {
  const MaskOf<V> dense = eta >= V(1.0f);
  const V e = select(dense, eta, V(1.0f) / eta);
  const V t = min(e - V(1.0f), V(2.0f));
  const V r =
      t * fma(V(1.325766f), t, V(0.331930f)) / fma(fma(V(0.969704f), t, V(8.347330f)), t, V(1.0f));
  return select(dense, r, V(1.0f) - (V(1.0f) - r) * (eta * eta));
}

// All that depends on wo alone.
template <class V>
struct PrincipledView {
  BoundarySide<V> side;
  MaskOf<V> refracts, inside;
  Ggx<V> ggx, coat_ggx;
  V dielectric;   // share that is not metal
  V transparent;  // share of the dielectric's base
  V coat;         // share covered, as seen from here
  V diffuse_in;   // what the diffuse base gets from wo
  V p_coat, p_facets;
};

template <class V>
LOCKSTEP_INLINE V coat_reflectance(V cos_i) {
  return fma(V(0.96f), schlick_step(cos_i), V(0.04f));
}

// Of facets at the angle where the boundary reflects `r` and Schlick's step is `step`.
template <class V>
LOCKSTEP_INLINE Vec3<V> facet_reflectance(const PrincipledBsdf<V>& bsdf, V dielectric, V r,
                                          V step) {
  const Vec3<V> metal = fma(step, Vec3<V>(V(1.0f)) - bsdf.base_color, bsdf.base_color);
  return metal * bsdf.metallic + Vec3<V>(dielectric * bsdf.specular * r);
}

// Probabilities of the lobes by what each returns at this angle. Facets always have a chance: those
// that face elsewhere may reflect more.
template <class V>
LOCKSTEP_INLINE void choose_lobes(const PrincipledBsdf<V>& bsdf, V r, PrincipledView<V>& view) {
  const V cos_o = view.side.wo.z;
  const V base = max_component(bsdf.base_color) * view.dielectric * (V(1.0f) - bsdf.specular * r);
  const V reflected =
      max_component(facet_reflectance(bsdf, view.dielectric, r, schlick_step(cos_o)));
  const V coat = view.coat * coat_reflectance(cos_o);
  const V facets = (V(1.0f) - coat) * max(fma(base, view.transparent, reflected), V(0.01f));
  const V diffuse = (V(1.0f) - coat) * base * (V(1.0f) - view.transparent);
  const V scale = V(1.0f) / (coat + facets + diffuse);
  view.p_coat = coat * scale;
  view.p_facets = facets * scale;
}

template <class V>
[[gnu::noinline]] PrincipledView<V> principled_view(const PrincipledBsdf<V>& bsdf,
                                                    const Vec3<V>& to_viewer) {
  PrincipledView<V> view;
  const V smoothest(smoothest_alpha);
  view.dielectric = V(1.0f) - bsdf.metallic;
  view.transparent = bsdf.transmission;
  view.refracts = (bsdf.transmission * view.dielectric > V(0.0f)) & !bsdf.thin;
  view.inside = (to_viewer.z < V(0.0f)) & view.refracts;
  view.side = boundary_side(to_viewer, max(bsdf.eta, V(1.0f + least_refraction)), view.refracts);
  view.ggx.alpha = Vec2<V>(max(bsdf.alpha, smoothest));
  view.coat_ggx.alpha = Vec2<V>(max(bsdf.coat_alpha, smoothest));
  view.coat = select(view.inside, V(0.0f), bsdf.coat);
  const V r = cross_boundary(view.side.wo.z, view.side.eta).reflectance;
  view.diffuse_in = V(1.0f) - bsdf.specular * r;
  choose_lobes(bsdf, r, view);
  return view;
}

// What facets under cos_o reflect, and let pass where they do.
template <class V>
struct FacetShares {
  Vec3<V> reflected, passed;
  V p_reflect;
};

template <class V>
LOCKSTEP_INLINE FacetShares<V> facet_shares(const PrincipledBsdf<V>& bsdf,
                                            const PrincipledView<V>& view, V cos_o, V r) {
  FacetShares<V> s;
  s.reflected = facet_reflectance(bsdf, view.dielectric, r, schlick_step(cos_o));
  const V share = view.dielectric * view.transparent * (V(1.0f) - bsdf.specular * r);
  // Where all is reflected nothing is refracted, whatever the scale.
  s.passed = bsdf.base_color * select((r >= V(1.0f)) & view.refracts, V(0.0f), share);
  const V reflected = max(max_component(s.reflected), V(1e-20f));
  s.p_reflect = reflected / (reflected + max_component(s.passed));
  if (none(bsdf.lost > V(0.0f))) return s;
  // Light of further bounces between facets (Turquin 2019, eq. 16).
  const V r0 = (view.side.eta - V(1.0f)) / (view.side.eta + V(1.0f));
  const Vec3<V> one(V(1.0f)), f0 = facet_reflectance(bsdf, view.dielectric, r0 * r0, V(0.0f));
  const V clear = view.dielectric * view.transparent * bsdf.specular * r;
  const V opaque = view.dielectric * (V(1.0f) - view.transparent);
  s.reflected = facet_reflectance(bsdf, opaque, r, schlick_step(cos_o)) * fma(bsdf.lost, f0, one) +
                Vec3<V>(fma(bsdf.lost_by_clear, clear, clear));
  s.passed = s.passed * fma(bsdf.lost_by_clear, bsdf.base_color, one);
  return s;
}

// What the coat leaves of light on its way through the layers below it.
template <class V>
LOCKSTEP_INLINE V below_coat(const PrincipledBsdf<V>& bsdf, const PrincipledView<V>& view, V cos_i,
                             MaskOf<V> refracted) {
  if (none(bsdf.coat > V(0.0f))) return V(1.0f);
  const V cos_o = view.side.wo.z, grazing = min(cos_o, cos_i);
  // Refracted light meets the coat on the outer side only.
  const V outer = select(view.inside, cos_i, cos_o);
  const V coat = select(refracted, bsdf.coat, view.coat);
  return V(1.0f) - coat * coat_reflectance(select(refracted, outer, grazing));
}

template <class V>
LOCKSTEP_INLINE BsdfValue<V> eval_diffuse(const PrincipledBsdf<V>& bsdf,
                                          const PrincipledView<V>& view, V cos_i) {
  const V pdf = cosine_hemisphere_pdf(cos_i);
  const V share = view.dielectric * (V(1.0f) - view.transparent);
  Vec3<V> f(V(0.0f));
  if (any(share > V(0.0f))) {
    const V r_i = cross_boundary(max(cos_i, V(1e-6f)), view.side.eta).reflectance;
    const V crossed = view.diffuse_in * (V(1.0f) - bsdf.specular * r_i) /
                      (V(1.0f) - bsdf.specular * mean_reflectance(view.side.eta));
    f = bsdf.base_color * (share * crossed * pdf);
  }
  return {f, (V(1.0f) - view.p_coat - view.p_facets) * pdf};
}

// wi is turned with wo, and lies below (z < 0) where light passes.
template <class V>
[[gnu::noinline]] BsdfValue<V> eval(const PrincipledBsdf<V>& bsdf, const PrincipledView<V>& view,
                                    const Vec3<V>& wi) {
  const Vec3<V>& wo = view.side.wo;
  const V eta = view.side.eta, cos_i = abs(wi.z);
  const MaskOf<V> passed = wi.z < V(0.0f), refracted = passed & view.refracts;
  const Vec3<V> in(wi.x, wi.y, select(refracted, wi.z, cos_i));
  const Vec3<V> m = half_vector(wo, in, select(refracted, eta, V(1.0f)));
  const V facing = dot(wo, m), cos_o = clamp(facing, V(1e-6f), V(1.0f));
  const MaskOf<V> possible = (facing > V(0.0f)) & !(refracted & (dot(in, m) >= V(0.0f)));

  const Crossing<V> c = cross_boundary(cos_o, eta);
  const FacetShares<V> shares = facet_shares(bsdf, view, cos_o, c.reflectance);
  const V facets = facets_per_solid_angle(cos_o, c.g, eta, refracted);
  const V d = select(possible, view.ggx.d(m) / wo.z * facets, V(0.0f));
  const V p = select(passed, V(1.0f) - shares.p_reflect, shares.p_reflect);
  const Vec3<V> share =
      select<V>(passed, shares.passed * refraction_scale(eta, refracted), shares.reflected);
  Vec3<V> f = share * (d * view.ggx.g2(wo, in));
  V pdf = view.p_facets * p * d * view.ggx.g1(wo);
  if (!all(passed)) {
    const BsdfValue<V> diffuse = eval_diffuse(bsdf, view, cos_i);
    f = select<V>(passed, f, f + diffuse.f_cos);
    pdf = select(passed, pdf, pdf + diffuse.pdf);
  }
  f = f * below_coat(bsdf, view, cos_i, refracted);
  const MaskOf<V> coated = (view.coat > V(0.0f)) & !passed;
  if (any(coated)) {
    const V coat_d = view.coat_ggx.d(m) / (V(4.0f) * wo.z);
    const V coat = view.coat * coat_reflectance(cos_o) * coat_d * view.coat_ggx.g2(wo, in);
    f = select<V>(coated, f + Vec3<V>(coat), f);
    pdf = select(coated, pdf + view.p_coat * coat_d * view.coat_ggx.g1(wo), pdf);
  }
  return {f, pdf};
}

template <class V>
LOCKSTEP_INLINE BsdfValue<V> eval(const PrincipledBsdf<V>& bsdf, const Vec3<V>& to_viewer,
                                  const Vec3<V>& to_light) {
  const PrincipledView<V> view = principled_view(bsdf, to_viewer);
  return eval(bsdf, view, {to_light.x, to_light.y, to_light.z * view.side.sign});
}

// A direction by the facets of the coat or those below it, reflected, passed or refracted; z = 0
// where there is none.
template <class V>
LOCKSTEP_INLINE Vec3<V> sample_facets(const PrincipledBsdf<V>& bsdf, const PrincipledView<V>& view,
                                      V lobe, Vec2<V> u) {
  const Vec3<V>& wo = view.side.wo;
  const MaskOf<V> coat = lobe < view.p_coat;
  const Ggx<V> ggx{Vec2<V>(select(coat, view.coat_ggx.alpha.x, view.ggx.alpha.x))};
  const Vec3<V> m = ggx.sample_visible_normal(wo, u);
  const V facing = dot(wo, m), cos_o = clamp(facing, V(1e-6f), V(1.0f));
  const Crossing<V> c = cross_boundary(cos_o, view.side.eta);
  const V p_reflect = facet_shares(bsdf, view, cos_o, c.reflectance).p_reflect;
  const MaskOf<V> passed = !(lobe < fma(view.p_facets, p_reflect, view.p_coat));
  const MaskOf<V> refracted = passed & view.refracts;
  const Vec3<V> wi =
      select<V>(refracted, refract(wo, m, cos_o, c.g, view.side.eta), reflect(wo, m));
  const V wi_side = select(refracted, -wi.z, wi.z);  // > 0 where wi lies where it should
  const V z = select((facing > V(0.0f)) & (wi_side > V(0.0f)), abs(wi.z), V(0.0f));
  return {wi.x, wi.y, select(passed, -z, z)};
}

template <class V>
LOCKSTEP_INLINE ScatterSample<V> sample(const PrincipledBsdf<V>& bsdf, const Vec3<V>& to_viewer,
                                        V lobe, Vec2<V> u) {
  const PrincipledView<V> view = principled_view(bsdf, to_viewer);
  const MaskOf<V> diffuse = lobe >= view.p_coat + view.p_facets;
  Vec3<V> wi = cosine_hemisphere(u);
  if (!all(diffuse)) wi = select<V>(diffuse, wi, sample_facets(bsdf, view, lobe, u));
  const BsdfValue<V> value = eval(bsdf, view, wi);
  const MaskOf<V> valid = (wi.z != V(0.0f)) & (value.pdf > V(0.0f));
  const V pdf = select(valid, value.pdf, V(0.0f));
  const V scale = refraction_scale(view.side.eta, (wi.z < V(0.0f)) & view.refracts);
  wi.z = wi.z * view.side.sign;
  return {
      {wi, value.f_cos * (V(1.0f) / select(valid, pdf, V(1.0f))), pdf}, MaskOf<V>(false), scale};
}

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
