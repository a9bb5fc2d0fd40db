// From hits in the order of their rays to the hits on one kind of material, side by side.
#pragma once

#include "core/hash.h"
#include "packets/surface.h"
#include "packets/textured.h"
#include "packets/wave.h"

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

// Geometry rows of the lanes' hits; of lanes without one those of geometry 0.
template <class I>
LOCKSTEP_INLINE Rows<I> geometry_of_hits(const SceneData& scene, I geometry, MaskOf<I> hit) {
  return gather_rows(scene.geometry.rows, select(hit, geometry, I(0)) * I(geometry_stride));
}

// Where the hits at i... lie on their textures.
template <int W, FeatureMask F>
LOCKSTEP_INLINE TexturePoint<Float<W>> texture_point(const SceneData& scene, const RayQueue& rays,
                                                     const HitArray& hits, int i,
                                                     const Mask<W>& hit,
                                                     const Rows<Int<W>>& geometry) {
  using V = Float<W>;
  using I = Int<W>;
  const I id = select(hit, load<I>(hits.geometry + i), I(0));
  const Vec3<I> vertices =
      load_vertices(scene, geometry, select(hit, load<I>(hits.primitive + i), I(0)));
  const V u = load<V>(hits.u + i), v = load<V>(hits.v + i);
  const bool filtered = needs<F>(scene, Feature::Trilinear);
  PlacedTriangle<V> triangle{};  // which uv alone does not need
  if (filtered) {
    const bool instances = needs<F>(scene, Feature::Instances);
    const I instance = instances ? load<I>(hits.instance + i) : I(-1);
    triangle = place_triangle<F>(scene, vertices, select(hit, instance, I(-1)));
  }
  HitPoint<V> point{triangle.corners.at(u, v), triangle.magnitude};
  Vec3<V> normal = triangle.normal;
  if (needs<F>(scene, Feature::Spheres)) {
    const Vec3<V> on_ray =
        fma(load<V>(hits.distance + i), load3<V>(rays.direction, i), load3<V>(rays.origin, i));
    refine_sphere(scene, hit & is_sphere(geometry), id, on_ray, point, normal);
  }
  const Vec3<V> unit = normalize_any(normal);
  const TextureCoordinates<V> t =
      load_coordinates<F>(scene, id, geometry, vertices, triangle.corners, u, v, unit);
  TexturePoint<V> at{t.uv, {}};
  if (filtered) at.footprint = footprint_at<F>(scene, t, point.position, unit);
  return at;
}

// Mixed materials: each path goes on with one of the parts, chosen by a number of its own that no
// other path and no bounce shares, at the textures' amount.
template <int W, FeatureMask F>
[[gnu::noinline]] void resolve_mixes(const TileJob& job, const PathTable& paths,
                                     const RayQueue& rays, int bounce, HitArray& hits) {
  using V = Float<W>;
  using I = Int<W>;
  using U = UInt<W>;
  const SceneData& scene = *job.scene;
  for (int i = 0; i < rays.count; i += W) {
    const I id = load<I>(hits.geometry + i);
    const Mask<W> hit = lanes_below<W>(i, rays.count) & !(id < I(0));
    const Rows<I> geometry = geometry_of_hits(scene, id, hit);
    I material = geometry.y;
    for (std::uint32_t level = 0;; ++level) {
      const Mask<W> mixed =
          hit & (gather(scene.materials.kinds, material) == I(int(MaterialKind::Mix)));
      if (none(mixed)) break;
      MaterialRows<W> rows;
      TexturePoint<V> at{Vec2<V>(V(0.0f)), {}};
      if (needs<F>(scene, Feature::Textures)) {
        at = texture_point<W, F>(scene, rays, hits, i, hit, geometry);
      }
      load_textured_rows<W>(scene, material, mixed, at, rows);
      const auto row = gather_rows(rows.parameters, lane_indices<W>() * I(material_stride));
      const I path = select(hit, load<I>(rays.path + i), I(0));
      const U key(job.sampler->seed ^ 0x6d697865u);
      const V u = unit_float(pcg4d(gather(paths.pixel, path), gather(paths.sample, path),
                                   U(std::uint32_t(bounce) | level << 16), key)
                                 .x);
      material = select(mixed, to_int(select(u < row.z, row.y, row.x)), material);
    }
    store(hits.material + i, material);
  }
}

// The kind of the lanes' materials, and which material it is.
template <class I>
struct HitMaterial {
  I material, kind;
};

template <int W, FeatureMask F>
LOCKSTEP_INLINE HitMaterial<Int<W>> hit_material(const SceneData& scene, const HitArray& hits,
                                                 int i, const Mask<W>& hit) {
  using I = Int<W>;
  if (needs<F>(scene, Feature::Mix)) {
    const I material = select(hit, load<I>(hits.material + i), I(0));
    return {material, gather(scene.materials.kinds, material)};
  }
  const I row = select(hit, load<I>(hits.geometry + i), I(0)) * I(geometry_stride);
  const I kind = as_int(as_uint(gather(scene.geometry.rows + 3, row)) >> geometry_kind_shift);
  return {gather(scene.geometry.rows + 1, row), kind};
}

