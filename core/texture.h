// Looking up textures in packets. All lanes use the same texture: every branch here is uniform.
// Texture coordinates are those of the mesh; lanes that hold no number get some texel of the image.
#pragma once

#include "core/texel.h"
#include "core/texture_footprint.h"
#include "core/vec.h"

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

template <class V>
LOCKSTEP_INLINE Vec2<V> transform(const UvTransform& t, const Vec2<V>& uv) {
  return {fma(V(t.u_row.x), uv.x, fma(V(t.u_row.y), uv.y, V(t.offset.x))),
          fma(V(t.v_row.x), uv.x, fma(V(t.v_row.y), uv.y, V(t.offset.y)))};
}

// A coordinate brought into [0, 1] by the wrap mode, or into [-1, 2] where the border is black.
// clamp() gives its lower bound for what is not a number.
template <class V>
LOCKSTEP_INLINE V wrap_coordinate(TextureWrap wrap, V t) {
  switch (wrap) {
    case TextureWrap::Repeat:
      return clamp(t - floor(t), V(0.0f), V(1.0f));
    case TextureWrap::Mirror: {
      const V half = t * V(0.5f);
      const V folded = (half - floor(half)) * V(2.0f);
      return clamp(min(folded, V(2.0f) - folded), V(0.0f), V(1.0f));
    }
    case TextureWrap::Clamp:
      return clamp(t, V(0.0f), V(1.0f));
    case TextureWrap::Black:
      break;
  }
  return clamp(t, V(-1.0f), V(2.0f));
}

// A position beyond the border, after wrap_coordinate: at most one texel but for black borders,
// where the weight turns 0.
template <class V>
LOCKSTEP_INLINE void wrap_tap(TextureWrap wrap, IntOf<V> size, IntOf<V>& at, V& weight) {
  using I = IntOf<V>;
  const MaskOf<V> below = at < I(0), above = at >= size;
  if (wrap == TextureWrap::Repeat) {
    at = select(below, at + size, select(above, at - size, at));
    return;
  }
  at = select(below, I(0), select(above, size - I(1), at));
  if (wrap == TextureWrap::Black) weight = select(below | above, V(0.0f), weight);
}

template <class V>
LOCKSTEP_INLINE AxisTaps<V> axis_taps(TextureWrap wrap, bool nearest, V t, IntOf<V> size) {
  const V s = wrap_coordinate(wrap, t) * to_float(size);
  AxisTaps<V> taps =
      nearest ? AxisTaps<V>{{to_int(floor(s)), IntOf<V>(0)}, {V(1.0f), V(0.0f)}} : linear_taps(s);
  wrap_tap(wrap, size, taps.at[0], taps.weight[0]);
  wrap_tap(wrap, size, taps.at[1], taps.weight[1]);
  return taps;
}

template <class V>
struct LevelExtent {
  IntOf<V> width, height, first_word;
};

template <class V>
LOCKSTEP_INLINE Rgba<V> filtered_texel(const ImageLookup& image, const LevelExtent<V>& level,
                                       const Vec2<V>& uv) {
  using I = IntOf<V>;
  const bool nearest = image.filter == TextureFilter::Nearest;
  const AxisTaps<V> x = axis_taps(image.wrap_u, nearest, uv.x, level.width);
  const AxisTaps<V> y = axis_taps(image.wrap_v, nearest, uv.y, level.height);
  const I words(words_per_texel(image.texels.format));
  Rgba<V> sum{V(0.0f), V(0.0f), V(0.0f), V(0.0f)};
  const int taps = nearest ? 1 : 2;
  for (int j = 0; j < taps; ++j) {
    const I row = y.at[j] * level.width;
    for (int i = 0; i < taps; ++i) {
      const I word = level.first_word + (row + x.at[i]) * words;
      sum = fma(x.weight[i] * y.weight[j], load_texel(image.texels, word), sum);
    }
  }
  return sum;
}

template <class V>
LOCKSTEP_INLINE Rgba<V> lookup_image(const ImageLookup& image, const Vec2<V>& uv) {
  using I = IntOf<V>;
  const LevelExtent<V> whole{I(image.texels.width), I(image.texels.height), I(0)};
  return filtered_texel(image, whole, uv);
}

// The level of an image that what lookup() is told means.
template <class V>
LOCKSTEP_INLINE V level_of(const ImageLookup&, const UvTransform&, const V& level) {
  return level;
}
template <class V>
LOCKSTEP_INLINE V level_of(const ImageLookup& image, const UvTransform& t,
                           const UvFootprint<V>& footprint) {
  return level_of_detail(image.texels, t, footprint);
}

// Interpolates between the two levels of the pyramid next to that of `detail`. Most lookups need
// the whole image alone. Apart, as images without a pyramid are looked up faster by less code.
template <class V, class Detail>
[[gnu::noinline]] Rgba<V> lookup_levels(const ImageLookup& image, const UvTransform& t,
                                        const Vec2<V>& uv, const Detail& detail) {
  using I = IntOf<V>;
  const V level = level_of(image, t, detail);
  if (none(level > V(0.0f))) return lookup_image(image, uv);
  const int last = image.texels.level_count - 1;
  const V position = clamp(level, V(0.0f), V(float(last)));
  const V lower = floor(position), upper_weight = position - lower;
  Rgba<V> sum{V(0.0f), V(0.0f), V(0.0f), V(0.0f)};
  for (int k = 0; k < 2; ++k) {
    const I at = to_int(min(lower + V(float(k)), V(float(last))));
    const auto row = gather_rows(image.texels.levels, at * I(level_stride));
    const LevelExtent<V> extent{row.x, row.y, row.z};
    const V weight = k == 0 ? V(1.0f) - upper_weight : upper_weight;
    sum = fma(weight, filtered_texel(image, extent, uv), sum);
  }
  return sum;
}

