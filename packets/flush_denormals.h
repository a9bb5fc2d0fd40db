// Denormal floats flushed to zero, as kernels run.
#pragma once

#include <cstdint>

#if defined(__x86_64__)
#include <xmmintrin.h>
#endif

namespace lockstep {

// For the calling thread, in results and operands, until the object goes.
class FlushDenormals {
 public:
  FlushDenormals() : saved_(control()) { set_control(saved_ | flush); }
  ~FlushDenormals() { set_control(saved_); }
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;

 private:
#if defined(__aarch64__)
  using Control = std::uint64_t;
  static constexpr Control flush = 1u << 24;  // FZ, of scalar and vector instructions
  static Control control() {
    Control c;
    asm volatile("mrs %0, fpcr" : "=r"(c));
    return c;
  }
  static void set_control(Control c) { asm volatile("msr fpcr, %0" : : "r"(c) : "memory"); }
#else
  using Control = std::uint32_t;
  static constexpr Control flush = 0x8040;  // FTZ and DAZ
  static Control control() { return _mm_getcsr(); }
  static void set_control(Control c) { _mm_setcsr(c); }
#endif

  Control saved_;
};

}  // namespace lockstep
