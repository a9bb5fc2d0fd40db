// Choosing a light, a point on it, and the densities of both.
// Densities are per solid angle at the point that is lit and include the probability of choosing
// the light. Directions point from the lit point to the light and are unit vectors.
#pragma once

#include "core/environment_map_lookup.h"
#include "core/flat_light.h"
#include "core/frame.h"
#include "core/light_description.h"
#include "core/simd_atan.h"
#include "core/texture_coordinates.h"

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

// 1 - cos of the half angle under which a sphere is seen; negative from inside it.
template <class V>
LOCKSTEP_INLINE V sphere_cone(V distance2, V radius) {
  const V sin2 = radius * radius / distance2;
  const V cos_max = sqrt(max(V(0.0f), V(1.0f) - sin2));
  return select(sin2 < V(1.0f), sin2 / (V(1.0f) + cos_max), V(-1.0f));
}

// From outside: uniform in the cone that the sphere fills. From inside: uniform over its area.
template <class V>
LOCKSTEP_INLINE LightSample<V> sample_sphere_light(const LightRow<V>& light, const Vec3<V>& p,
                                                   Vec2<V> u) {
  const Vec3<V> to_centre = light.corner - p;
  const V distance2 = dot(to_centre, to_centre);
  const V radius = light.area;
  const V one_minus_cos = sphere_cone(distance2, radius);
  const MaskOf<V> outside = one_minus_cos > V(0.0f);

  const V centre_distance = sqrt(distance2);
  const Frame<V> frame = frame_around(to_centre * (V(1.0f) / max(centre_distance, V(1e-30f))));
  const Vec3<V> local = uniform_cone(u, max(one_minus_cos, V(0.0f)));
  const V sin2 = fma(local.x, local.x, local.y * local.y);
  const V half_chord = sqrt(max(V(0.0f), fma(radius, radius, -(distance2 * sin2))));
  // Ends before the surface: this close to it, rounding would let the sphere hide itself.
  const V outside_distance =
      max(V(0.0f), fma(centre_distance, local.z, -fma(V(0x1p-18f), radius, half_chord)));

  const Vec3<V> n = uniform_sphere(u);
  const Vec3<V> to = fma(radius, n, to_centre);
  const V inside_distance = length(to);
  const Vec3<V> inside_wi = to * (V(1.0f) / max(inside_distance, V(1e-30f)));
  const V inside_pdf =
      solid_angle_pdf(inside_distance, abs(dot(n, inside_wi)), V(4.0f * pi) * radius * radius);

  const V side_seen = select(outside, V(1.0f), V(-1.0f));
  const V pdf = light.probability * select(outside, uniform_cone_pdf(one_minus_cos), inside_pdf);
  const MaskOf<V> lit = emits(light.side, side_seen) & is_finite(pdf);
  return {select(outside, frame.to_world(local), inside_wi),
          select(outside, outside_distance, inside_distance), light.radiance,
          select(lit, pdf, V(0.0f))};
}

// Density with which sample_environment gives a direction at this angle to the shading normal.
template <bool both_sides, class V>
LOCKSTEP_INLINE V environment_pdf(V cos_theta) {
  if constexpr (both_sides) return V(0.5f) * cosine_hemisphere_pdf(abs(cos_theta));
  return cosine_hemisphere_pdf(cos_theta);
}

// The constant environment, seen by a surface: cosine-weighted around its shading normal, or around
// either side of it.
template <bool both_sides, class V>
LOCKSTEP_INLINE LightSample<V> sample_environment(const LightRow<V>& light, const Frame<V>& frame,
                                                  Vec2<V> u) {
  MaskOf<V> below(false);
  if constexpr (both_sides) {
    below = u.x >= V(0.5f);
    u.x = fma(V(2.0f), u.x, select(below, V(-1.0f), V(0.0f)));
  }
  Vec3<V> local = cosine_hemisphere(u);
  const V pdf = environment_pdf<both_sides>(local.z);
  local.z = select(below, -local.z, local.z);
  return {frame.to_world(local), V(std::numeric_limits<float>::infinity()), light.radiance,
          light.probability * pdf};
}

template <class V>
LOCKSTEP_INLINE LightSample<V> sample_map_light(const EnvironmentMapData& map,
                                                const LightRow<V>& light, Vec2<V> u) {
  const MapSample<V> s = sample_environment_map(map, u);
  return {s.wi, V(std::numeric_limits<float>::infinity()), s.radiance, light.probability * s.pdf};
}

