// Camera rays: pinhole perspective, with the pixel filter sampled so that every sample counts
// alike in its own pixel (Ernst, Stamminger and Greiner 2006, "Filter Importance Sampling").
#pragma once

#include "core/scene_data.h"
#include "core/vec.h"

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

// Offset from the pixel's centre, in pixels, for u in [0, 1).
template <class V>
LOCKSTEP_INLINE V filter_offset(const float* table, V u) {
  const V x = u * V(float(filter_cells));
  const V cell = floor(x);
  const IntOf<V> i = to_int(cell);
  const V a = gather(table, i), b = gather(table + 1, i);
  return fma(x - cell, b - a, a);
}

// Unit direction through the pixel whose column and row are given; u picks the point in the filter.
template <class V, FeatureMask F = all_features>
LOCKSTEP_INLINE Vec3<V> camera_direction(const CameraData& camera, V column, V row, Vec2<V> u) {
  V x = column + u.x, y = row + u.y;
  if ((F & bit(Feature::FilterTable)) && camera.filter_x) {
    x = column + V(0.5f) + filter_offset(camera.filter_x, u.x);
    y = row + V(0.5f) + filter_offset(camera.filter_y, u.y);
  }
  return normalize(
      fma(x, splat<V>(camera.right), fma(y, splat<V>(camera.down), splat<V>(camera.corner))));
}

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
