// A light as kernels load it, and the choice among lights. Conventions are those of light.h.
#pragma once

#include "core/hash.h"
#include "core/scene_data.h"
#include "core/vec.h"

#include <bit>

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

template <class V>
struct LightSample {
  Vec3<V> wi;
  V distance;  // infinite for the environment
  Vec3<V> radiance;
  V pdf;  // 0: nothing arrives from there; the light's probability where it is a single direction
  MaskOf<V> delta = MaskOf<V>(false);  // a single direction, which no other technique finds: only
                                       // set where the scene has such lights
  Vec2<V> place{V(0.0f)};  // on a flat light, as shares of its edges: only set where the scene has
                           // textured lights
};

template <class V>
struct LightRow {
  Vec3<V> corner, edge1, edge2, normal, radiance;
  V area, probability, side, outline;
  V kind;  // a LightKind as a number

  LOCKSTEP_INLINE MaskOf<V> is(LightKind k) const { return kind == V(float(int(k))); }
};

// Triangles whose radiance is still to be multiplied by a texture.
template <class V>
LOCKSTEP_INLINE MaskOf<V> is_textured(const LightRow<V>& light) {
  return light.is(LightKind::Triangle) & (light.outline > V(0.0f));
}

template <class I>
LOCKSTEP_INLINE LightRow<FloatOf<I>> load_light(const LightTable& t, I index) {
  const auto row = [&](int column) LOCKSTEP_LAMBDA {
    return gather_rows(t.rows + column, index * I(light_stride));
  };
  const auto a = row(0), b = row(4), c = row(8), d = row(12), e = row(16);
  return {{a.x, a.y, a.z},
          {b.x, b.y, b.z},
          {c.x, c.y, c.z},
          {d.x, d.y, d.z},
          {e.x, e.y, e.z},
          a.w,
          b.w,
          c.w,
          e.w,
          d.w};
}

template <class V>
struct LightChoice {
  IntOf<V> index;
  Vec2<V> u;  // for a point on the light: independent of the choice
};

// The light whose interval of the cumulative distribution holds u.x; what is left of u.x within the
// interval goes on as a number in [0, 1), so that one point stratifies both the choice and the
// place on the light. u.x has 24 digits: those that the interval has used up come from the last 12
// of u.y, which u.y keeps.
template <class V>
LOCKSTEP_INLINE LightChoice<V> choose_light(const LightTable& t, Vec2<V> u) {
  using I = IntOf<V>;
  I first(0);
  V below(0.0f);
  for (int step = int(std::bit_floor(unsigned(t.count))); step > 0; step /= 2) {
    const I next = first + I(step);
    const I probe = select(next < I(t.count), next, I(t.count));
    const V start = gather(t.cdf, probe);
    const MaskOf<V> beyond = (start <= u.x) & (next < I(t.count));
    first = select(beyond, next, first);
    below = select(beyond, start, below);
  }
  const V digits = u.y * V(0x1p12f);
  const V rest = fma(digits - floor(digits), V(0x1p-24f), u.x - below);
  const V x = rest / (gather(t.cdf, first + I(1)) - below);
  return {first, {min(x, V(one_minus_epsilon)), u.y}};
}

// Density of a point on a flat light seen at `distance` under `cos_light`.
template <class V>
LOCKSTEP_INLINE V solid_angle_pdf(V distance, V cos_light, V area) {
  return distance * distance / (cos_light * area);
}

// True where light leaves the side that `cos_light` = normal . (light to lit point) looks at.
template <class V>
LOCKSTEP_INLINE MaskOf<V> emits(V side, V cos_light) {
  return (side == V(0.0f)) | (side * cos_light > V(0.0f));
}

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