// Share of its axis' intensity that a spot light sends at an angle of this cosine to the axis.
template <class V>
LOCKSTEP_INLINE V spot_falloff(const LightRow<V>& light, V cos_axis) {
  const V inner = light.edge1.x, outer = light.edge1.y, kind = light.edge1.z;
  // 0 at the outer cone, 1 at the inner one; a hard edge where they are the same.
  const V width = max(inner - outer, V(1e-7f));
  const V x = min(max((cos_axis - outer) / width, V(0.0f)), V(1.0f));
  V share = x * x * (V(3.0f) - (x + x));
  const auto is = [&](SpotLight::Falloff f) LOCKSTEP_LAMBDA { return kind == V(float(int(f))); };
  share = select(is(SpotLight::Falloff::Squared), x * x, share);
  share = select(is(SpotLight::Falloff::Quartic), (x * x) * (x * x), share);
  const MaskOf<V> in_angle = is(SpotLight::Falloff::LinearAngle);
  if (any(in_angle)) {
    const V a = light.edge2.x, b = light.edge2.y;
    const V sin_axis = sqrt(max(V(0.0f), fma(-cos_axis, cos_axis, V(1.0f))));
    const V angle = V(2.0f * pi) * atan2_turns(sin_axis, cos_axis);
    const V y = min(max((b - angle) / max(b - a, V(1e-7f)), V(0.0f)), V(1.0f));
    share = select(in_angle, y, share);
  }
  return share;
}

// Point, spot and distant lights: the one direction that they are in.
template <class V>
LOCKSTEP_INLINE LightSample<V> sample_delta_light(const LightRow<V>& light, MaskOf<V> spot,
                                                  MaskOf<V> distant, const Vec3<V>& p) {
  const Vec3<V> to = light.corner - p;
  const V distance2 = dot(to, to);
  const V distance = sqrt(distance2);
  const Vec3<V> wi = select<V>(distant, -light.normal, to * (V(1.0f) / distance));
  V scale = select(distant, V(1.0f), V(1.0f) / distance2);
  if (any(spot)) scale = select(spot, scale * spot_falloff(light, -dot(light.normal, wi)), scale);
  const MaskOf<V> lit = (scale > V(0.0f)) & is_finite(scale);
  return {wi, select(distant, V(std::numeric_limits<float>::infinity()), distance),
          light.radiance * scale, select(lit, light.probability, V(0.0f))};
}

// How a texture lies on the lanes' textured triangles.
template <class V>
struct Glow {
  UvCorners<V> uvs;
  V binding;
};
template <class V>
LOCKSTEP_INLINE Glow<V> load_glow(const LightTable& t, const LightRow<V>& light) {
  const V number = select(is_textured(light), light.outline - V(1.0f), V(0.0f));
  const IntOf<V> at = to_int(number) * IntOf<V>(glow_stride);
  const auto a = gather_rows(t.glows, at), b = gather_rows(t.glows + 4, at);
  return {{{a.x, a.y}, {a.z, a.w}, {b.x, b.y}}, b.z};
}

