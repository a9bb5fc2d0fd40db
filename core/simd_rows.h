// Short rows of four elements, one per lane, between memory and lanes: one 16-byte access per lane
// and a transpose, where gathering element by element takes four accesses.
#pragma once

#include "core/simd.h"

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

// Element k of every lane's row.
template <class V>
struct Rows {
  V x, y, z, w;
};

#if defined(__SSE4_1__) || defined(__aarch64__)

namespace detail {

using Row = NativeVector<float, 4>::type;

LOCKSTEP_INLINE Row load_row(const float* p) { return load<Lanes<float, 4>>(p).s; }

#if defined(__aarch64__)
LOCKSTEP_INLINE Row unpack_low(Row a, Row b) { return vzip1q_f32(a, b); }
LOCKSTEP_INLINE Row unpack_high(Row a, Row b) { return vzip2q_f32(a, b); }
LOCKSTEP_INLINE Row low_pairs(Row a, Row b) {
  return (Row)vzip1q_f64((float64x2_t)a, (float64x2_t)b);
}
LOCKSTEP_INLINE Row high_pairs(Row a, Row b) {
  return (Row)vzip2q_f64((float64x2_t)a, (float64x2_t)b);
}
#else

#if defined(__AVX512F__)
#define LOCKSTEP_REGISTER_OP(x, name, ...)          \
  if constexpr (sizeof(x) == 64) {                  \
    return decltype(x)(_mm512_##name(__VA_ARGS__)); \
  } else if constexpr (sizeof(x) == 32) {           \
    return decltype(x)(_mm256_##name(__VA_ARGS__)); \
  } else {                                          \
    return decltype(x)(_mm_##name(__VA_ARGS__));    \
  }
#elif defined(__AVX__)
#define LOCKSTEP_REGISTER_OP(x, name, ...)          \
  if constexpr (sizeof(x) == 32) {                  \
    return decltype(x)(_mm256_##name(__VA_ARGS__)); \
  } else {                                          \
    return decltype(x)(_mm_##name(__VA_ARGS__));    \
  }
#else
#define LOCKSTEP_REGISTER_OP(x, name, ...) return decltype(x)(_mm_##name(__VA_ARGS__));
#endif

template <class R>
LOCKSTEP_INLINE R unpack_low(R a, R b) {
  LOCKSTEP_REGISTER_OP(a, unpacklo_ps, a, b)
}
template <class R>
LOCKSTEP_INLINE R unpack_high(R a, R b) {
  LOCKSTEP_REGISTER_OP(a, unpackhi_ps, a, b)
}
template <class R>
LOCKSTEP_INLINE R low_pairs(R a, R b) {
  LOCKSTEP_REGISTER_OP(a, shuffle_ps, a, b, 0x44)
}
template <class R>
LOCKSTEP_INLINE R high_pairs(R a, R b) {
  LOCKSTEP_REGISTER_OP(a, shuffle_ps, a, b, 0xee)
}
#undef LOCKSTEP_REGISTER_OP
#endif

// Rows of four registers become columns, within each group of four lanes; its own inverse.
template <class R>
struct Square {
  R a, b, c, d;

  LOCKSTEP_INLINE Square transposed() const {
    const R ab_low = unpack_low(a, b), ab_high = unpack_high(a, b);
    const R cd_low = unpack_low(c, d), cd_high = unpack_high(c, d);
    return {low_pairs(ab_low, cd_low), high_pairs(ab_low, cd_low), low_pairs(ab_high, cd_high),
            high_pairs(ab_high, cd_high)};
  }
};

// Stores lanes that are to be read one by one. Of 16, four at a time: scalar loads wait long for
// what a 64-byte store left, and moving lanes out of a register, which g++ 12 makes of a store it
// sees through, keeps the port busy that transposes need.
template <class T, int W>
LOCKSTEP_INLINE void spill(T (&to)[W], Lanes<T, W> v) {
#if defined(__AVX512F__)
  if constexpr (W == 16) {
    auto* part = reinterpret_cast<__m128i*>(to);
    _mm_storeu_si128(part, _mm512_castsi512_si128((__m512i)v.s));
    _mm_storeu_si128(part + 1, _mm512_extracti32x4_epi32((__m512i)v.s, 1));
    _mm_storeu_si128(part + 2, _mm512_extracti32x4_epi32((__m512i)v.s, 2));
    _mm_storeu_si128(part + 3, _mm512_extracti32x4_epi32((__m512i)v.s, 3));
    asm("" : "+m"(to));
    return;
  }
#endif
  store(to, v);
}

// The rows of lanes j, j + 4, j + 8, ... side by side.
template <int W>
LOCKSTEP_INLINE typename NativeVector<float, W>::type load_rows(const float* base,
                                                                const std::int32_t* index) {
  const Row row0 = load_row(base + index[0]);
  if constexpr (W == 4) return row0;
#if defined(__AVX__)
  if constexpr (W >= 8) {
    const __m256 low =
        _mm256_insertf128_ps(_mm256_castps128_ps256(row0), load_row(base + index[4]), 1);
    if constexpr (W == 8) return (typename NativeVector<float, W>::type)low;
#if defined(__AVX512F__)
    if constexpr (W == 16) {
      const __m256 high = _mm256_insertf128_ps(_mm256_castps128_ps256(load_row(base + index[8])),
                                               load_row(base + index[12]), 1);
      return (typename NativeVector<float, W>::type)_mm512_insertf32x8(_mm512_castps256_ps512(low),
                                                                       high, 1);
    }
#endif
  }
#endif
}

template <int W>
LOCKSTEP_INLINE Rows<Lanes<float, W>> gather_float_rows(const float* base,
                                                        Lanes<std::int32_t, W> index) {
  using V = Lanes<float, W>;
  if constexpr (V::native) {
    std::int32_t at[W];
    store(at, index);
    using R = typename V::Storage;
    const Square<R> columns = Square<R>{load_rows<W>(base, at), load_rows<W>(base, at + 1),
                                        load_rows<W>(base, at + 2), load_rows<W>(base, at + 3)}
                                  .transposed();
    return {V::from(columns.a), V::from(columns.b), V::from(columns.c), V::from(columns.d)};
  } else {
    const auto low = gather_float_rows(base, index.s.lo),
               high = gather_float_rows(base, index.s.hi);
    return {V::from({low.x, high.x}), V::from({low.y, high.y}), V::from({low.z, high.z}),
            V::from({low.w, high.w})};
  }
}

// Writes each four lanes of r to out[0], out[4], out[8], ...
template <int W, class R>
LOCKSTEP_INLINE void split(R r, Row* out) {
  if constexpr (W == 4) out[0] = r;
#if defined(__AVX__)
  if constexpr (W == 8) {
    out[0] = _mm256_castps256_ps128((__m256)r);
    out[4] = _mm256_extractf128_ps((__m256)r, 1);
  }
#endif
#if defined(__AVX512F__)
  if constexpr (W == 16) {
    out[0] = _mm512_castps512_ps128((__m512)r);
    out[4] = _mm512_extractf32x4_ps((__m512)r, 1);
    out[8] = _mm512_extractf32x4_ps((__m512)r, 2);
    out[12] = _mm512_extractf32x4_ps((__m512)r, 3);
  }
#endif
}

// Writes lane i's row to out[i].
template <int W>
LOCKSTEP_INLINE void store_rows(Row* out, const Rows<Lanes<float, W>>& rows) {
  using V = Lanes<float, W>;
  if constexpr (V::native) {
    using R = typename V::Storage;
    const Square<R> s = Square<R>{rows.x.s, rows.y.s, rows.z.s, rows.w.s}.transposed();
    split<W>(s.a, out);
    split<W>(s.b, out + 1);
    split<W>(s.c, out + 2);
    split<W>(s.d, out + 3);
  } else {
    store_rows<W / 2>(out, {rows.x.s.lo, rows.y.s.lo, rows.z.s.lo, rows.w.s.lo});
    store_rows<W / 2>(out + W / 2, {rows.x.s.hi, rows.y.s.hi, rows.z.s.hi, rows.w.s.hi});
  }
}

}  // namespace detail

// base[index], base[index + 1], base[index + 2] and base[index + 3] per lane, for float and
// int32_t. All four are read in every lane: leave room behind the end.
template <class T, int W>
LOCKSTEP_INLINE Rows<Lanes<T, W>> gather_rows(const T* base, Lanes<std::int32_t, W> index) {
  const auto rows = detail::gather_float_rows(reinterpret_cast<const float*>(base), index);
  if constexpr (std::is_same_v<T, float>) {
    return rows;
  } else {
    const auto bits_of = [](Lanes<float, W> a) LOCKSTEP_LAMBDA { return as_int(as_uint(a)); };
    return {bits_of(rows.x), bits_of(rows.y), bits_of(rows.z), bits_of(rows.w)};
  }
}

// Adds the rows of the lanes where m is set to rows[index], four floats each. Indices of those
// lanes must differ.
template <int W>
LOCKSTEP_INLINE void add_rows(float* rows, Lanes<std::int32_t, W> index,
                              const Rows<Lanes<float, W>>& add, LaneMask<W> m) {
  detail::Row values[W];
  std::int32_t at[W];
  detail::store_rows<W>(values, add);
  detail::spill(at, index);
  for (std::uint32_t left = bits(m); left != 0; left &= left - 1) {
    const int lane = std::countr_zero(left);
    float* row = rows + 4 * at[lane];
    store(row, Lanes<float, 4>::from(detail::load_row(row) + values[lane]));
  }
}

#endif

template <class T>
LOCKSTEP_INLINE Rows<T> gather_rows(const T* base, std::int32_t index) {
  return {base[index], base[index + 1], base[index + 2], base[index + 3]};
}

LOCKSTEP_INLINE void add_rows(float* rows, std::int32_t index, const Rows<float>& add, bool m) {
  if (!m) return;
  float* row = rows + 4 * index;
  row[0] += add.x, row[1] += add.y, row[2] += add.z, row[3] += add.w;
}

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
