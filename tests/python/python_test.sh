#!/usr/bin/env bash
# Runs a file of unittest with the first Python that has the modules, or, where none has them all,
# with the first that has those before `--`; says that it is skipped (status 77) where none is.
# LOCKSTEP_PYTHON_TESTS=required makes a missing module a failure.
# Usage: python_test.sh PROGRAM FILE [MODULE...] [-- MODULE...]
set -uo pipefail
source=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
program=$(realpath "$1") file=$(realpath "$2")
shift 2
needed=() all=()
for module in "$@"; do
  [ "$module" = -- ] && needed=("${all[@]}") || all+=("$module")
done
[[ " $* " == *" -- "* && ${LOCKSTEP_PYTHON_TESTS-} != required ]] || needed=("${all[@]}")

# has PYTHON MODULE...
has() {
  "$1" -c 'import importlib.util, sys
sys.exit(sys.version_info < (3, 10) or not all(map(importlib.util.find_spec, sys.argv[1:])))' \
    "${@:2}" 2>/dev/null
}

run_with() {
  for python in python3 /usr/bin/python3; do
    if has "$python" "$@"; then
      export LOCKSTEP_PROGRAM=$program PYTHONPATH=$source/../../python PYTHONDONTWRITEBYTECODE=1
      exec timeout 900 "$python" "$file" -v
    fi
  done
}
run_with "${all[@]}"
run_with "${needed[@]}"
echo "SKIPPED: no Python 3.10 or later with: ${needed[*]-} (see tests/packages.txt)"
[ "${LOCKSTEP_PYTHON_TESTS-}" = required ] && exit 1
exit 77
