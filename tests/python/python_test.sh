#!/usr/bin/env bash
# Runs a file of unittest with the first Python that has what it needs; says that it is skipped
# (status 77) where there is none. LOCKSTEP_PYTHON_TESTS=required makes that a failure.
# Usage: python_test.sh PROGRAM FILE [MODULE...]
set -uo pipefail
source=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
program=$(realpath "$1") file=$(realpath "$2")
shift 2
for python in python3 /usr/bin/python3; do
  if "$python" -c "import sys, $(IFS=,; echo "${*:-sys}"); sys.exit(sys.version_info < (3, 10))" \
    2>/dev/null; then
    export LOCKSTEP_PROGRAM=$program PYTHONPATH=$source/../../python PYTHONDONTWRITEBYTECODE=1
    exec timeout 300 "$python" "$file" -v
  fi
done
echo "SKIPPED: no Python 3.10 or later with: $* (see tests/packages.txt)"
[ "${LOCKSTEP_PYTHON_TESTS-}" = required ] && exit 1
exit 77
