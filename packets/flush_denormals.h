// Denormal floats flushed to zero, as kernels run.
#pragma once

#include <xmmintrin.h>

namespace lockstep {

// For the calling thread, in results and operands, until the object goes.
class FlushDenormals {
 public:
  FlushDenormals() : saved_(_mm_getcsr()) { _mm_setcsr(saved_ | 0x8040); }
  ~FlushDenormals() { _mm_setcsr(saved_); }
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;

 private:
  unsigned saved_;
};

}  // namespace lockstep
