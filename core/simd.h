// Width as a type: `Float<W>`, `Int<W>`, `UInt<W>` and `Mask<W>` hold one value per packet lane.
// W = 1 is plain float, int32_t, uint32_t and bool, so one source serves scalar and packet code.
//
// Widths above the machine's registers are pairs of halves, never a wider compiler vector: those
// are several times slower. Nothing here rounds differently from one width to another, and no
// approximate instruction is used: the same expression gives the same bits at every W.
//
// Everything lives in a namespace per instruction set, so that objects compiled for different sets
// can be linked into one program. All functions are force-inlined for the same reason.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <limits>
#include <type_traits>

#if defined(__SSE4_1__)
#include <immintrin.h>
#elif defined(__aarch64__)
#include <arm_neon.h>
#endif

#if defined(__AVX512F__) && defined(__AVX512DQ__) && defined(__AVX512VL__) && defined(__FMA__)
#define LOCKSTEP_ISA_NAMESPACE isa_avx512
#elif defined(__AVX2__) && defined(__FMA__)
#define LOCKSTEP_ISA_NAMESPACE isa_avx2
#elif defined(__SSE4_1__)
#define LOCKSTEP_ISA_NAMESPACE isa_sse4
#elif defined(__aarch64__)
#define LOCKSTEP_ISA_NAMESPACE isa_neon
#else
#define LOCKSTEP_ISA_NAMESPACE isa_baseline
#endif

#define LOCKSTEP_INLINE [[gnu::always_inline]] inline
#define LOCKSTEP_LAMBDA __attribute__((always_inline))

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

#if defined(__AVX512F__)
inline constexpr int native_lanes = 16;
#elif defined(__AVX2__)
inline constexpr int native_lanes = 8;
#else
inline constexpr int native_lanes = 4;
#endif

template <class T, int W>
struct NativeVector {
  typedef T type __attribute__((vector_size(sizeof(T) * W)));
};

template <class Half>
struct LanePair {
  Half lo, hi;
};

// Applies f to the native registers of the operands and gathers the results into an R.
template <class R, class F, class... A>
LOCKSTEP_INLINE R apply_lanes(F f, A... a) {
  if constexpr (R::native) {
    return R::from((typename R::Storage)f(a.s...));
  } else {
    return R::from(
        {apply_lanes<typename R::Half>(f, a.s.lo...), apply_lanes<typename R::Half>(f, a.s.hi...)});
  }
}

template <int W>
struct LaneMask;

// W values of type T (float, int32_t or uint32_t), W a power of two from 4 to 16.
template <class T, int W>
struct Lanes {
  static constexpr bool native = W <= native_lanes;
  using Half = Lanes<T, W / 2>;
  using Storage = typename std::conditional_t<native, NativeVector<T, W>,
                                              std::type_identity<LanePair<Half>>>::type;
  Storage s;

  Lanes() = default;
  LOCKSTEP_INLINE Lanes(T value) {
    if constexpr (native) {
      s = value - Storage{};  // value - 0 keeps the sign of zero, value + 0 would not
    } else {
      s = {Half(value), Half(value)};
    }
  }
  LOCKSTEP_INLINE static Lanes from(Storage storage) {
    Lanes r;
    r.s = storage;
    return r;
  }
  LOCKSTEP_INLINE T operator[](int lane) const {
    if constexpr (native) {
      return s[lane];
    } else {
      return lane < W / 2 ? s.lo[lane] : s.hi[lane - W / 2];
    }
  }

#define LOCKSTEP_BINARY(op)                                                                 \
  LOCKSTEP_INLINE friend Lanes operator op(Lanes a, Lanes b) {                              \
    return apply_lanes<Lanes>([](auto x, auto y) LOCKSTEP_LAMBDA { return x op y; }, a, b); \
  }                                                                                         \
  LOCKSTEP_INLINE Lanes& operator op##=(Lanes b) { return *this = *this op b; }
  LOCKSTEP_BINARY(+)
  LOCKSTEP_BINARY(-)
  LOCKSTEP_BINARY(*)
  LOCKSTEP_BINARY(/)
  LOCKSTEP_BINARY(&)
  LOCKSTEP_BINARY(|)
  LOCKSTEP_BINARY(^)
#undef LOCKSTEP_BINARY

#define LOCKSTEP_COMPARE(op)                                                                      \
  LOCKSTEP_INLINE friend LaneMask<W> operator op(Lanes a, Lanes b) {                              \
    return apply_lanes<LaneMask<W>>([](auto x, auto y) LOCKSTEP_LAMBDA { return x op y; }, a, b); \
  }
  LOCKSTEP_COMPARE(<)
  LOCKSTEP_COMPARE(<=)
  LOCKSTEP_COMPARE(>)
  LOCKSTEP_COMPARE(>=)
  LOCKSTEP_COMPARE(==)
  LOCKSTEP_COMPARE(!=)
#undef LOCKSTEP_COMPARE

