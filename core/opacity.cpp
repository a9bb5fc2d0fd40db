#include "core/opacity.h"

#include "core/hash.h"
#include "core/texture.h"
#include "core/texture_coordinates.h"

namespace lockstep {
namespace {

Vec2<float> hit_uv(const Holes& holes, std::uint32_t primitive, RTCHitN* hit, unsigned n,
                   unsigned i) {
  const FlatScene& flat = *holes.flat;
  const std::int32_t* row = flat.geometry_rows.data() + holes.geometry * geometry_stride;
  if (row[3] & geometry_is_sphere) {
    const Vec3<float> normal(RTCHitN_Ng_x(hit, n, i), RTCHitN_Ng_y(hit, n, i),
                             RTCHitN_Ng_z(hit, n, i));
    return sphere_coordinates(normalize_any(normal), 1.0f).uv;
  }
  const std::int32_t* t = flat.triangles.data() + (std::size_t(row[0]) + primitive) * 3;
  const bool has_uvs = (row[3] & geometry_has_uvs) != 0;
  const auto corners =
      load_uv_corners(flat.uvs.data(), Vec3<std::int32_t>(t[0], t[1], t[2]), has_uvs);
  return corners.at(RTCHitN_u(hit, n, i), RTCHitN_v(hit, n, i));
}

float opacity_at(const Holes& holes, const Opacity& opacity, std::uint32_t primitive, RTCHitN* hit,
                 unsigned n, unsigned i) {
  const TextureBinding& b = opacity.binding;
  if (b.texture < 0) return opacity.value;
  const Rgba<float> texel = lookup(*holes.textures, b.texture, hit_uv(holes, primitive, hit, n, i));
  return b.scale.x * number_of(texel, b.channel, b.power);
}

// A number in [0, 1) that depends on the ray and on what it hits alone, so that every traversal
// mode sees the same holes.
float number_of_hit(RTCRayN* ray, std::uint32_t geometry, std::uint32_t primitive, unsigned n,
                    unsigned i) {
  const auto origin = pcg3d(as_uint(RTCRayN_org_x(ray, n, i)), as_uint(RTCRayN_org_y(ray, n, i)),
                            as_uint(RTCRayN_org_z(ray, n, i)));
  const auto all = pcg4d(as_uint(RTCRayN_dir_x(ray, n, i)) ^ origin.x,
                         as_uint(RTCRayN_dir_y(ray, n, i)) ^ origin.y,
                         as_uint(RTCRayN_dir_z(ray, n, i)) ^ geometry, primitive);
  return unit_float(all.x);
}

// Embree's callback: takes the lanes that fall through a hole out of `valid`.
void drop_hits_in_holes(const RTCFilterFunctionNArguments* args) {
  const Holes& holes = *static_cast<const Holes*>(args->geometryUserPtr);
  const FlatScene& flat = *holes.flat;
  const std::int32_t material = flat.geometry_rows[holes.geometry * geometry_stride + 1];
  const Opacity& opacity = flat.opacities[std::size_t(material)];
  for (unsigned i = 0; i < args->N; ++i) {
    if (args->valid[i] != -1) continue;
    const std::uint32_t primitive = RTCHitN_primID(args->hit, args->N, i);
    const float share = opacity_at(holes, opacity, primitive, args->hit, args->N, i);
    const float least = opacity.cutoff > 0.0f
                            ? opacity.cutoff
                            : number_of_hit(args->ray, holes.geometry, primitive, args->N, i);
    const bool there = opacity.cutoff > 0.0f ? share >= least : share > least;
    if (!there) args->valid[i] = 0;
  }
}

}  // namespace

void set_holes(RTCGeometry geometry, Holes& holes) {
  rtcSetGeometryUserData(geometry, &holes);
  rtcSetGeometryIntersectFilterFunction(geometry, drop_hits_in_holes);
  rtcSetGeometryOccludedFilterFunction(geometry, drop_hits_in_holes);
}

}  // namespace lockstep
