// Lights in a plane: rectangles and triangles by solid angle where that is large enough to matter,
// others by area.
#pragma once

#include "core/light_row.h"
#include "core/spherical_rectangle.h"
#include "core/spherical_triangle.h"

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

// Below this, grazing views would move samples by more than 2e-3 of the solid angle, and uniform
// area is as good from afar.
inline constexpr float min_solid_angle = 1e-2f;

// Lanes whose light is of that kind and may have such a solid angle: a light that is small for the
// distance of its corner has none, and if all have none the formulas are not worth their time.
template <class V>
LOCKSTEP_INLINE MaskOf<V> is_near(const LightRow<V>& light, LightKind kind,
                                  const Vec3<V>& to_corner) {
  return light.is(kind) & (light.area >= V(min_solid_angle) * dot(to_corner, to_corner));
}

// A light that is a rectangle as p sees it; of solid angle 0 where it is sampled by area.
template <class V>
LOCKSTEP_INLINE SphericalRectangle<V> seen_rectangle(const LightRow<V>& light, const Vec3<V>& p) {
  const Vec3<V> to_corner = light.corner - p;
  const MaskOf<V> near =
      is_near(light, LightKind::Parallelogram, to_corner) & (light.outline > V(0.0f));
  if (none(near)) return {};
  SphericalRectangle<V> s = spherical_rectangle(to_corner, light.edge1, light.edge2, light.normal);
  s.solid_angle = select(near & (s.solid_angle >= V(min_solid_angle)), s.solid_angle, V(0.0f));
  return s;
}

// As above, for a triangle.
template <class V>
LOCKSTEP_INLINE SphericalTriangle<V> seen_triangle(const LightRow<V>& light, const Vec3<V>& p) {
  const Vec3<V> to_corner = light.corner - p;
  const MaskOf<V> near = is_near(light, LightKind::Triangle, to_corner);
  if (none(near)) return {};
  SphericalTriangle<V> s = spherical_triangle(to_corner, light.edge1, light.edge2);
  const MaskOf<V> usable =
      near & (s.solid_angle >= V(min_solid_angle)) & (s.solid_angle <= V(max_triangle_angle));
  s.solid_angle = select(usable, s.solid_angle, V(0.0f));
  return s;
}

// A point on a flat light as shares of its edges, and the solid angle that it is uniform in; 0
// where it is uniform in area. The masks say which lanes have a light of that kind.
template <class V>
struct PointOnLight {
  Vec2<V> place;
  V solid_angle;
};
template <class V>
LOCKSTEP_INLINE PointOnLight<V> point_on_light(const LightRow<V>& light, MaskOf<V> quad,
                                               MaskOf<V> triangle, MaskOf<V> disk, const Vec3<V>& p,
                                               Vec2<V> u) {
  PointOnLight<V> on{u, V(0.0f)};
  const auto merge = [&](const auto& seen, auto sample) LOCKSTEP_LAMBDA {
    const MaskOf<V> by_angle = seen.solid_angle > V(0.0f);
    if (none(by_angle)) return;
    on = {select<V>(by_angle, sample(seen, u), on.place),
          select(by_angle, seen.solid_angle, on.solid_angle)};
  };
  if (any(quad)) {
    merge(seen_rectangle(light, p), [](const auto& s, Vec2<V> v) LOCKSTEP_LAMBDA {
      return sample_spherical_rectangle(s, v);
    });
  }
  if (any(triangle)) {
    on.place = select<V>(triangle, uniform_triangle(u), on.place);
    merge(seen_triangle(light, p),
          [](const auto& s, Vec2<V> v) LOCKSTEP_LAMBDA { return sample_spherical_triangle(s, v); });
  }
  if (any(disk)) on.place = select<V>(disk, uniform_polygon(u, light.outline), on.place);
  return on;
}

template <class V>
LOCKSTEP_INLINE LightSample<V> sample_flat_light(const LightRow<V>& light, MaskOf<V> quad,
                                                 MaskOf<V> triangle, MaskOf<V> disk,
                                                 const Vec3<V>& p, Vec2<V> u) {
  const auto [place, solid_angle] = point_on_light(light, quad, triangle, disk, p, u);
  const Vec3<V> to = light.corner + fma(place.x, light.edge1, light.edge2 * place.y) - p;
  const V distance2 = dot(to, to);
  const V inverse_distance = rsqrt(distance2);
  const Vec3<V> wi = to * inverse_distance;
  const V cos_light = -dot(light.normal, wi);
  // By solid angle, or by area: see solid_angle_pdf.
  const MaskOf<V> by_angle = solid_angle > V(0.0f);
  const V density = select(by_angle, V(1.0f), distance2) /
                    select(by_angle, solid_angle, abs(cos_light) * light.area);
  const V pdf = light.probability * density;
  const MaskOf<V> lit = emits(light.side, cos_light) & (distance2 > V(0.0f)) & is_finite(pdf);
  return {wi,
          distance2 * inverse_distance,
          light.radiance,
          select(lit, pdf, V(0.0f)),
          MaskOf<V>(false),
          place};
}

// The solid angle in which sample_flat_light is uniform as p sees the light; 0: in area.
template <class V, FeatureMask F>
LOCKSTEP_INLINE V flat_light_solid_angle(const SceneData& scene, const LightRow<V>& light,
                                         const Vec3<V>& p) {
  V solid_angle(0.0f);
  if (needs<F>(scene, Feature::QuadLights)) solid_angle = seen_rectangle(light, p).solid_angle;
  if (needs<F>(scene, Feature::TriangleLights)) {
    solid_angle = max(solid_angle, seen_triangle(light, p).solid_angle);
  }
  return solid_angle;
}

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
