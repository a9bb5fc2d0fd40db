#!/bin/bash
# Makes the samplers' tables again and compares them with those that are compiled in.
# Usage: sampler_tables_test.sh MAKE_TABLES TABLES
set -u
make_tables=$1 tables=$2
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

fail() {
  echo "FAILED: $*"
  exit 1
}

"$make_tables" "$folder/again.cpp" || fail "status $?"
cmp "$folder/again.cpp" "$tables" || fail "other tables than those of the build"
"$make_tables" 2>"$folder/stderr"
[ $? = 2 ] && grep -q '^Usage: make_tables FILE$' "$folder/stderr" || fail "no file: not the usage"
"$make_tables" "$folder/none/again.cpp" 2>"$folder/stderr"
[ $? = 1 ] && grep -q '^make_tables: cannot write' "$folder/stderr" || fail "no folder: not an error"
echo "all passed"
