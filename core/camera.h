// Camera rays: perspective through a pinhole or a thin lens, or orthographic, with the pixel filter
// sampled so that every sample counts alike in its own pixel, but for its sign (Ernst, Stamminger
// and Greiner 2006, "Filter Importance Sampling").
#pragma once

#include "core/scene_data.h"
#include "core/vec.h"
#include "core/warp.h"

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

// What a sample there counts, for u in [0, 1).
template <class V>
LOCKSTEP_INLINE V filter_weight(const CameraData& camera, const Vec2<V>& u) {
  const V cells(float{filter_cells});
  return gather(camera.filter_weight_x, to_int(u.x * cells)) *
         gather(camera.filter_weight_y, to_int(u.y * cells));
}

// The point of the filter around the pixel of that column and row that u picks, in pixels from the
// image's corner.
template <class V, FeatureMask F = all_features>
LOCKSTEP_INLINE Vec2<V> image_point(const CameraData& camera, V column, V row, Vec2<V> u) {
  if ((F & bit(Feature::FilterTable)) && camera.filter_x) {
    return {column + V(0.5f) + filter_offset(camera.filter_x, u.x),
            row + V(0.5f) + filter_offset(camera.filter_y, u.y)};
  }
  return {column + u.x, row + u.y};
}

// The point on the image plane, from the world's origin if orthographic, else from the camera's.
template <class V>
LOCKSTEP_INLINE Vec3<V> plane_point(const CameraData& camera, const Vec2<V>& p) {
  return fma(p.x, splat<V>(camera.right), fma(p.y, splat<V>(camera.down), splat<V>(camera.corner)));
}

template <class V>
struct CameraRay {
  Vec3<V> origin, direction;  // unit direction
};

// The ray through that point of the image.
template <class V>
LOCKSTEP_INLINE CameraRay<V> pinhole_ray(const CameraData& camera, const Vec2<V>& p) {
  return {splat<V>(camera.origin), normalize(plane_point(camera, p))};
}

template <class V>
LOCKSTEP_INLINE CameraRay<V> orthographic_ray(const CameraData& camera, const Vec2<V>& p) {
  return {plane_point(camera, p), splat<V>(camera.origin)};
}

// From the point of the lens that u picks to where the pinhole's ray meets the plane in focus.
template <class V>
LOCKSTEP_INLINE CameraRay<V> lens_ray(const CameraData& camera, const Vec2<V>& p, Vec2<V> u) {
  const Vec2<V> lens = concentric_disk(u);
  const Vec3<V> offset = fma(lens.x, splat<V>(camera.lens_x), splat<V>(camera.lens_y) * lens.y);
  const Vec3<V> focus = plane_point(camera, p) * V(camera.focal_distance);
  return {splat<V>(camera.origin) + offset, normalize(focus - offset)};
}

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
