// Operations on lanes that C++ operators do not give: select, reductions, min/max, fma, memory.
// Included by core/simd.h only. Each has a plain overload for W = 1 with the same result.
#pragma once

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

// Casts ---------------------------------------------------------------------------------------

LOCKSTEP_INLINE float as_float(std::uint32_t x) { return std::bit_cast<float>(x); }
LOCKSTEP_INLINE std::uint32_t as_uint(float x) { return std::bit_cast<std::uint32_t>(x); }
LOCKSTEP_INLINE std::uint32_t as_uint(std::int32_t x) { return std::uint32_t(x); }
LOCKSTEP_INLINE std::int32_t as_int(std::uint32_t x) { return std::int32_t(x); }

// A C-style cast between vectors of one size keeps the bits.
template <int W>
LOCKSTEP_INLINE Lanes<float, W> as_float(Lanes<std::uint32_t, W> a) {
  return apply_lanes<Lanes<float, W>>([](auto x) LOCKSTEP_LAMBDA { return x; }, a);
}
template <class T, int W>
LOCKSTEP_INLINE Lanes<std::uint32_t, W> as_uint(Lanes<T, W> a) {
  return apply_lanes<Lanes<std::uint32_t, W>>([](auto x) LOCKSTEP_LAMBDA { return x; }, a);
}
template <int W>
LOCKSTEP_INLINE Lanes<std::int32_t, W> as_int(Lanes<std::uint32_t, W> a) {
  return apply_lanes<Lanes<std::int32_t, W>>([](auto x) LOCKSTEP_LAMBDA { return x; }, a);
}

// Nearest float of a signed integer; truncation towards zero of a float within int range.
LOCKSTEP_INLINE float to_float(std::int32_t x) { return float(x); }
LOCKSTEP_INLINE std::int32_t to_int(float x) { return std::int32_t(x); }
template <int W>
LOCKSTEP_INLINE Lanes<float, W> to_float(Lanes<std::int32_t, W> a) {
  return apply_lanes<Lanes<float, W>>(
      [](auto x) LOCKSTEP_LAMBDA {
        return __builtin_convertvector(x, typename NativeVector<float, sizeof(x) / 4>::type);
      },
      a);
}
template <int W>
LOCKSTEP_INLINE Lanes<std::int32_t, W> to_int(Lanes<float, W> a) {
  return apply_lanes<Lanes<std::int32_t, W>>(
      [](auto x) LOCKSTEP_LAMBDA {
        return __builtin_convertvector(x, typename NativeVector<std::int32_t, sizeof(x) / 4>::type);
      },
      a);
}

// Masks ---------------------------------------------------------------------------------------

// One bit per lane, lane 0 lowest.
LOCKSTEP_INLINE std::uint32_t bits(bool m) { return m; }
template <int W>
LOCKSTEP_INLINE std::uint32_t bits(LaneMask<W> m) {
  if constexpr (!LaneMask<W>::native) {
    return bits(m.s.lo) | bits(m.s.hi) << (W / 2);
#if defined(__AVX512DQ__)
  } else if constexpr (W == 16) {
    return _mm512_movepi32_mask((__m512i)m.s);
#endif
#if defined(__AVX__)
  } else if constexpr (W == 8) {
    return std::uint32_t(_mm256_movemask_ps((__m256)m.s));
#endif
#if defined(__SSE4_1__)
  } else if constexpr (W == 4) {
    return std::uint32_t(_mm_movemask_ps((__m128)m.s));
#elif defined(__aarch64__)
  } else if constexpr (W == 4) {
    return vaddvq_u32((uint32x4_t)(m.s & NativeVector<std::int32_t, 4>::type{1, 2, 4, 8}));
#endif
  } else {
    std::uint32_t r = 0;
    for (int i = 0; i < W; ++i) r |= std::uint32_t(m.s[i] & 1) << i;
    return r;
  }
}
template <class M>
LOCKSTEP_INLINE bool any(M m) {
  return bits(m) != 0;
}
template <class M>
LOCKSTEP_INLINE bool none(M m) {
  return bits(m) == 0;
}
template <class M>
LOCKSTEP_INLINE bool all(M m) {
  return bits(m) == (1u << width_of<M>)-1u;
}
template <class M>
LOCKSTEP_INLINE int count(M m) {
  return std::popcount(bits(m));
}

