// From a hit to what shading needs: a position that rays can leave from, and a frame.
#pragma once

#include "core/frame.h"
#include "core/texture_coordinates.h"
#include "packets/surface_maps.h"
#include "packets/wave.h"

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

template <class V>
struct Surface {
  Vec3<V> origin;            // of rays that leave on the viewer's side
  Vec3<V> origin_beyond;     // and on the other side
  Vec3<V> geometric_normal;  // unit, on the viewer's side
  Frame<V> frame;            // around the shading normal, on the viewer's side
  Vec3<V> wo;                // local, to where the ray came from; wo.z > 0
  MaskOf<V> outside;         // the viewer is on the side that the mesh calls outside
  TexturePoint<V> texture;   // where the scene has textures
};

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

template <class V>
LOCKSTEP_INLINE V largest_coordinate(const Corners<V>& p) {
  return max(max(max_component(abs(p.a)), max_component(abs(p.b))), max_component(abs(p.c)));
}

template <class I>
LOCKSTEP_INLINE MaskOf<I> is_sphere(const Rows<I>& geometry) {
  return (geometry.w & I(geometry_is_sphere)) != I(0);
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

// Three rows of a matrix, each with one value more.
template <class V>
struct MatrixRows {
  Rows<V> x, y, z;

  LOCKSTEP_INLINE Vec3<V> linear(const Vec3<V>& v) const {
    return {dot(Vec3<V>(x.x, x.y, x.z), v), dot(Vec3<V>(y.x, y.y, y.z), v),
            dot(Vec3<V>(z.x, z.y, z.z), v)};
  }
  LOCKSTEP_INLINE Vec3<V> affine(const Vec3<V>& p) const {
    return linear(p) + Vec3<V>(x.w, y.w, z.w);
  }
  // The largest that its parts may grow to for coordinates up to this.
  LOCKSTEP_INLINE V largest(V coordinate) const {
    const auto row = [&](const Rows<V>& r) LOCKSTEP_LAMBDA {
      return fma(abs(r.x) + abs(r.y) + abs(r.z), coordinate, abs(r.w));
    };
    return max(max(row(x), row(y)), row(z));
  }
};

// How the lanes' instances are placed; `part` 0: positions, 1: normals.
template <class I>
LOCKSTEP_INLINE MatrixRows<FloatOf<I>> load_matrix(const SceneData& scene, I instance, int part) {
  const I row = select(instance < I(0), I(0), instance - I(scene.instances.first_id) + I(1));
  const I at = row * I(instance_stride) + I(12 * part);
  const float* rows = scene.instances.rows;
  return {gather_rows(rows, at), gather_rows(rows + 4, at), gather_rows(rows + 8, at)};
}

// Where the lanes' hits lie on their textures; `normal`: of those on spheres.
template <FeatureMask F, class I, class V = FloatOf<I>>
LOCKSTEP_INLINE TextureCoordinates<V> load_coordinates(const SceneData& scene, I id,
                                                       const Rows<I>& geometry,
                                                       const Vec3<I>& vertices,
                                                       const Corners<V>& corners, V u, V v,
                                                       const Vec3<V>& normal) {
  const auto has_uvs = (geometry.w & I(geometry_has_uvs)) != I(0);
  TextureCoordinates<V> t =
      triangle_coordinates(corners, load_uv_corners(scene.uvs, vertices, has_uvs), u, v);
  if (needs<F>(scene, Feature::Spheres)) {
    const auto sphere = is_sphere(geometry);
    const V radius = gather(scene.geometry.spheres + 3, id * I(4));
    const TextureCoordinates<V> s = sphere_coordinates(normal, radius);
    t.uv = {select(sphere, s.uv.x, t.uv.x), select(sphere, s.uv.y, t.uv.y)};
    t.du = select<V>(sphere, s.du, t.du);
    t.dv = select<V>(sphere, s.dv, t.dv);
  }
  return t;
}

// What lookups there average over.
template <FeatureMask F, class V>
LOCKSTEP_INLINE UvFootprint<V> footprint_at(const SceneData& scene, const TextureCoordinates<V>& t,
                                            const Vec3<V>& position, const Vec3<V>& normal) {
  return uv_footprint(t.du, t.dv, footprint_width2<F>(scene, position, normal));
}

// Where a map turns the normal away from the viewer it is bent back until it just faces it.
template <class V>
LOCKSTEP_INLINE Vec3<V> facing_viewer(const Vec3<V>& normal, const Vec3<V>& away) {
  constexpr float least = 1e-2f;
  const V cosine = dot(normal, away);
  const Vec3<V> bent = normalize(fma(V(least) - cosine, away, normal));
  return select<V>(cosine < V(least), bent, normal);
}

template <FeatureMask F, class I>
LOCKSTEP_INLINE bool any_instance(const SceneData& scene, I instance) {
  return needs<F>(scene, Feature::Instances) && any(!(instance < I(0)));
}

// The lanes' triangles in the world.
template <class V>
struct PlacedTriangle {
  Corners<V> corners;
  Vec3<V> normal;  // of any length, to where the winding says outside is
  V magnitude;     // see HitPoint
};

template <FeatureMask F, class I>
LOCKSTEP_INLINE PlacedTriangle<FloatOf<I>> place_triangle(const SceneData& scene,
                                                          const Vec3<I>& vertices, I instance) {
  using V = FloatOf<I>;
  Corners<V> p = load_corners(scene.positions, vertices);
  V magnitude = largest_coordinate(p), handedness(1.0f);
  if (any_instance<F>(scene, instance)) {
    const MatrixRows<V> m = load_matrix(scene, instance, 0);
    p = {m.affine(p.a), m.affine(p.b), m.affine(p.c)};
    // Rounded on the way to the world, and rays again on their way back.
    magnitude = select(instance < I(0), magnitude, V(4.0f) * m.largest(magnitude));
    handedness = load_matrix(scene, instance, 1).x.w;
  }
  return {p, cross<V>(p.b - p.a, p.c - p.a) * handedness, magnitude};
}

// Turns the shading normal, at first the geometric one, to that between the lanes' vertices.
template <FeatureMask F, class I, class V = FloatOf<I>>
LOCKSTEP_INLINE void smooth_normal(const SceneData& scene, const Vec3<I>& vertices, I instance,
                                   I flags, V u, V v, const Vec3<V>& away, Surface<V>& s,
                                   Vec3<V>& shading) {
  Vec3<V> between = load_corners(scene.normals, vertices).at(u, v);
  if (any_instance<F>(scene, instance)) {
    between = load_matrix(scene, instance, 1).linear(between);
  }
  const Vec3<V> n = normalize_any(between);
  const MaskOf<V> smooth = (flags & I(geometry_is_smooth)) != I(0);
  const MaskOf<V> turned = dot(n, s.geometric_normal) < V(0.0f);
  // Vertex normals say where the outside is, whatever the winding.
  s.outside = select(smooth, MaskOf<V>(!turned), s.outside);
  const Vec3<V> facing = select<V>(turned, -n, n);
  // Where interpolation turns the normal away from the viewer, the geometric one serves.
  shading = select<V>(smooth & (dot(facing, away) > V(1e-4f)), facing, shading);
}

// Turns the shading normal to what the materials' normal and bump maps make of it.
template <int W, FeatureMask F>
LOCKSTEP_INLINE void turn_by_maps(const SceneData& scene, const ShadeQueue& queue, int i,
                                  const Int<W>& material_of_geometry,
                                  const TextureCoordinates<Float<W>>& t, const Vec3<Float<W>>& away,
                                  const Surface<Float<W>>& s, Vec3<Float<W>>& shading) {
  using V = Float<W>;
  Int<W> material = load<Int<W>>(queue.material + i);
  if (needs<F>(scene, Feature::Mix)) {
    material = material_with_maps(scene, material, material_of_geometry);
  }
  const V side = select(s.outside, V(1.0f), V(-1.0f));
  const Vec3<V> outer = shading * side;
  const Vec3<V> mapped = apply_surface_maps<W>(scene, material, lanes_below<W>(i, queue.count), t,
                                               s.texture.footprint, outer);
  const auto altered = (mapped.x != outer.x) | (mapped.y != outer.y) | (mapped.z != outer.z);
  shading = select<V>(altered, facing_viewer<V>(mapped * side, away), shading);
}

// The surface at entries i... of the queue, whose geometries have these rows.
template <int W, FeatureMask F>
LOCKSTEP_INLINE Surface<Float<W>> load_surface(const SceneData& scene, const ShadeQueue& queue,
                                               int i, const Rows<Int<W>>& geometry) {
  using V = Float<W>;
  using I = Int<W>;
  const Vec3<V> direction = load3<V>(queue.direction, i), away = -direction;
  const Vec3<I> vertices = load_vertices(scene, geometry, load<I>(queue.primitive + i));
  const V u = load<V>(queue.barycentric_u + i), v = load<V>(queue.barycentric_v + i);
  const I instance = needs<F>(scene, Feature::Instances) ? load<I>(queue.instance + i) : I(-1);
  const PlacedTriangle<V> triangle = place_triangle<F>(scene, vertices, instance);
  HitPoint<V> hit{triangle.corners.at(u, v), triangle.magnitude};
  Vec3<V> normal = triangle.normal;
  if (needs<F>(scene, Feature::Spheres)) {
    const Vec3<V> on_ray = fma(load<V>(queue.distance + i), direction, load3<V>(queue.origin, i));
    refine_sphere(scene, is_sphere(geometry), load<I>(queue.geometry + i), on_ray, hit, normal);
  }

  Surface<V> s;
  const Vec3<V> unit = normalize_any(normal);
  const Mask<W> behind = dot(unit, away) < V(0.0f);
  s.outside = !behind;
  s.geometric_normal = select<V>(behind, -unit, unit);
  const V offset = V(offset_scale) * hit.magnitude;
  s.origin = fma(offset, s.geometric_normal, hit.position);
  s.origin_beyond = fma(-offset, s.geometric_normal, hit.position);

  Vec3<V> shading = s.geometric_normal, tangent(V(0.0f));
  if (needs<F>(scene, Feature::SmoothNormals)) {
    smooth_normal<F>(scene, vertices, instance, geometry.w, u, v, away, s, shading);
  }
  if (needs_any<F>(scene, uv_features)) {
    const TextureCoordinates<V> t = load_coordinates<F>(
        scene, load<I>(queue.geometry + i), geometry, vertices, triangle.corners, u, v, unit);
    s.texture.uv = t.uv;
    if (needs<F>(scene, Feature::Trilinear)) {
      s.texture.footprint = footprint_at<F>(scene, t, hit.position, s.geometric_normal);
    }
    tangent = t.du;
    if (needs<F>(scene, Feature::SurfaceMaps)) {
      turn_by_maps<W, F>(scene, queue, i, geometry.y, t, away, s, shading);
    }
  }
  s.frame =
      needs<F>(scene, Feature::Tangents) ? frame_along(shading, tangent) : frame_around(shading);
  s.wo = s.frame.to_local(away);
  s.wo.z = max(s.wo.z, V(1e-6f));  // a grazing ray may round to below the horizon
  return s;
}

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
