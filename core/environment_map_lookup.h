// Radiance of an environment map, and directions drawn in proportion to it, in packets.
//
// Cells are found by inverting cumulative distributions: neighbouring samples stay neighbours,
// which keeps packets together and stratification intact; an alias table would scatter both.
#pragma once

#include "core/sphere_mapping.h"
#include "core/texel.h"
#include "core/warp.h"

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

template <class V>
struct MapLight {
  Vec3<V> radiance;
  V pdf;  // with which sample_environment_map gives the direction, per solid angle
};

template <class V>
struct MapSample {
  Vec3<V> wi;  // unit, towards the environment
  Vec3<V> radiance;
  V pdf;  // 0: nothing arrives from there
};

// Where a direction of the world lies on the map's square.
template <class V>
LOCKSTEP_INLINE Vec2<V> map_square(const EnvironmentMapData& map, const Vec3<V>& wi) {
  const glm::mat3& m = map.to_world;
  const Vec3<V> local(dot(splat<V>(m[0]), wi), dot(splat<V>(m[1]), wi), dot(splat<V>(m[2]), wi));
  return square_of_direction(map.mapping, local);
}

// Bilinear between texels, across the square's edges.
template <class V>
LOCKSTEP_INLINE Vec3<V> radiance_at(const EnvironmentMapData& map, const Vec2<V>& square) {
  using I = IntOf<V>;
  const TexelData& t = map.texels;
  const I width(t.width), height(t.height), words(words_per_texel(t.format));
  const AxisTaps<V> columns = linear_taps(square.x * to_float(width));
  const AxisTaps<V> rows = linear_taps(square.y * to_float(height));
  Rgba<V> sum{V(0.0f), V(0.0f), V(0.0f), V(0.0f)};
  for (int j = 0; j < 2; ++j) {
    for (int i = 0; i < 2; ++i) {
      I x = columns.at[i], y = rows.at[j];
      cross_edge(map.mapping, width, height, x, y);
      const I word = (y * width + x) * words;
      sum = fma(columns.weight[i] * rows.weight[j], load_texel(t, word), sum);
    }
  }
  return {sum.r * V(map.scale.x), sum.g * V(map.scale.y), sum.b * V(map.scale.z)};
}

// Index in [0, count) of the cell that a coordinate in [0, 1] lies in.
template <class V>
LOCKSTEP_INLINE IntOf<V> cell_of(V coordinate, std::int32_t count) {
  return to_int(clamp(coordinate * V(float(count)), V(0.0f), V(float(count - 1))));
}

template <class V>
LOCKSTEP_INLINE V pdf_at(const EnvironmentMapData& map, const Vec2<V>& square) {
  using I = IntOf<V>;
  const I row = cell_of(square.y, map.rows), column = cell_of(square.x, map.columns);
  const I at = row * I(map.columns + 1) + column;
  const V share = gather(map.column_cdf.values, at + I(1)) - gather(map.column_cdf.values, at);
  return share * gather(map.row_density, row);
}

template <class V>
LOCKSTEP_INLINE Vec3<V> environment_map_radiance(const EnvironmentMapData& map, const Vec3<V>& wi) {
  return radiance_at(map, map_square(map, wi));
}

template <class V>
LOCKSTEP_INLINE V environment_map_pdf(const EnvironmentMapData& map, const Vec3<V>& wi) {
  return pdf_at(map, map_square(map, wi));
}

template <class V>
LOCKSTEP_INLINE MapLight<V> evaluate_environment_map(const EnvironmentMapData& map,
                                                     const Vec3<V>& wi) {
  const Vec2<V> square = map_square(map, wi);
  return {radiance_at(map, square), pdf_at(map, square)};
}

template <class V>
struct CellChoice {
  IntOf<V> cell;
  V within;  // where in the cell, [0, 1)
};

// The cell that holds u in [0, 1) in the lanes' cumulative distributions. Guides leave a few cells
// to search; with them this takes half the time of a search among all.
template <class V>
LOCKSTEP_INLINE CellChoice<V> choose_cell(const CdfTable& t, IntOf<V> which, V u) {
  using I = IntOf<V>;
  const I guide = which * I(t.guide_count + 1) + cell_of(u, t.guide_count);
  const I first = which * I(t.count + 1);
  I low = gather(t.guides, guide), high = gather(t.guides, guide + I(1));
  while (any(low < high)) {
    const I middle = (low + high + I(1)) >> 1;
    const MaskOf<V> above = gather(t.values, first + middle) <= u;
    // A lane that is done has low = middle = high.
    low = select(above & (low < high), middle, low);
    high = select(above | (low >= high), high, middle - I(1));
  }
  const I at = first + low;
  const V below = gather(t.values, at), share = gather(t.values, at + I(1)) - below;
  // Samples are multiples of 2^-24: half a step more lies in the middle of what each stands for.
  const V within = (u - below + V(0x1p-25f)) / share;
  return {low, clamp(within, V(0.0f), V(0x1.fffffep-1f))};
}

template <class V>
LOCKSTEP_INLINE Vec3<V> local_direction(const EnvironmentMapData& map, const CellChoice<V>& column,
                                        const CellChoice<V>& row) {
  using I = IntOf<V>;
  const V u = (to_float(column.cell) + column.within) * V(1.0f / float(map.columns));
  if (map.mapping == SphereMapping::EqualAreaOctahedral) {
    const V v = (to_float(row.cell) + row.within) * V(1.0f / float(map.rows));
    return octahedral_direction(Vec2<V>(u, v));
  }
  const auto edges = gather_rows(map.latitudes, row.cell * I(2));
  const V sin2 = fma(row.within, edges.z - edges.x, edges.x);
  const V cos2 = fma(row.within, edges.w - edges.y, edges.y);
  return direction_of_latitude(u, sin2, cos2);
}

// Draws a direction; u lies in [0, 1)^2. Radiance and density are those of evaluate at that very
// direction: to the last bit what a ray that goes there by other means gets.
template <class V>
LOCKSTEP_INLINE MapSample<V> sample_environment_map(const EnvironmentMapData& map,
                                                    const Vec2<V>& u) {
  const CellChoice<V> row = choose_cell(map.row_cdf, IntOf<V>(0), u.y);
  const CellChoice<V> column = choose_cell(map.column_cdf, row.cell, u.x);
  const Vec3<V> local = local_direction(map, column, row);
  const glm::mat3& m = map.to_world;
  const Vec3<V> wi =
      fma(local.x, splat<V>(m[0]), fma(local.y, splat<V>(m[1]), splat<V>(m[2]) * local.z));
  const MapLight<V> light = evaluate_environment_map(map, wi);
  return {wi, light.radiance, light.pdf};
}

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