// The image's colour at the mesh's uv.
template <class V>
LOCKSTEP_INLINE Rgba<V> lookup_image(const ImageLookup& image, const UvTransform& t,
                                     const Vec2<V>& uv) {
  return lookup_image(image, transform(t, uv));
}
template <class V, class Detail>
LOCKSTEP_INLINE Rgba<V> lookup_image(const ImageLookup& image, const UvTransform& t,
                                     const Vec2<V>& uv, const Detail& detail) {
  if (image.texels.level_count == 1) return lookup_image(image, t, uv);
  return lookup_levels(image, t, transform(t, uv), detail);
}

// x^power where x > 0, else 0.
template <class V>
LOCKSTEP_INLINE V power_of(V x, float power) {
  const V base = max(x, V(0.0f));
  if (power == 1.0f) return base;
  if (power == 2.0f) return base * base;
  if (power == 0.5f) return sqrt(base);
  constexpr int W = width_of<V>;
  float values[W];
  store(values, base);
  for (float& v : values) v = v > 0.0f ? __builtin_powf(v, power) : 0.0f;
  return load<V>(values);
}

// What a FloatInput of this channel and power takes from its texture.
template <class V>
LOCKSTEP_INLINE V number_of(const Rgba<V>& c, int channel, float power) {
  const V x = channel == 0   ? c.r
              : channel == 1 ? c.g
              : channel == 2 ? c.b
              : channel == 3 ? c.a
                             : (c.r + c.g + c.b) * V(1.0f / 3.0f);
  return power == 1.0f ? x : power_of(x, power);
}

// True where floor(u) + floor(v) is even.
template <class V>
LOCKSTEP_INLINE MaskOf<V> on_even_square(const Vec2<V>& uv) {
  const V half = (floor(uv.x) + floor(uv.y)) * V(0.5f);
  return half == floor(half);
}

template <class V>
LOCKSTEP_INLINE Rgba<V> mixed(const Rgba<V>& a, const Rgba<V>& b, V amount) {
  const V rest = V(1.0f) - amount;
  return fma(amount, b, Rgba<V>{rest * a.r, rest * a.g, rest * a.b, rest * a.a});
}

template <class V>
LOCKSTEP_INLINE Rgba<V> inverted(const Rgba<V>& c) {
  return {V(1.0f) - c.r, V(1.0f) - c.g, V(1.0f) - c.b, c.a};
}

// Runs a node on the stack, whose top is at stack[top - 1]; gives the new top.
// `detail` is that of lookup(), or nothing.
template <class V, class... Detail>
LOCKSTEP_INLINE int run_node(const TextureTable& table, const TextureNode& node, const Vec2<V>& uv,
                             Rgba<V>* stack, int top, const Detail&... detail) {
  const V x(node.value.x), y(node.value.y), z(node.value.z);
  if (node.op == TextureOp::Constant) {
    stack[top] = {x, y, z, V(1.0f)};
    return top + 1;
  }
  if (node.op == TextureOp::Image) {
    const ImageLookup& image = table.images[node.image];
    const Rgba<V> c = lookup_image(image, node.uv, uv, detail...);
    stack[top] = image.invert ? inverted(c) : c;
    return top + 1;
  }
  if (node.op == TextureOp::Scale) {
    Rgba<V>& c = stack[top - 1];
    c.r *= x, c.g *= y, c.b *= z;
    return top;
  }
  if (node.op == TextureOp::Number) {
    const V n = x * number_of(stack[top - 1], node.channel, node.power);
    stack[top - 1] = {n, n, n, n};
    return top;
  }
  if (node.op == TextureOp::Mix) {
    stack[top - 3] = mixed(stack[top - 3], stack[top - 2], stack[top - 1].r);
    return top - 2;
  }
  Rgba<V>& a = stack[top - 2];
  const Rgba<V>& b = stack[top - 1];
  if (node.op == TextureOp::Product) {
    a.r *= b.r, a.g *= b.g, a.b *= b.b, a.a *= b.a;
  } else {
    const MaskOf<V> even = on_even_square(transform(node.uv, uv));
    a = {select(even, a.r, b.r), select(even, a.g, b.g), select(even, a.b, b.b),
         select(even, a.a, b.a)};
  }
  return top - 1;
}

// The texture's linear colour and alpha at the mesh's uv; `texture` is the same in all lanes.
// `detail` is a UvFootprint, from which every image's size and transform give the level of its
// pyramid, or that level: 0 is the whole image, each step halves its sides. Only images with the
// filter Trilinear heed it.
template <class V, class... Detail>
[[gnu::noinline]] Rgba<V> lookup(const TextureTable& table, int texture, const Vec2<V>& uv,
                                 const Detail&... detail) {
  static_assert(sizeof...(Detail) <= 1);
  Rgba<V> stack[texture_stack_size];
  const TextureProgram program = table.programs[texture];
  int top = 0;
  for (int i = 0; i < program.count; ++i) {
    top = run_node(table, table.nodes[program.first + i], uv, stack, top, detail...);
  }
  return stack[0];
}

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
