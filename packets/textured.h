// Materials whose parameters come from textures, looked up in packets: all lanes on one material at
// once, as hits on textured materials are shaded in their order.
#pragma once

#include "core/texture.h"
#include "packets/distinct.h"
#include "packets/wave.h"

#include <cstring>

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

// The value of an input there, in as many components as the binding has columns.
template <class V>
LOCKSTEP_INLINE Vec3<V> bound_value(const TextureTable& textures, const TextureBinding& b,
                                    const TexturePoint<V>& at) {
  const Rgba<V> texel = lookup(textures, b.texture, at.uv, at.footprint);
  const Vec3<V> scale = splat<V>(b.scale);
  if (b.is_color) return scale * Vec3<V>(texel.r, texel.g, texel.b);
  return scale * Vec3<V>(number_of(texel, b.channel, b.power));
}

// What the textures of the lanes' bindings say of light there; its radiance already holds their
// scale.
template <class V>
LOCKSTEP_INLINE Vec3<V> glow_color(const SceneData& scene, const IntOf<V>& binding,
                                   const MaskOf<V>& lanes, const TexturePoint<V>& at) {
  Vec3<V> color(V(1.0f));
  for_each_distinct(binding, lanes, [&](std::int32_t index, MaskOf<V> same) {
    TextureBinding b = scene.materials.bindings[index];
    b.scale = glm::vec3(1.0f);
    color = select<V>(same, bound_value(scene.textures, b, at), color);
  });
  return color;
}

// Rows of parameters of a packet's own, one per lane, in the layout of MaterialTable::parameters.
template <int W>
struct MaterialRows {
  alignas(64) float parameters[W * material_stride];
};

// Fills the rows of the lanes' materials, with the textures' values there.
template <int W>
[[gnu::noinline]] void load_textured_rows(const SceneData& scene, const Int<W>& material,
                                          const Mask<W>& active, const TexturePoint<Float<W>>& at,
                                          MaterialRows<W>& rows) {
  using V = Float<W>;
  const MaterialTable& table = scene.materials;
  std::int32_t index[W];
  store(index, material);
  for (int lane = 0; lane < W; ++lane) {
    std::memcpy(rows.parameters + lane * material_stride,
                table.parameters + index[lane] * material_stride, material_stride * sizeof(float));
  }
  for_each_distinct(material, active, [&](std::int32_t m, Mask<W> lanes) {
    const std::int32_t* map = table.maps + m * map_stride;
    for (int i = 0; i < map[1]; ++i) {
      const TextureBinding& b = table.bindings[map[0] + i];
      const Vec3<V> value = bound_value(scene.textures, b, at);
      const V components[] = {value.x, value.y, value.z};
      for (int k = 0; k < b.columns; ++k) {
        float component[W];
        store(component, components[k]);
        for (std::uint32_t left = bits(lanes); left != 0; left &= left - 1) {
          const int lane = std::countr_zero(left);
          rows.parameters[lane * material_stride + b.column + k] = component[lane];
        }
      }
    }
  });
}

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
