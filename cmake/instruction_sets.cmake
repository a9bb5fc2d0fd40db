# The instruction sets that kernels are compiled for, once each from the same sources.
if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(aarch64|arm64)$")
  set(known_isas neon)
  # Characters have a sign, as on x86: text is read alike everywhere.
  target_compile_options(lockstep_options INTERFACE -fsigned-char
    $<$<CXX_COMPILER_ID:GNU>:-Wno-psabi>)  # notes on what g++ 10 changed
elseif(CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64)$")
  set(known_isas sse4 avx2 avx512)
else()
  message(FATAL_ERROR "no kernels for processors of type '${CMAKE_SYSTEM_PROCESSOR}': x86_64 and aarch64 have some")
endif()
list(JOIN known_isas ", " known_isa_names)
set(LOCKSTEP_ISAS ${known_isas} CACHE STRING
    "Instruction sets to compile kernels for, any of ${known_isa_names}")
foreach(isa ${LOCKSTEP_ISAS})
  if(NOT isa IN_LIST known_isas)
    message(FATAL_ERROR "LOCKSTEP_ISAS holds '${isa}'; choose from ${known_isa_names}")
  endif()
endforeach()
if(NOT LOCKSTEP_ISAS)
  message(FATAL_ERROR "LOCKSTEP_ISAS is empty; choose from ${known_isa_names}")
endif()
set(isa_flags_sse4 -msse4.2)
set(isa_flags_avx2 -mavx2 -mfma)
# g++ 12 warns about the undefined operands inside its own AVX-512 intrinsics.
set(isa_flags_avx512 -mavx512f -mavx512dq -mavx512vl -mavx512bw -mfma
    -mprefer-vector-width=512
    $<$<CXX_COMPILER_ID:GNU>:-Wno-uninitialized$<SEMICOLON>-Wno-maybe-uninitialized>)
set(isa_flags_neon)  # every 64-bit ARM has it, fused multiply-add included
# What a CPU needs to run them, as __builtin_cpu_supports() names it.
set(isa_cpu_features_sse4 sse4.2)
set(isa_cpu_features_avx2 avx2 fma)
set(isa_cpu_features_avx512 avx512f avx512dq avx512vl avx512bw fma)
set(isa_cpu_features_neon)
# Without auto-vectorisation a width of 1 is honestly scalar.
set(isa_common_flags -fno-tree-vectorize -fno-tree-slp-vectorize)
