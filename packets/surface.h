// From a hit to what shading needs: a position that rays can leave from, and a frame.
#pragma once

#include "core/frame.h"
#include "packets/wave.h"

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

template <class V>
struct Surface {
  Vec3<V> origin;            // of rays that leave on the viewer's side
  Vec3<V> geometric_normal;  // unit, on the viewer's side
  Frame<V> frame;            // around the shading normal, on the viewer's side
  Vec3<V> wo;                // local, to where the ray came from; wo.z > 0
};

// Normalises vectors whose squared length would leave float's range.
template <class V>
LOCKSTEP_INLINE Vec3<V> normalize_any(const Vec3<V>& a) {
  const V largest = max(max_component(abs(a)), V(std::numeric_limits<float>::min()));
  return normalize(a * (V(1.0f) / largest));
}

// A point interpolated between a triangle's corners is off its plane by at most seven roundings of
// the largest coordinate (Pharr, Jakob and Humphreys 2023, section 6.8.4), wherever the ray came
// from. Rays leave from outside that.
inline constexpr float offset_scale = 0x1p-21f;

// Where a ray hit, and how large the coordinates are that this was computed from.
template <class V>
struct HitPoint {
  Vec3<V> position;
  V magnitude;
};

// Values at the corners of the lanes' triangles, of three floats per vertex.
template <class V>
struct Corners {
  Vec3<V> a, b, c;

  LOCKSTEP_INLINE Vec3<V> at(V u, V v) const { return fma(u, b, fma(v, c, a * (V(1.0f) - u - v))); }
};

template <class I>
LOCKSTEP_INLINE Corners<FloatOf<I>> load_corners(const float* values, const Vec3<I>& vertices) {
  return {gather_vec3(values, vertices.x, 3), gather_vec3(values, vertices.y, 3),
          gather_vec3(values, vertices.z, 3)};
}

template <class V>
LOCKSTEP_INLINE V largest_coordinate(const Corners<V>& p) {
  return max(max(max_component(abs(p.a)), max_component(abs(p.b))), max_component(abs(p.c)));
}

// Spheres: the hit is put back onto the sphere, whose normal there is exact.
template <class I>
LOCKSTEP_INLINE void refine_sphere(const SceneData& scene, MaskOf<I> sphere, I geometry,
                                   const Vec3<FloatOf<I>>& on_ray, HitPoint<FloatOf<I>>& hit,
                                   Vec3<FloatOf<I>>& normal) {
  using V = FloatOf<I>;
  if (none(sphere)) return;
  const auto row = gather_rows(scene.geometry.spheres, geometry * I(4));
  const Vec3<V> centre(row.x, row.y, row.z);
  const V radius = row.w;
  const Vec3<V> n = normalize_any<V>(on_ray - centre);
  hit.position = select<V>(sphere, fma(radius, n, centre), hit.position);
  hit.magnitude = select(sphere, max_component(abs(centre)) + radius, hit.magnitude);
  normal = select<V>(sphere, n, normal);
}

// The surface at entries i... of the queue, whose geometries have these rows.
template <int W, FeatureMask F>
LOCKSTEP_INLINE Surface<Float<W>> load_surface(const SceneData& scene, const ShadeQueue& queue,
                                               int i, const Rows<Int<W>>& geometry) {
  using V = Float<W>;
  using I = Int<W>;
  const Vec3<V> direction = load3<V>(queue.direction, i);
  const Vec3<I> vertices =
      gather_vec3(scene.triangles, geometry.x + load<I>(queue.primitive + i), 3);
  const V u = load<V>(queue.barycentric_u + i), v = load<V>(queue.barycentric_v + i);
  const Corners<V> corners = load_corners(scene.positions, vertices);
  HitPoint<V> hit{corners.at(u, v), largest_coordinate(corners)};
  Vec3<V> normal = cross<V>(corners.b - corners.a, corners.c - corners.a);
  if (needs<F>(scene, Feature::Spheres)) {
    const Mask<W> sphere = (geometry.w & I(geometry_is_sphere)) != I(0);
    const Vec3<V> on_ray = fma(load<V>(queue.distance + i), direction, load3<V>(queue.origin, i));
    refine_sphere(scene, sphere, load<I>(queue.geometry + i), on_ray, hit, normal);
  }

  Surface<V> s;
  const Vec3<V> unit = normalize_any(normal);
  const Vec3<V> away = -direction;
  s.geometric_normal = select<V>(dot(unit, away) < V(0.0f), -unit, unit);
  s.origin = fma(V(offset_scale) * hit.magnitude, s.geometric_normal, hit.position);

  Vec3<V> shading = s.geometric_normal;
  if (needs<F>(scene, Feature::SmoothNormals)) {
    const Vec3<V> n = normalize_any(load_corners(scene.normals, vertices).at(u, v));
    const Vec3<V> facing = select<V>(dot(n, s.geometric_normal) < V(0.0f), -n, n);
    // Where interpolation turns the normal away from the viewer, the geometric one serves.
    const auto usable =
        ((geometry.w & I(geometry_is_smooth)) != I(0)) & (dot(facing, away) > V(1e-4f));
    shading = select<V>(usable, facing, shading);
  }
  s.frame = frame_around(shading);
  s.wo = s.frame.to_local(away);
  s.wo.z = max(s.wo.z, V(1e-6f));  // a grazing ray may round to below the horizon
  return s;
}

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
