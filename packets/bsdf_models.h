// The reflection model of each kind of material, ready for a packet of hits.
#pragma once

#include "core/bsdf.h"
#include "core/bsdf/dielectric.h"
#include "core/bsdf/diffuse_transmission.h"
#include "core/bsdf/measured.h"
#include "core/bsdf/metal.h"
#include "core/bsdf/oren_nayar.h"
#include "core/bsdf/principled.h"
#include "core/ggx_albedo.h"
#include "packets/surface.h"
#include "packets/textured.h"

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

template <MaterialKind K, class I>
LOCKSTEP_INLINE auto load_bsdf(const MaterialTable& table, I material) {
  if constexpr (K == MaterialKind::Diffuse) return load_diffuse(table, material);
  if constexpr (K == MaterialKind::Conductor) return load_metal(table, material);
  if constexpr (K == MaterialKind::Coated) return load_coated(table, material);
  if constexpr (K == MaterialKind::RoughDiffuse) return load_oren_nayar(table, material);
  if constexpr (K == MaterialKind::DiffuseTransmission) {
    return load_diffuse_transmission(table, material);
  }
  if constexpr (K == MaterialKind::Dielectric) return load_dielectric(table, material);
  if constexpr (K == MaterialKind::Principled) return load_principled(table, material);
  if constexpr (K == MaterialKind::Measured) return load_measured(table, material);
}

// Models that choose between lobes by a sample of their own.
constexpr bool has_lobes(MaterialKind kind) {
  return kind == MaterialKind::Coated || kind == MaterialKind::DiffuseTransmission ||
         kind == MaterialKind::Dielectric || kind == MaterialKind::Principled ||
         kind == MaterialKind::Measured;
}

// What single scattering loses, where it is to be put back.
template <class V, class Bsdf>
LOCKSTEP_INLINE void compensate(const SceneData&, const Vec3<V>&, Bsdf&) {}
template <class V>
LOCKSTEP_INLINE void compensate(const SceneData& scene, const Vec3<V>& wo, MetalBsdf<V>& bsdf) {
  const float* table = scene.materials.ggx_albedo;
  if (table) bsdf.lost = ggx_loss(table, wo.z, bsdf.conductor.ggx.alpha);
}
template <class V>
LOCKSTEP_INLINE void compensate(const SceneData& scene, const Vec3<V>& wo,
                                PrincipledBsdf<V>& bsdf) {
  const float* table = scene.materials.ggx_albedo;
  if (table) bsdf.lost = ggx_loss(table, wo.z, Vec2<V>(bsdf.alpha));
}

// True where no light can be sampled: all lanes are mirrors or clear glass.
template <class Bsdf>
LOCKSTEP_INLINE bool all_delta(const Bsdf&) {
  return false;
}
template <class V>
LOCKSTEP_INLINE bool all_delta(const MetalBsdf<V>& bsdf) {
  return all(is_smooth(bsdf.conductor.ggx));
}
template <class V>
LOCKSTEP_INLINE bool all_delta(const DielectricBsdf<V>& bsdf) {
  return all(is_delta(bsdf));
}

// The models of the hits at i..., all of kind K.
template <int W, MaterialKind K, FeatureMask F>
LOCKSTEP_INLINE auto load_bsdf_at(const SceneData& scene, const Surface<Float<W>>& surface,
                                  const Int<W>& material, const Mask<W>& active) {
  MaterialRows<W> rows;
  MaterialTable table = scene.materials;
  Int<W> row = material;
  if (needs<F>(scene, Feature::Textures)) {
    load_textured_rows<W>(scene, material, active, surface.texture, rows);
    table.parameters = rows.parameters;
    row = lane_indices<W>();
  }
  auto bsdf = load_bsdf<K>(table, row);
  compensate(scene, surface.wo, bsdf);
  return bsdf;
}

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
