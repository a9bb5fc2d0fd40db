// Work that is the same for many lanes, once for each distinct value.
#pragma once

#include "core/simd.h"

#include <bit>

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

// Calls f(value, lanes) for every distinct value among the lanes of m, with the lanes that hold it.
template <class I, class F>
LOCKSTEP_INLINE void for_each_distinct(I values, MaskOf<I> m, F f) {
  if constexpr (width_of<I> == 1) {
    if (m) f(values, m);
  } else {
    while (any(m)) {
      const std::int32_t value = values[std::countr_zero(bits(m))];
      const MaskOf<I> same = m & (values == I(value));
      f(value, same);
      m = m & !same;
    }
  }
}

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
