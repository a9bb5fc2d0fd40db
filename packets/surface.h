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

// Rounding moves a hit off its surface by some ulps of the largest number in play: the origin, the
// hit, or the size of the triangle, which its normal's length tells. Rays leave from outside that.
inline constexpr float offset_scale = 0x1p-18f;

template <class V>
LOCKSTEP_INLINE V offset_distance(const Vec3<V>& from, const Vec3<V>& hit, const Vec3<V>& normal) {
  const V size = sqrt(max_component(abs(normal)));
  return V(offset_scale) * max(max(max_component(abs(from)), max_component(abs(hit))), size);
}

// The interpolated vertex normal of the lanes' triangles, not unit.
template <class I>
LOCKSTEP_INLINE Vec3<FloatOf<I>> interpolated_normal(const SceneData& scene, const HitArray& hits,
                                                     I ray, I geometry, I primitive) {
  using V = FloatOf<I>;
  const I triangle = (gather(scene.geometry.first_triangle, geometry) + primitive) * I(3);
  const Vec3<V> n0 = gather_vec3(scene.normals, gather(scene.triangles, triangle), 3);
  const Vec3<V> n1 = gather_vec3(scene.normals, gather(scene.triangles + 1, triangle), 3);
  const Vec3<V> n2 = gather_vec3(scene.normals, gather(scene.triangles + 2, triangle), 3);
  const V u = gather(hits.u, ray), v = gather(hits.v, ray);
  return fma(u, n1, fma(v, n2, n0 * (V(1.0f) - u - v)));
}

// Spheres: the hit is put back onto the sphere, whose normal there is exact; its length, like a
// triangle's, is the square of the shape's size.
template <class I>
LOCKSTEP_INLINE void refine_sphere(const SceneData& scene, I geometry, Vec3<FloatOf<I>>& hit,
                                   Vec3<FloatOf<I>>& normal) {
  using V = FloatOf<I>;
  const auto sphere = gather(scene.geometry.is_sphere, geometry) == I(1);
  if (none(sphere)) return;
  const Vec3<V> centre = gather_vec3(scene.geometry.spheres, geometry, 4);
  const V radius = gather(scene.geometry.spheres + 3, geometry * I(4));
  const Vec3<V> n = normalize_any<V>(hit - centre);
  hit = select<V>(sphere, fma(radius, n, centre), hit);
  normal = select<V>(sphere, n * (radius * radius), normal);
}

// The surface that the rays of the queue with these indices hit. Lanes that hit nothing must not
// be asked for.
template <class I>
LOCKSTEP_INLINE Surface<FloatOf<I>> load_surface(const SceneData& scene, const RayQueue& rays,
                                                 const HitArray& hits, I ray, I geometry) {
  using V = FloatOf<I>;
  const Vec3<V> from = gather3(rays.origin, ray), direction = gather3(rays.direction, ray);
  Vec3<V> hit = fma(gather(hits.distance, ray), direction, from);
  Vec3<V> normal = gather3(hits.normal, ray);
  if (scene.spheres) refine_sphere(scene, geometry, hit, normal);
  const V offset = offset_distance(from, hit, normal);

  Surface<V> s;
  const Vec3<V> unit = normalize_any(normal);
  const Vec3<V> away = -direction;
  s.geometric_normal = select<V>(dot(unit, away) < V(0.0f), -unit, unit);
  s.origin = fma(offset, s.geometric_normal, hit);

  Vec3<V> shading = s.geometric_normal;
  if (scene.smooth_normals) {
    const Vec3<V> n =
        normalize_any(interpolated_normal(scene, hits, ray, geometry, gather(hits.primitive, ray)));
    const Vec3<V> facing = select<V>(dot(n, s.geometric_normal) < V(0.0f), -n, n);
    // Where interpolation turns the normal away from the viewer, the geometric one serves.
    const auto usable =
        (gather(scene.geometry.is_smooth, geometry) == I(1)) & (dot(facing, away) > V(1e-4f));
    shading = select<V>(usable, facing, shading);
  }
  s.frame = frame_around(shading);
  s.wo = s.frame.to_local(away);
  s.wo.z = max(s.wo.z, V(1e-6f));  // a grazing ray may round to below the horizon
  return s;
}

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
