#!/bin/sh
# symbols_test.sh NM OBJECT...
# Kernels are compiled for instruction sets that the CPU may lack. The linker keeps one copy of each
# weak symbol, whichever object it comes from, so a kernel object must define none outside its
# instruction set's namespace: the rest of the program might be given that copy.
nm=$1
shift
status=0
[ $# -gt 0 ] || { echo "no objects to look at"; exit 1; }
for object in "$@"; do
  # W, V: weak; u: unique. DW.ref.* is a pointer that exception tables use, without code.
  symbols=$("$nm" --defined-only "$object") || exit 1
  leaks=$(printf '%s\n' "$symbols" |
    awk '$2 ~ /^[WwVvu]$/ && $3 !~ /isa_(sse4|avx2|avx512|neon)/ && $3 !~ /^DW\.ref\./ { print $3 }')
  [ -z "$leaks" ] && continue
  status=1
  printf '%s defines for the whole program:\n%s\n' "$object" "$(printf '%s\n' "$leaks" | c++filt)"
done
exit $status