// m ? a : b, lane by lane.
template <class T>
requires std::is_arithmetic_v<T> LOCKSTEP_INLINE T select(bool m, T a, T b) { return m ? a : b; }
LOCKSTEP_INLINE bool select(bool m, bool a, bool b) { return m ? a : b; }
template <class T, int W>
LOCKSTEP_INLINE Lanes<T, W> select(LaneMask<W> m, Lanes<T, W> a, Lanes<T, W> b) {
  return apply_lanes<Lanes<T, W>>([](auto k, auto x, auto y) LOCKSTEP_LAMBDA { return k ? x : y; },
                                  m, a, b);
}

template <int W>
LOCKSTEP_INLINE LaneMask<W> select(LaneMask<W> m, LaneMask<W> a, LaneMask<W> b) {
  return (m & a) | ((!m) & b);
}

// Arithmetic ----------------------------------------------------------------------------------
// min and max give the second operand where either is NaN, as SSE does.
LOCKSTEP_INLINE float min(float a, float b) { return a < b ? a : b; }
LOCKSTEP_INLINE float max(float a, float b) { return a > b ? a : b; }
LOCKSTEP_INLINE float sqrt(float a) { return __builtin_sqrtf(a); }
LOCKSTEP_INLINE float floor(float a) { return __builtin_floorf(a); }
LOCKSTEP_INLINE float abs(float a) { return __builtin_fabsf(a); }

// a * b + c: fused where the instruction set has it, else rounded twice, at every width alike.
LOCKSTEP_INLINE float fma(float a, float b, float c) {
#if defined(__FMA__) || defined(__aarch64__)
  return __builtin_fmaf(a, b, c);
#else
  return a * b + c;
#endif
}

#if defined(__aarch64__)
template <int W>
LOCKSTEP_INLINE Lanes<float, W> min(Lanes<float, W> a, Lanes<float, W> b) {
  return select(a < b, a, b);
}
template <int W>
LOCKSTEP_INLINE Lanes<float, W> max(Lanes<float, W> a, Lanes<float, W> b) {
  return select(a > b, a, b);
}
template <int W>
LOCKSTEP_INLINE Lanes<float, W> sqrt(Lanes<float, W> a) {
  return apply_lanes<Lanes<float, W>>([](auto x) LOCKSTEP_LAMBDA { return vsqrtq_f32(x); }, a);
}
template <int W>
LOCKSTEP_INLINE Lanes<float, W> floor(Lanes<float, W> a) {
  return apply_lanes<Lanes<float, W>>([](auto x) LOCKSTEP_LAMBDA { return vrndmq_f32(x); }, a);
}
template <int W>
LOCKSTEP_INLINE Lanes<float, W> fma(Lanes<float, W> a, Lanes<float, W> b, Lanes<float, W> c) {
  return apply_lanes<Lanes<float, W>>(
      [](auto x, auto y, auto z) LOCKSTEP_LAMBDA { return vfmaq_f32(z, x, y); }, a, b, c);
}
#else

