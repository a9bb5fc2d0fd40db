#!/bin/bash
# Installs the build into a temporary prefix, moves that, and uses it as others would: the program by
# itself, and programs built on the CMake package (../consumer, ../../examples).
# Usage: install_test.sh CMAKE SOURCE BUILD CONFIGURATION COMPILER FLAGS
set -u
cmake=$1 source=$2 build=$3 configuration=$4 compiler=$5 flags=$6
# shellcheck source=tests/cli/checks.sh
source "$source/tests/cli/checks.sh" "$build/lockstep"

# must COMMAND...: runs it quietly; without it the rest makes no sense.
must() {
  "$@" >log 2>&1 </dev/null && return
  tail -n 30 log
  echo "FAILED: $*"
  exit 1
}

must "$cmake" --install "$build" --prefix "$folder/first"
prefix=$folder/moved
mv first moved

# What was built here is not named: other machines have other folders.
if [ "$configuration" = Release ]; then
  named=$(grep -rlF -e "$build" -e "$source/" -e "$folder" moved)
  [ -z "$named" ] || fail "names folders of the machine that built it: $named"
fi
for file in bin/lockstep share/man/man1/lockstep.1.gz share/bash-completion/completions/lockstep \
  share/lockstep/experiments/poster.toml include/lockstep/core/scene.h; do
  [ -s "moved/$file" ] || fail "not installed: $file"
done

# The program needs nothing else; images other than EXR take the module from its own folder.
installed() { env -i PATH=/usr/bin:/bin moved/bin/lockstep "$@" >stdout 2>stderr </dev/null; }
installed --version || fail "does not start: $(cat stderr)"
grep -qE '^kernels +(sse4|avx2|avx512)' stdout || fail "version: $(cat stdout)"
installed render cornell -o a.png --spp 1 --resolution 8x8 --threads 1 --quiet ||
  fail "no PNG: $(cat stderr)"
module_folder=$(dirname "$(find moved -name lockstep_image_formats.so)")
mv "$module_folder" elsewhere
installed render cornell -o b.png --spp 1 --resolution 8x8 --quiet && fail "a PNG without the module"
grep -q 'b.png: .*lockstep_image_formats.so, which is missing' stderr || fail "message: $(cat stderr)"
mv elsewhere "$module_folder"

# Programs that build on it.
strict="-Wall -Wextra"
[ "$configuration" = Release ] && strict+=" -Werror"
must "$cmake" -S "$source/tests/consumer" -B consumer -G Ninja -D CMAKE_PREFIX_PATH="$prefix" \
  -D CMAKE_CXX_COMPILER="$compiler" -D CMAKE_CXX_FLAGS="$flags -O1 $strict"
must "$cmake" --build consumer -j 1
must consumer/consumer owen own.exr
mv log consumer.txt
grep -qE '^mean 0\.[1-9]' consumer.txt || fail "mean: $(cat consumer.txt)"
grep -qE '^flip_ldr 0\.' consumer.txt || fail "metrics: $(cat consumer.txt)"
installed render cornell -o same.exr --resolution 48x48 --spp 16 --depth 3 --sampler owen --quiet
installed metrics own.exr same.exr
grep -qE '^rmse +0$' stdout || fail "the library's image is not the program's: $(cat stdout)"
must consumer/consumer owen own.png
consumer/consumer nosuch a.exr 2>stderr
[ $? = 2 ] || fail "status of a wrong sampler"
must consumer/small_consumer
grep -qE '^0\.[1-9]' log || fail "small_consumer: $(cat log)"

# The command line with a sampler, a perturbation and a metric from outside.
extended() { consumer/examples/lockstep-extended "$@" >stdout 2>stderr </dev/null; }
extended samplers
grep -qE '^  r2 ' stdout && grep -qE '^  gradient ' stdout || fail "not listed: $(cat stdout)"
extended completion bash && grep -q 'random .* r2[ "]' stdout || fail "r2 is not completed"
small="--resolution 24x16 --spp 4 --threads 1 --quiet"
for sampler in r2 cpt:sequence=r2 cpt:offset=gradient strata:sequence=r2,offset=gradient; do
  for width in 1 8; do
    # shellcheck disable=SC2086
    extended render cornell -o $width.exr $small --sampler $sampler --width $width ||
      fail "$sampler: $(cat stderr)"
  done
  extended metrics 1.exr 8.exr
  grep -qE '^rmse +0$' stdout || fail "$sampler differs between widths"
done
extended render cornell -o plain.exr $small --sampler cpt:sequence=r2
extended metrics plain.exr 8.exr
grep -qE '^p99 +[0-9.]*[1-9]' stdout || fail "p99: $(cat stdout)"
grep -qE '^rmse +0$' stdout && fail "offset=gradient does nothing"
extended compare cornell --samplers random,r2,cpt:offset=gradient --spp 4,16 --seeds 2 --resolution 24x16 \
  --reference-spp 64 --targets p99=0.5 --threads 1 --quiet -o out || fail "compare: $(cat stderr)"
head -n 1 out/errors.csv | grep -q ',p99' || fail "errors.csv: $(head -n 1 out/errors.csv)"
grep -q '^cornell,r2,' out/errors.csv || fail "no r2 in errors.csv"
grep -q '"p99"' out/summary.json || fail "no p99 in summary.json"
grep -q 'Error that 99' out/report.html || fail "no p99 in the report"

finish
