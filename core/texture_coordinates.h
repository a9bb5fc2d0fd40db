// Where on its texture a hit lies, and how the texture lies on the surface there.
#pragma once

#include "core/scene_data.h"
#include "core/simd_atan.h"
#include "core/warp.h"

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

template <class V>
struct TextureCoordinates {
  Vec2<V> uv;
  Vec3<V> du, dv;  // derivatives of the position; 0 where the coordinates do not span the surface
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

// The vertices of the lanes' triangles; of spheres those of some triangle.
template <class I>
LOCKSTEP_INLINE Vec3<I> load_vertices(const SceneData& scene, const Rows<I>& geometry,
                                      I primitive) {
  return gather_vec3(scene.triangles, geometry.x + primitive, 3);
}

// The triangles' corners on the texture; as in pbrt (0, 0), (1, 0) and (1, 1) where none are given.
template <class V>
struct UvCorners {
  Vec2<V> a, b, c;

  LOCKSTEP_INLINE Vec2<V> at(V u, V v) const {
    return {fma(u, b.x - a.x, fma(v, c.x - a.x, a.x)), fma(u, b.y - a.y, fma(v, c.y - a.y, a.y))};
  }
};

template <class I>
LOCKSTEP_INLINE UvCorners<FloatOf<I>> load_uv_corners(const float* uvs, const Vec3<I>& vertices,
                                                      MaskOf<I> has_uvs) {
  using V = FloatOf<I>;
  const auto corner = [&](I vertex, float u, float v) LOCKSTEP_LAMBDA {
    const auto row = gather_rows(uvs, vertex * I(2));
    return Vec2<V>(select(has_uvs, row.x, V(u)), select(has_uvs, row.y, V(v)));
  };
  return {corner(vertices.x, 0.0f, 0.0f), corner(vertices.y, 1.0f, 0.0f),
          corner(vertices.z, 1.0f, 1.0f)};
}

template <class V>
LOCKSTEP_INLINE TextureCoordinates<V> triangle_coordinates(const Corners<V>& p,
                                                           const UvCorners<V>& t, V u, V v) {
  const Vec2<V> e1 = t.b - t.a, e2 = t.c - t.a;
  const Vec3<V> edge1 = p.b - p.a, edge2 = p.c - p.a;
  const V det = fma(e1.x, e2.y, -(e1.y * e2.x));
  const MaskOf<V> spans = abs(det) > V(1e-20f);
  const V scale = select(spans, V(1.0f) / select(spans, det, V(1.0f)), V(0.0f));
  return {t.at(u, v), (edge1 * e2.y - edge2 * e1.y) * scale, (edge2 * e1.x - edge1 * e2.x) * scale};
}

// u runs around z from +x, v from -z to +z.
template <class V>
LOCKSTEP_INLINE TextureCoordinates<V> sphere_coordinates(const Vec3<V>& n, V radius) {
  const V turns = atan2_turns(n.y, n.x);
  const V ring = sqrt(fma(n.x, n.x, n.y * n.y));
  const V u = select(turns < V(0.0f), turns + V(1.0f), turns);
  const V v = V(2.0f) * atan2_turns(ring, -n.z);
  const V inverse = V(1.0f) / max(ring, V(1e-12f));
  const V along = radius * V(2.0f * pi), up = radius * V(pi);
  return {{u, v},
          {-(n.y * along), n.x * along, V(0.0f)},
          {-(n.z * n.x * inverse * up), -(n.z * n.y * inverse * up), ring * up}};
}

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