#if defined(__AVX512F__)
#define LOCKSTEP_FOR_REGISTER(x, name, suffix, ...)            \
  if constexpr (sizeof(x) == 64) {                             \
    return decltype(x)(_mm512_##name##_##suffix(__VA_ARGS__)); \
  } else if constexpr (sizeof(x) == 32) {                      \
    return decltype(x)(_mm256_##name##_##suffix(__VA_ARGS__)); \
  } else {                                                     \
    return decltype(x)(_mm_##name##_##suffix(__VA_ARGS__));    \
  }
#elif defined(__AVX__)
#define LOCKSTEP_FOR_REGISTER(x, name, suffix, ...)            \
  if constexpr (sizeof(x) == 32) {                             \
    return decltype(x)(_mm256_##name##_##suffix(__VA_ARGS__)); \
  } else {                                                     \
    return decltype(x)(_mm_##name##_##suffix(__VA_ARGS__));    \
  }
#else
#define LOCKSTEP_FOR_REGISTER(x, name, suffix, ...) \
  return decltype(x)(_mm_##name##_##suffix(__VA_ARGS__));
#endif

template <int W>
LOCKSTEP_INLINE Lanes<float, W> min(Lanes<float, W> a, Lanes<float, W> b) {
  return apply_lanes<Lanes<float, W>>(
      [](auto x, auto y) LOCKSTEP_LAMBDA { LOCKSTEP_FOR_REGISTER(x, min, ps, x, y) }, a, b);
}
template <int W>
LOCKSTEP_INLINE Lanes<float, W> max(Lanes<float, W> a, Lanes<float, W> b) {
  return apply_lanes<Lanes<float, W>>(
      [](auto x, auto y) LOCKSTEP_LAMBDA { LOCKSTEP_FOR_REGISTER(x, max, ps, x, y) }, a, b);
}
template <int W>
LOCKSTEP_INLINE Lanes<float, W> sqrt(Lanes<float, W> a) {
  return apply_lanes<Lanes<float, W>>(
      [](auto x) LOCKSTEP_LAMBDA { LOCKSTEP_FOR_REGISTER(x, sqrt, ps, x) }, a);
}
template <int W>
LOCKSTEP_INLINE Lanes<float, W> floor(Lanes<float, W> a) {
  return apply_lanes<Lanes<float, W>>(
      [](auto x) LOCKSTEP_LAMBDA { LOCKSTEP_FOR_REGISTER(x, floor, ps, x) }, a);
}
template <int W>
LOCKSTEP_INLINE Lanes<float, W> fma(Lanes<float, W> a, Lanes<float, W> b, Lanes<float, W> c) {
#if defined(__FMA__)
  return apply_lanes<Lanes<float, W>>(
      [](auto x, auto y, auto z) LOCKSTEP_LAMBDA { LOCKSTEP_FOR_REGISTER(x, fmadd, ps, x, y, z) },
      a, b, c);
#else
  return a * b + c;
#endif
}
#if defined(__AVX512VL__)
template <int W>
LOCKSTEP_INLINE Lanes<float, W> rsqrt_estimate(Lanes<float, W> a) {
  return apply_lanes<Lanes<float, W>>(
      [](auto x) LOCKSTEP_LAMBDA { LOCKSTEP_FOR_REGISTER(x, rsqrt14, ps, x) }, a);
}
LOCKSTEP_INLINE float rsqrt_estimate(float a) {
  return _mm_cvtss_f32(_mm_rsqrt14_ss(_mm_setzero_ps(), _mm_set_ss(a)));
}
#endif
#undef LOCKSTEP_FOR_REGISTER
#endif

// 1 / sqrt(a), infinite at 0; relative error below 2^-22. AVX-512 refines an estimate of 14 bits:
// sixteen roots and divisions hold up the divider as long as forty other operations take.
template <class V>
LOCKSTEP_INLINE V rsqrt(V a) {
#if defined(__AVX512VL__)
  const V y = rsqrt_estimate(a);
  const V error = fma(-(a * y), y, V(1.0f));
  return select(error == error, fma(y * V(0.5f), error, y), y);  // y: where a is 0 or infinite
#else
  return V(1.0f) / sqrt(a);
#endif
}

template <int W>
LOCKSTEP_INLINE Lanes<float, W> abs(Lanes<float, W> a) {
  return as_float(as_uint(a) & Lanes<std::uint32_t, W>(0x7fffffffu));
}

// |magnitude| with the sign of `sign`.
template <class V>
LOCKSTEP_INLINE V copysign(V magnitude, V sign) {
  using U = UIntOf<V>;
  return as_float((as_uint(magnitude) & U(0x7fffffffu)) | (as_uint(sign) & U(0x80000000u)));
}

template <class V>
LOCKSTEP_INLINE V clamp(V x, V lo, V hi) {
  return min(max(x, lo), hi);
}

// True where neither infinite nor NaN.
template <class V>
LOCKSTEP_INLINE MaskOf<V> is_finite(V x) {
  return abs(x) <= V(std::numeric_limits<float>::max());
}

// Memory --------------------------------------------------------------------------------------

template <class V>
struct LaneElement {
  using type = V;
};
template <class T, int W>
struct LaneElement<Lanes<T, W>> {
  using type = T;
};
template <class V>
using ElementOf = typename LaneElement<V>::type;

// A register's worth of elements anywhere in memory. (Where lanes are copied with memcpy, g++ 12
// moves 32-byte integers in pieces that stall on their way through the stack.)
template <class T, int W>
struct MemoryVector {
  typedef T type __attribute__((vector_size(sizeof(T) * W), aligned(alignof(T)), may_alias));
};

// width_of<V> consecutive elements; no alignment is asked for.
template <class V>
LOCKSTEP_INLINE V load(const ElementOf<V>* p) {
  constexpr int W = width_of<V>;
  if constexpr (W == 1) {
    return *p;
  } else if constexpr (V::native) {
    return V::from(*reinterpret_cast<const typename MemoryVector<ElementOf<V>, W>::type*>(p));
  } else {
    using Half = typename V::Half;
    return V::from({load<Half>(p), load<Half>(p + W / 2)});
  }
}
template <class V>
LOCKSTEP_INLINE void store(ElementOf<V>* p, V v) {
  constexpr int W = width_of<V>;
  if constexpr (W == 1) {
    *p = v;
  } else if constexpr (V::native) {
    *reinterpret_cast<typename MemoryVector<ElementOf<V>, W>::type*>(p) = v.s;
  } else {
    store(p, v.s.lo);
    store(p + W / 2, v.s.hi);
  }
}

// 0, 1, 2, ... in the lanes.
template <int W>
LOCKSTEP_INLINE Int<W> lane_indices() {
  static constexpr std::int32_t values[16] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
  return load<Int<W>>(values);
}

// base[index] per lane, for float, int32_t and uint32_t. Every lane is read: indices must be valid
// in all of them.
template <class T>
LOCKSTEP_INLINE T gather(const T* base, std::int32_t index) {
  return base[index];
}
// Lane by lane, but with AVX-512: the 8-wide gather instruction is half as fast as eight loads on
// AMD cores, and on Intel's since their microcode guards against data sampling.
template <class T, int W>
LOCKSTEP_INLINE Lanes<T, W> gather(const T* base, Lanes<std::int32_t, W> index) {
  return apply_lanes<Lanes<T, W>>(
      [base](auto i) LOCKSTEP_LAMBDA {
        using Target = typename NativeVector<T, sizeof(i) / 4>::type;
        if constexpr (sizeof(i) == 16) {
          return Target{base[i[0]], base[i[1]], base[i[2]], base[i[3]]};
        } else if constexpr (sizeof(i) == 32) {
          return Target{base[i[0]], base[i[1]], base[i[2]], base[i[3]],
                        base[i[4]], base[i[5]], base[i[6]], base[i[7]]};
#if defined(__AVX512F__)
        } else {
          return (Target)_mm512_i32gather_epi32((__m512i)i, (const int*)base, 4);
#endif
        }
      },
      index);
}

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep

// glm::vec over lanes asks numeric_limits whether its element is a number.
template <class T, int W>
struct std::numeric_limits<lockstep::Lanes<T, W>> : std::numeric_limits<T> {};