// A direction from p, with shading frame `frame`, to the lanes' lights. `both_sides`: light from
// below the surface counts too.
template <class V, FeatureMask F = all_features, bool both_sides = false>
LOCKSTEP_INLINE LightSample<V> sample_light(const SceneData& scene, IntOf<V> index,
                                            const Vec3<V>& p, const Frame<V>& frame, Vec2<V> u) {
  const LightRow<V> light = load_light(scene.lights, index);
  LightSample<V> s{Vec3<V>(V(0.0f)), V(0.0f), Vec3<V>(V(0.0f)), V(0.0f)};
  const auto merge = [&](MaskOf<V> m, const LightSample<V>& other) LOCKSTEP_LAMBDA {
    s = {select<V>(m, other.wi, s.wi),
         select(m, other.distance, s.distance),
         select<V>(m, other.radiance, s.radiance),
         select(m, other.pdf, s.pdf),
         s.delta,
         s.place};
  };
  const auto of_kind = [&](Feature feature, LightKind kind) LOCKSTEP_LAMBDA {
    return needs<F>(scene, feature) ? light.is(kind) : MaskOf<V>(false);
  };
  const MaskOf<V> triangle = of_kind(Feature::TriangleLights, LightKind::Triangle);
  const MaskOf<V> quad = of_kind(Feature::QuadLights, LightKind::Parallelogram);
  const MaskOf<V> disk = of_kind(Feature::DiskLights, LightKind::Disk);
  const MaskOf<V> flat = quad | triangle | disk;
  const MaskOf<V> sphere = of_kind(Feature::SphereLights, LightKind::Sphere);
  const MaskOf<V> environment = of_kind(Feature::Environment, LightKind::Environment);
  if (any(flat)) {
    const LightSample<V> on_flat = sample_flat_light(light, quad, triangle, disk, p, u);
    merge(flat, on_flat);
    if (needs<F>(scene, Feature::TexturedLights)) s.place = on_flat.place;
  }
  if (any(sphere)) merge(sphere, sample_sphere_light(light, p, u));
  if (any(environment)) merge(environment, sample_environment<both_sides>(light, frame, u));
  if (needs<F>(scene, Feature::EnvironmentMap)) {
    const MaskOf<V> map = light.is(LightKind::EnvironmentMap);
    if (any(map)) merge(map, sample_map_light(scene.environment_map, light, u));
  }
  if (needs_any<F>(scene, delta_light_features)) {
    const MaskOf<V> spot = of_kind(Feature::SpotLights, LightKind::Spot);
    const MaskOf<V> distant = of_kind(Feature::DistantLights, LightKind::Distant);
    s.delta = spot | distant | of_kind(Feature::PointLights, LightKind::Point);
    if (any(s.delta)) merge(s.delta, sample_delta_light(light, spot, distant, p));
  }
  return s;
}

template <class V>
struct Emitted {
  Vec3<V> radiance;  // 0 from the side that does not emit
  V pdf;             // with which sample_light gives this direction; below infinity
  MaskOf<V> glows;   // radiance is still to be multiplied by the texture that
  IntOf<V> binding;  // this binding names: only where the scene has textured lights
};

// What a ray from p along wi receives from the area light it hits at `distance`.
template <class V, FeatureMask F = all_features>
LOCKSTEP_INLINE Emitted<V> hit_light(const SceneData& scene, IntOf<V> index, const Vec3<V>& p,
                                     const Vec3<V>& wi, V distance) {
  const LightRow<V> light = load_light(scene.lights, index);
  MaskOf<V> sphere = light.is(LightKind::Sphere), found(false);  // found: never chosen
  if (needs<F>(scene, Feature::TexturedLights)) {
    found = light.is(LightKind::Glow);
    sphere = sphere | (found & (light.area > V(0.0f)));
  }
  V cos_light = -dot(light.normal, wi);
  V pdf = solid_angle_pdf(distance, max(abs(cos_light), V(1e-20f)), light.area);
  const V solid_angle = flat_light_solid_angle<V, F>(scene, light, p);
  pdf = select(solid_angle > V(0.0f), V(1.0f) / solid_angle, pdf);
  if (needs<F>(scene, Feature::SphereLights) && any(sphere)) {
    const Vec3<V> to_centre = light.corner - p;
    const V one_minus_cos = sphere_cone(dot(to_centre, to_centre), light.area);
    const MaskOf<V> outside = one_minus_cos > V(0.0f);
    const Vec3<V> n = fma(distance, wi, -to_centre) * (V(1.0f) / light.area);
    const V inside_pdf = solid_angle_pdf(distance, max(abs(dot(n, wi)), V(1e-20f)),
                                         V(4.0f * pi) * light.area * light.area);
    pdf = select(sphere, select(outside, uniform_cone_pdf(one_minus_cos), inside_pdf), pdf);
    cos_light = select(sphere, -dot(n, wi), cos_light);
  }
  const Vec3<V> none(V(0.0f));
  Emitted<V> e{select<V>(emits(light.side, cos_light), light.radiance, none),
               min(pdf * light.probability, V(1e38f)), found, IntOf<V>(0)};
  if (needs<F>(scene, Feature::TexturedLights)) {
    const MaskOf<V> chosen = is_textured(light);
    e.pdf = select(found, V(0.0f), e.pdf);
    e.glows = found | chosen;
    V binding = light.edge1.x;
    if (any(chosen)) binding = select(chosen, load_glow(scene.lights, light).binding, binding);
    e.binding = to_int(select(e.glows, binding, V(0.0f)));
  }
  return e;
}

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
