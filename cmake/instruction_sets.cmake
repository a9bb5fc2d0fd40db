# The instruction sets that kernels are compiled for, once each from the same sources.
set(LOCKSTEP_ISAS sse4 avx2 avx512 CACHE STRING
    "Instruction sets to compile kernels for, any of sse4, avx2, avx512")
foreach(isa ${LOCKSTEP_ISAS})
  if(NOT isa MATCHES "^(sse4|avx2|avx512)$")
    message(FATAL_ERROR "LOCKSTEP_ISAS holds '${isa}'; choose from sse4, avx2, avx512")
  endif()
endforeach()
if(NOT LOCKSTEP_ISAS)
  message(FATAL_ERROR "LOCKSTEP_ISAS is empty; choose from sse4, avx2, avx512")
endif()
set(isa_flags_sse4 -msse4.2)
set(isa_flags_avx2 -mavx2 -mfma)
# g++ 12 warns about the undefined operands inside its own AVX-512 intrinsics.
set(isa_flags_avx512 -mavx512f -mavx512dq -mavx512vl -mavx512bw -mfma
    -mprefer-vector-width=512
    $<$<CXX_COMPILER_ID:GNU>:-Wno-uninitialized$<SEMICOLON>-Wno-maybe-uninitialized>)
# What a CPU needs to run them, as __builtin_cpu_supports() names it.
set(isa_cpu_features_sse4 sse4.2)
set(isa_cpu_features_avx2 avx2 fma)
set(isa_cpu_features_avx512 avx512f avx512dq avx512vl avx512bw fma)
# Without auto-vectorisation a width of 1 is honestly scalar.
set(isa_common_flags -fno-tree-vectorize -fno-tree-slp-vectorize)
