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

// Number of the lanes' boundary tables.
template <class I>
LOCKSTEP_INLINE I boundary_table(const MaterialTable& table, I rows) {
  return to_int(gather(table.parameters + boundary_column, rows * I(material_stride)));
}

// What single scattering between facets loses is put back. `rows` are the lanes' in `table`.
template <class V, class Bsdf>
LOCKSTEP_INLINE void compensate(const MaterialTable&, IntOf<V>, const Surface<V>&, Bsdf&) {}
template <class V>
LOCKSTEP_INLINE void compensate(const MaterialTable& table, IntOf<V>, const Surface<V>& surface,
                                MetalBsdf<V>& bsdf) {
  bsdf.lost = ggx_loss(table.ggx_albedo, surface.wo.z, bsdf.conductor.ggx.alpha);
}
template <class V>
LOCKSTEP_INLINE void compensate(const MaterialTable& table, IntOf<V> rows,
                                const Surface<V>& surface, CoatedBsdf<V>& bsdf) {
  const V alpha = bsdf.ggx.alpha.x;
  bsdf.boundary_albedo = table.boundary_albedo;
  bsdf.table = boundary_table(table, rows);
  bsdf.lost =
      boundary_loss(table.boundary_albedo, bsdf.table, MaskOf<V>(false), surface.wo.z, alpha);
  bsdf.inner_reflectance =
      bsdf.inner_reflectance + boundary_inner_difference(table.boundary_albedo, bsdf.table, alpha);
}
// Facets of a sheet mirror what passes: they lose as metal does.
template <class V>
LOCKSTEP_INLINE V transparent_loss(const MaterialTable& table, IntOf<V> rows,
                                   const Surface<V>& surface, Vec2<V> alpha, MaskOf<V> thin) {
  const V cos_o = surface.wo.z;
  V lost(0.0f);
  if (any(thin)) lost = ggx_loss(table.ggx_albedo, cos_o, alpha);
  if (all(thin) || !table.boundary_albedo) return lost;
  return select(thin, lost,
                boundary_loss(table.boundary_albedo, boundary_table(table, rows), !surface.outside,
                              cos_o, sqrt(alpha.x * alpha.y)));
}
template <class V>
LOCKSTEP_INLINE void compensate(const MaterialTable& table, IntOf<V> rows,
                                const Surface<V>& surface, DielectricBsdf<V>& bsdf) {
  bsdf.lost = select(is_delta(bsdf), V(0.0f),
                     transparent_loss(table, rows, surface, bsdf.ggx.alpha, bsdf.thin));
}
template <class V>
LOCKSTEP_INLINE void compensate(const MaterialTable& table, IntOf<V> rows,
                                const Surface<V>& surface, PrincipledBsdf<V>& bsdf) {
  const Vec2<V> alpha(bsdf.alpha);
  bsdf.lost = ggx_loss(table.ggx_albedo, surface.wo.z, alpha);
  if (none(bsdf.transmission > V(0.0f))) return;
  bsdf.lost_by_clear = transparent_loss(table, rows, surface, alpha, bsdf.thin);
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
  if (needs<F>(scene, Feature::Compensation)) compensate(table, row, surface, bsdf);
  return bsdf;
}

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
