// Normal and bump maps: the shading normal that a material wants.
#pragma once

#include "core/frame.h"
#include "core/texture_coordinates.h"
#include "packets/textured.h"

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

// Tangent-space normals as glTF has them: x along u, y against v, z along the normal.
template <class V>
LOCKSTEP_INLINE Vec3<V> mapped_normal(const TextureTable& textures, const TextureBinding& map,
                                      const TextureCoordinates<V>& at,
                                      const UvFootprint<V>& footprint, const Vec3<V>& normal) {
  const Rgba<V> texel = lookup(textures, map.texture, at.uv, footprint);
  const V x = fma(V(2.0f), texel.r, V(-1.0f)) * V(map.scale.x);
  const V y = fma(V(2.0f), texel.g, V(-1.0f)) * V(map.scale.x);
  const V z = fma(V(2.0f), texel.b, V(-1.0f));
  const Frame<V> frame = frame_along(normal, at.du);
  const V up = copysign(V(1.0f), -dot(frame.y, at.dv));
  return normalize(fma(x, frame.x, fma(y * up, frame.y, normal * max(z, V(1e-3f)))));
}

// The normal of the surface displaced by the map's height along it, by forward differences over
// half a texel of a map of a thousand (Blinn 1978; the step is pbrt's).
template <class V>
LOCKSTEP_INLINE Vec3<V> bumped_normal(const TextureTable& textures, const TextureBinding& map,
                                      const TextureCoordinates<V>& at,
                                      const UvFootprint<V>& footprint, const Vec3<V>& normal) {
  constexpr float step = 0.0005f;
  const auto height = [&](float du, float dv) LOCKSTEP_LAMBDA {
    const TexturePoint<V> there{{at.uv.x + V(du), at.uv.y + V(dv)}, footprint};
    return bound_value(textures, map, there).x;
  };
  const V here = height(0.0f, 0.0f);
  const V slope_u = (height(step, 0.0f) - here) * V(1.0f / step);
  const V slope_v = (height(0.0f, step) - here) * V(1.0f / step);
  const Vec3<V> du = fma(slope_u, normal, at.du), dv = fma(slope_v, normal, at.dv);
  const Vec3<V> flat = cross(at.du, at.dv), tilted = cross(du, dv);
  const V length2 = dot(tilted, tilted);
  const MaskOf<V> usable = (length2 > V(0.0f)) & is_finite(length2);
  const V sign = copysign(V(1.0f), dot(flat, normal));
  const V scale = sign * rsqrt(select(usable, length2, V(1.0f)));
  return select<V>(usable, tilted * scale, normal);
}

// Whose maps apply: those of the part of a mix that was chosen, or where it has none the mix's.
template <class I>
LOCKSTEP_INLINE I material_with_maps(const SceneData& scene, I part, I whole) {
  const std::int32_t* maps = scene.materials.maps;
  const I row = part * I(map_stride);
  const auto none = (gather(maps + 2, row) < I(0)) & (gather(maps + 3, row) < I(0));
  return select(none, whole, part);
}

// `normal` (unit, on the outside) as the maps of the lanes' materials turn it.
template <int W>
[[gnu::noinline]] Vec3<Float<W>> apply_surface_maps(const SceneData& scene, const Int<W>& material,
                                                    const Mask<W>& active,
                                                    const TextureCoordinates<Float<W>>& at,
                                                    const UvFootprint<Float<W>>& footprint,
                                                    Vec3<Float<W>> normal) {
  using V = Float<W>;
  for_each_distinct(material, active, [&](std::int32_t m, Mask<W> lanes) {
    const std::int32_t* map = scene.materials.maps + m * map_stride;
    if (map[2] >= 0) {
      const TextureBinding& b = scene.materials.bindings[map[2]];
      normal = select<V>(lanes, mapped_normal(scene.textures, b, at, footprint, normal), normal);
    }
    if (map[3] >= 0) {
      const TextureBinding& b = scene.materials.bindings[map[3]];
      normal = select<V>(lanes, bumped_normal(scene.textures, b, at, footprint, normal), normal);
    }
  });
  return normal;
}

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
