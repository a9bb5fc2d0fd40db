// Functions whose loops are worth wider vectors than the program is compiled for.
#pragma once

// Before a function: it is compiled for several instruction sets, and the widest that the machine
// has is chosen when the program starts. As nothing is contracted or reordered, all give the same
// bits. Sanitizers run before that choice can be made.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define LOCKSTEP_VECTOR_CLONES \
  __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define LOCKSTEP_VECTOR_CLONES
#endif
