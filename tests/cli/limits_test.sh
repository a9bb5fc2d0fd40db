#!/bin/bash
# Runs the built program with little memory and on full disks: it ends with one clear line and loses
# nothing that was there.
# Usage: limits_test.sh PROGRAM
source "$(dirname "$0")/checks.sh"

# A build with sanitizers needs more address space than there is.
(ulimit -v 2000000 && "$program" --version >/dev/null 2>&1) || { echo "skipped: no ulimit -v"; exit 77; }

# one_line WHAT: stderr is a single line that begins with the program's name.
one_line() {
  [ "$(grep -vc warning: stderr)" = 1 ] && grep -q '^lockstep: ' stderr ||
    fail "$1: not one line: $(head -c 400 stderr)"
}

# sweep KIB UNTOUCHED ARGUMENT...: runs the program with ever more address space, from where it
# starts at all until it succeeds; every failure is one line, and the file UNTOUCHED stays as it is.
sweep() {
  local kib=$1 untouched=$2 status failed=0 before
  shift 2
  before=$(cksum <"$untouched")
  while [ "$kib" -lt 4000000 ]; do
    (ulimit -v "$kib" && exec timeout 60 "$program" "$@" >stdout 2>stderr </dev/null)
    status=$?
    [ $status = 0 ] && break
    # Before the program begins, what does not fit is for the loader and the libraries to report.
    (ulimit -v "$kib" && exec "$program" --version >/dev/null 2>&1)
    if [ $? -le 1 ]; then
      [ $status = 1 ] || fail "status $status with $kib KiB: lockstep $*: $(head -c 400 stderr)"
      one_line "$kib KiB: lockstep $*"
      grep -q 'memory' stderr || fail "$kib KiB: lockstep $*: $(cat stderr)"
      [ "$(cksum <"$untouched")" = "$before" ] || fail "$kib KiB: $untouched has changed"
      failed=$((failed + 1))
    fi
    kib=$((kib * 115 / 100))
  done
  [ "$kib" -lt 4000000 ] || fail "never succeeds: lockstep $*"
  [ $failed -gt 0 ] || fail "never lacks memory: lockstep $*"
  [ -z "$(find . -name '*.tmp' -o -name '*.part' -o -name '.*.tmp')" ] || fail "left $(find . -name '*.part')"
}

start=60000  # KiB: less than the program needs to start
image="--resolution 512x384 --threads 1 --quiet"

"$program" render cornell -o a.exr $image --spp 1 || fail "render"
"$program" render cornell -o b.exr $image --spp 2 || fail "render"
cp a.exr kept.exr
sweep $start kept.exr render reef -o r.exr $image --spp 1 --sampler rcs:pilot=1 --resume
sweep $start a.exr metrics a.exr b.exr --maps maps
sweep $start kept.exr info reef
sweep $start kept.exr profile cornell -o prof --resolution 256x192 --weights 0,1 --maps none \
  --lanes 4x4x1 --spp 2 --depth 2 --repeats 1 --reference-spp 4 --seeds 1 --threads 1 --quiet

# What a comparison has measured stays, and it goes on from there.
again="compare cornell --samplers random,owen --spp 1,2 --reference-spp 8 --resolution 256x192
  --threads 1 --timing-repeats 0 --quiet"
untimed() { cut -d, -f1-4,7-20,23 "$1/errors.csv" | sort; }
"$program" $again --seeds 2 -o whole >/dev/null || fail "compare"
"$program" $again --seeds 1 -o some >/dev/null || fail "compare"
head -5 some/errors.csv >rows
sweep $start rows $again --seeds 2 -o some --resume
head -5 some/errors.csv | cmp -s - rows || fail "rows of a comparison have changed"
[ "$(untimed some)" = "$(untimed whole)" ] || fail "a comparison with little memory has other errors"

# More than there is is refused before it is taken.
"$program" render cornell -o huge.exr --resolution 32768x32768 --spp 1 --quiet >stdout 2>stderr &
huge=$!
for i in $(seq 600); do kill -0 $huge 2>/dev/null || break; sleep 0.1; done
if kill -0 $huge 2>/dev/null; then
  kill -KILL $huge  # it fits this machine
else
  wait $huge
  [ $? = 1 ] && one_line "a huge image" && grep -q 'needs .* GiB .*--resolution' stderr ||
    fail "a huge image: $(cat stderr)"
fi

# Full disks. What was there before is whole, and nothing else is left.
limited() { (ulimit -f "$1" && shift && exec "$program" "$@" >stdout 2>stderr </dev/null); }
cp b.exr r.exr
before=$(cksum <r.exr)
limited 8 render cornell -o r.exr $image --spp 1
[ $? = 1 ] && one_line "a full disk" && grep -q 'r.exr: .*File too large' stderr || fail "$(cat stderr)"
[ "$(cksum <r.exr)" = "$before" ] || fail "a full disk destroys an earlier image"
limited 8 render cornell -o s.exr $image --spp 1 --resume
[ $? = 1 ] && one_line "a full disk" && [ ! -e s.exr.state ] || fail "half a film: $(cat stderr)"
limited 8 metrics a.exr b.exr --maps full
[ $? = 1 ] && one_line "a full disk" || fail "maps on a full disk: $(cat stderr)"
[ -z "$(find . -name '*.tmp' -o -name '*.part' -o -name '.*.tmp')" ] || fail "a full disk leaves parts"

if [ -c /dev/full ]; then
  "$program" render cornell -o d.exr --resolution 8x8 --spp 1 --quiet --stats /dev/full >stdout 2>stderr
  [ $? = 1 ] && one_line "/dev/full" && grep -q '/dev/full: .*No space left' stderr || fail "$(cat stderr)"
  [ -c /dev/full ] || fail "--stats has replaced a device by a file"
  for arguments in 'metrics a.exr b.exr' 'scenes' 'samplers' 'info cornell' 'info cornell --json' \
    'runs whole' '--help' 'render --help'; do
    "$program" $arguments 2>stderr >/dev/full
    [ $? = 1 ] && one_line "$arguments >/dev/full" || fail "$arguments >/dev/full: $(cat stderr)"
  done
fi

# The same on a file system that is full, where one may be mounted.
on_small_disk() {
  mkdir -p disk
  unshare -rm sh -c 'mount -t tmpfs -o size=96k none disk && cd disk && "$@"; status=$?
    ls -A >../left; [ -e errors/errors.csv ] && cp errors/errors.csv ..; exit $status' sh "$@"
}
if on_small_disk true 2>/dev/null; then
  on_small_disk "$program" render cornell -o r.exr $image --spp 1 >stdout 2>stderr
  [ $? = 1 ] && one_line "a full file system" && grep -q 'No space left' stderr || fail "$(cat stderr)"
  [ -s left ] && fail "a full file system has $(cat left)"
  on_small_disk "$program" compare cornell --samplers random,cpt --spp 1,2 --seeds 100 --quiet \
    --reference-spp 4 --resolution 24x24 --threads 1 -o errors >stdout 2>stderr
  [ $? = 1 ] && one_line "a comparison on a full file system" || fail "$(cat stderr)"
  [ "$(tail -c 1 errors.csv | wc -l)" = 1 ] || fail "errors.csv ends within a row"
fi

finish