// What a hit and its ray hand on to shading.
template <int W, FeatureMask F, class Get, class Put>
LOCKSTEP_INLINE void hand_on(const SceneData& scene, const RayQueue& rays, const HitArray& hits,
                             ShadeQueue& out, Get get, Put put) {
  const auto put3 = [&](Float3Array& to, const Float3Array& from) LOCKSTEP_LAMBDA {
    put(to.x, get(from.x));
    put(to.y, get(from.y));
    put(to.z, get(from.z));
  };
  put3(out.direction, rays.direction);
  put3(out.throughput, rays.throughput);
  if (needs<F>(scene, Feature::Spheres)) put3(out.origin, rays.origin);
  put(out.barycentric_u, get(hits.u));
  put(out.barycentric_v, get(hits.v));
  put(out.geometry, get(hits.geometry));
  put(out.primitive, get(hits.primitive));
  put(out.path, get(rays.path));
  if (needs<F>(scene, Feature::Spheres)) put(out.distance, get(hits.distance));
  if (needs<F>(scene, Feature::Instances)) put(out.instance, get(hits.instance));
  if (refracts<F>(scene)) put(out.eta_scale, get(rays.eta_scale));
  if (needs<F>(scene, Feature::Absorption)) put(out.medium, get(rays.medium));
}

// Lanes behind the last hit repeat what is used as an index.
inline void repeat_last(ShadeQueue& queue, int count, int width) {
  queue.count = count;
  if (count == 0) return;
  for (int i = count; i < count + width; ++i) {
    queue.geometry[i] = queue.geometry[count - 1];
    queue.primitive[i] = queue.primitive[count - 1];
    queue.material[i] = queue.material[count - 1];
    queue.path[i] = queue.path[count - 1];
    queue.instance[i] = queue.instance[count - 1];
  }
}

// Lists the hits on materials of one kind in the order of their rays.
template <int W, FeatureMask F>
void find_hits(const SceneData& scene, MaterialKind kind, const RayQueue& rays,
               const HitArray& hits, HitOrder& out) {
  using I = Int<W>;
  int n = 0;
  for (int i = 0; i < rays.count; i += W) {
    const Mask<W> hit = lanes_below<W>(i, rays.count) & !(load<I>(hits.geometry + i) < I(0));
    const HitMaterial<I> m = hit_material<W, F>(scene, hits, i, hit);
    const Packing<W> lanes(hit & (m.kind == I(int(kind))));
    lanes.store(out.hit + n, I(i) + lane_indices<W>());
    lanes.store(out.material + n, m.material);
    n += lanes.count();
  }
  out.count = n;
}

// Hits on one material side by side, else in the order of `in`: a counting sort by the number's
// last digits. Materials that share them may alternate, which costs time and nothing else.
inline void order_by_material(const HitOrder& in, HitOrder& out) {
  constexpr std::int32_t buckets = 128;
  std::int32_t first[buckets + 1] = {};
  for (int i = 0; i < in.count; ++i) ++first[in.material[i] % buckets + 1];
  for (int b = 0; b < buckets; ++b) first[b + 1] += first[b];
  for (int i = 0; i < in.count; ++i) {
    const std::int32_t at = first[in.material[i] % buckets]++;
    out.hit[at] = in.hit[i], out.material[at] = in.material[i];
  }
  out.count = in.count;
}

// Queues the hits on materials of one kind, by material: for textures, which a packet looks up one
// at a time.
template <int W, FeatureMask F>
void queue_by_material(const SceneData& scene, MaterialKind kind, const RayQueue& rays,
                       Wave& wave) {
  using I = Int<W>;
  find_hits<W, F>(scene, kind, rays, wave.hits, wave.found);
  order_by_material(wave.found, wave.ordered);
  const int count = wave.ordered.count;
  ShadeQueue& out = wave.hits_to_shade;
  for (int i = count; i < count + W && count > 0; ++i) wave.ordered.hit[i] = wave.ordered.hit[0];
  for (int i = 0; i < count; i += W) {
    const I at = load<I>(wave.ordered.hit + i);
    store(out.material + i, load<I>(wave.ordered.material + i));
    hand_on<W, F>(
        scene, rays, wave.hits, out,
        [&](const auto* from) LOCKSTEP_LAMBDA { return gather(from, at); },
        [&](auto* to, auto values) LOCKSTEP_LAMBDA { store(to + i, values); });
  }
  repeat_last(out, count, W);
}

// Queues the hits on materials of one kind, in the order of their rays.
template <int W, FeatureMask F>
void queue_in_order(const SceneData& scene, MaterialKind kind, const RayQueue& rays, Wave& wave) {
  using V = Float<W>;
  using I = Int<W>;
  const HitArray& hits = wave.hits;
  ShadeQueue& out = wave.hits_to_shade;
  const bool other_kinds =
      (scene.features & F & material_features & ~bit(material_feature(kind))) != 0;
  int n = 0;
  for (int i = 0; i < rays.count; i += W) {
    Mask<W> taken = lanes_below<W>(i, rays.count) & !(load<I>(hits.geometry + i) < I(0));
    if (other_kinds || needs<F>(scene, Feature::Mix)) {
      const HitMaterial<I> m = hit_material<W, F>(scene, hits, i, taken);
      taken = taken & (m.kind == I(int(kind)));
      if (needs<F>(scene, Feature::Mix)) {
        Packing<W>(taken).store(out.material + n, m.material);
      }
    }
    const Packing<W> lanes(taken);
    hand_on<W, F>(
        scene, rays, hits, out,
        [&](const auto* from) LOCKSTEP_LAMBDA {
          if constexpr (std::is_same_v<decltype(from), const float*>)
            return load<V>(from + i);
          else
            return load<I>(from + i);
        },
        [&](auto* to, auto values) LOCKSTEP_LAMBDA { lanes.store(to + n, values); });
    n += lanes.count();
  }
  repeat_last(out, n, W);
}

template <int W, FeatureMask F>
LOCKSTEP_INLINE void queue_hits(const SceneData& scene, MaterialKind kind, const RayQueue& rays,
                                Wave& wave) {
  if (needs_any<F>(scene, feature_set(Feature::Textures, Feature::SurfaceMaps))) {
    queue_by_material<W, F>(scene, kind, rays, wave);
  } else {
    queue_in_order<W, F>(scene, kind, rays, wave);
  }
}

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