  LOCKSTEP_INLINE Lanes operator-() const {
    return apply_lanes<Lanes>([](auto x) LOCKSTEP_LAMBDA { return -x; }, *this);
  }
  LOCKSTEP_INLINE friend Lanes operator<<(Lanes a, int count) {
    return apply_lanes<Lanes>([count](auto x) LOCKSTEP_LAMBDA { return x << count; }, a);
  }
  LOCKSTEP_INLINE friend Lanes operator>>(Lanes a, int count) {
    return apply_lanes<Lanes>([count](auto x) LOCKSTEP_LAMBDA { return x >> count; }, a);
  }
};

// One truth value per lane: all bits of a lane set, or none.
template <int W>
struct LaneMask {
  static constexpr bool native = W <= native_lanes;
  using Half = LaneMask<W / 2>;
  using Storage = typename std::conditional_t<native, NativeVector<std::int32_t, W>,
                                              std::type_identity<LanePair<Half>>>::type;
  Storage s;

  LaneMask() = default;
  LOCKSTEP_INLINE LaneMask(bool value) {
    if constexpr (native) {
      s = -std::int32_t(value) - Storage{};
    } else {
      s = {Half(value), Half(value)};
    }
  }
  LOCKSTEP_INLINE static LaneMask from(Storage storage) {
    LaneMask r;
    r.s = storage;
    return r;
  }
  LOCKSTEP_INLINE friend LaneMask operator&(LaneMask a, LaneMask b) {
    return apply_lanes<LaneMask>([](auto x, auto y) LOCKSTEP_LAMBDA { return x & y; }, a, b);
  }
  LOCKSTEP_INLINE friend LaneMask operator|(LaneMask a, LaneMask b) {
    return apply_lanes<LaneMask>([](auto x, auto y) LOCKSTEP_LAMBDA { return x | y; }, a, b);
  }
  LOCKSTEP_INLINE LaneMask operator!() const {
    return apply_lanes<LaneMask>([](auto x) LOCKSTEP_LAMBDA { return ~x; }, *this);
  }
};

template <int W>
using Float = std::conditional_t<W == 1, float, Lanes<float, W>>;
template <int W>
using Int = std::conditional_t<W == 1, std::int32_t, Lanes<std::int32_t, W>>;
template <int W>
using UInt = std::conditional_t<W == 1, std::uint32_t, Lanes<std::uint32_t, W>>;
template <int W>
using Mask = std::conditional_t<W == 1, bool, LaneMask<W>>;

template <class V>
inline constexpr int width_of = 1;
template <class T, int W>
inline constexpr int width_of<Lanes<T, W>> = W;
template <int W>
inline constexpr int width_of<LaneMask<W>> = W;

template <class V>
using FloatOf = Float<width_of<V>>;
template <class V>
using IntOf = Int<width_of<V>>;
template <class V>
using UIntOf = UInt<width_of<V>>;
template <class V>
using MaskOf = Mask<width_of<V>>;

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep

#include "core/simd_ops.h"
