// The part of a texture that a lookup stands for: the footprint of a pixel at the hit.
//
// No ray differentials are carried along. As pbrt-v4 does behind all but mirrors (Pharr, Jakob and
// Humphreys 2023, section 10.1.1; Li 2018), the footprint follows from where the hit lies as seen
// from the camera, whatever way led there. It is a disk as wide as the angle between pixels spans
// at the hit's distance (a pixel's side if the camera is orthographic), times `footprint_scale`,
// divided by the cosine under which the camera would see the surface: the longer axis of pbrt's
// ellipse. That makes it at most a pixel wide.
//
// pbrt scales by max(1/8, 1 / sqrt(samples per pixel)). Here it is always 1/8, its limit from 64
// samples on, as otherwise the image that samples converge to would depend on their number.
#pragma once

#include "core/scene_data.h"
#include "core/simd_exp.h"
#include "core/vec.h"

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

inline constexpr float least_footprint_cosine = footprint_scale;

// How far texture coordinates change across the footprint, at most: a u + b v by the root of
// a^2 uu + 2 a b uv + b^2 vv. All 0: a point.
template <class V>
struct UvFootprint {
  V uu{0.0f}, uv{0.0f}, vv{0.0f};
};

// Where a texture is looked up, and over what.
template <class V>
struct TexturePoint {
  Vec2<V> uv;
  UvFootprint<V> footprint;
};

// The footprint's squared width in the scene's unit, at a position on a surface of that unit
// normal.
template <FeatureMask F, class V>
LOCKSTEP_INLINE V footprint_width2(const SceneData& scene, const Vec3<V>& position,
                                   const Vec3<V>& normal) {
  const CameraData& camera = scene.camera;
  const Vec3<V> origin = splat<V>(camera.origin);
  const Vec3<V> view = needs<F>(scene, Feature::Orthographic) ? origin : position - origin;
  const V distance2 = dot(view, view), along = dot(view, normal);
  constexpr float largest = 1.0f / (least_footprint_cosine * least_footprint_cosine);
  const V inverse_cosine2 = min(distance2 / (along * along), V(largest));
  return V(camera.footprint * camera.footprint) * distance2 * inverse_cosine2;
}

// The footprint on the texture, by the inverse of the surface's first fundamental form. A point
// where the coordinates do not span the surface.
template <class V>
LOCKSTEP_INLINE UvFootprint<V> uv_footprint(const Vec3<V>& du, const Vec3<V>& dv, V width2) {
  const V scale = V(1.0f) / width2;
  const V e = dot(du, du) * scale, f = dot(du, dv) * scale, g = dot(dv, dv) * scale;
  const V both = e * g, determinant = fma(f, -f, both);
  const MaskOf<V> spans = determinant > V(1e-6f) * both;
  const V inverse = select(spans, V(1.0f) / select(spans, determinant, V(1.0f)), V(0.0f));
  return {g * inverse, -(f * inverse), e * inverse};
}

// The level of an image's pyramid whose texels are as wide as the footprint, along the side of the
// image where it covers more of them; 0 where it is smaller than a texel, or no number.
template <class V>
LOCKSTEP_INLINE V level_of_detail(const TexelData& image, const UvTransform& t,
                                  const UvFootprint<V>& footprint) {
  const auto texels2 = [&](glm::vec2 row, std::int32_t size) LOCKSTEP_LAMBDA {
    const float a = row.x * float(size), b = row.y * float(size);
    return fma(V(a * a), footprint.uu, fma(V(2.0f * a * b), footprint.uv, V(b * b) * footprint.vv));
  };
  const V larger2 = max(texels2(t.u_row, image.width), texels2(t.v_row, image.height));
  return V(0.5f) * log2(clamp(larger2, V(1.0f), V(0x1p100f)));
}

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
