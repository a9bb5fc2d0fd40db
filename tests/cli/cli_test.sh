#!/bin/bash
# Runs the built program as a user would: exit statuses, messages and files.
# Usage: cli_test.sh PROGRAM
source "$(dirname "$0")/checks.sh"

# expect STATUS PATTERN ARGUMENT...: runs the program; its stderr (stdout when it succeeds) has
# PATTERN, and an error is one line that begins with the program's name.
expect() {
  local status=$1 pattern=$2 got
  shift 2
  "$program" "$@" >stdout 2>stderr </dev/null
  got=$?
  [ "$got" = "$status" ] || fail "status $got instead of $status: lockstep $* ($(head -c 300 stderr))"
  if [ "$status" = 0 ]; then
    [ -z "$pattern" ] || grep -qE -- "$pattern" stdout || fail "no '$pattern' in the output of: lockstep $*"
  else
    [ "$(grep -vc warning: stderr)" = 1 ] || fail "not one line: lockstep $*: $(cat stderr)"
    grep -qE -- "^lockstep: .*$pattern" stderr || fail "no '$pattern': lockstep $*: $(cat stderr)"
  fi
}

# has FILE PATTERN
has() { grep -qE -- "$2" "$1" || fail "no '$2' in $1"; }

small="--resolution 32x24 --spp 4 --quiet"

# Help and lists.
expect 0 'lockstep [0-9]+\.[0-9]+' --version
expect 0 'compare' --help
for command in render compare demo stress metrics info scenes samplers; do
  expect 0 'Usage: lockstep' "$command" --help
done
expect 0 '^cornell ' scenes
expect 0 'rcs' samplers

# Wrong usage: status 2.
expect 2 'subcommand'
expect 2 "unknown subcommand 'frobnicate'" frobnicate
expect 2 'unknown|not expected' render cornell -o a.exr --bogus
expect 2 'output' render cornell
expect 2 'SCENE' render -o a.exr
expect 2 'spp' render cornell -o a.exr --spp 0
expect 2 'spp' render cornell -o a.exr --spp many
expect 2 'time' render cornell -o a.exr --time -1
expect 2 'excludes' render cornell -o a.exr --spp 4 --time 1
expect 2 'resolution' render cornell -o a.exr --resolution 0x5
expect 2 'resolution' render cornell -o a.exr --resolution 5
expect 2 'width' render cornell -o a.exr --width 3
expect 2 'isa' render cornell -o a.exr --isa z80
expect 2 'lane' render cornell -o a.exr --lanes 3x5
expect 2 'nosuch' render cornell -o a.exr --sampler nosuch
expect 2 'exr' render cornell -o a.text
expect 2 'weight map' render cornell -o a.exr --weights w.exr
expect 2 'samplers' compare cornell -o out
expect 2 'twice' compare cornell --samplers random,random -o out
expect 2 'spp' compare cornell --samplers random --spp 4,x -o out
expect 2 'TEST' metrics a.exr
expect 2 'SCENE' info
expect 2 'camera.*origin takes three numbers' render cornell -o a.exr --camera origin=1,2
expect 2 "camera.*no 'eye'" profile cornell -o prof --camera eye=0,0,0
expect 2 'camera.*fov' compare cornell --samplers random --camera fov=0 -o out
expect 2 'target 0,1,3.6 is where the camera is' render cornell -o a.exr --camera target=0,1,3.6
expect 2 'environment.*0 or more' render cornell -o a.exr --environment -1,0,0
expect 2 'environment-scale' render cornell -o a.exr --environment-scale -1
expect 2 'no environment' render cornell -o a.exr --environment-scale 2

# Failures while running: status 1, before anything is rendered.
expect 1 'nosuch.pbrt' render nosuch.pbrt -o a.exr
expect 1 'nosuch.pbrt' info nosuch.pbrt
expect 1 'nosuch.json' render cornell -o a.exr --camera nosuch.json
expect 1 'nosuch.exr' render cornell -o a.exr --environment nosuch.exr
expect 1 'missing' render cornell -o missing/a.exr
expect 1 'missing' render cornell -o a.exr --stats missing/a.json
expect 1 'a.exr' metrics a.exr b.exr
[ -e a.exr ] && fail "a failed run left a.exr"

# A render, its statistics and its weight map.
expect 0 '' render cornell -o a.exr $small --sampler rcs --seed 3 --stats a.json --weights w.exr
for key in scene sampler width isa threads seed spp depth resolution render_seconds cpu_seconds \
  paths rays camera bounce shadow paths_per_cpu_second lanes_active nonfinite nonfinite_samples features left_out \
  peak_memory_bytes version embree_version lanes pilot_spp mean_weight zero_weights biased traversal packets \
  stage_cpu_seconds sampling film memory_bytes geometry embree; do
  has a.json "\"$key\": "
done
has a.json '"seed": 3'
[ -s w.exr ] || fail "no weight map"
expect 0 'Mpaths' render cornell -o b.exr --resolution 32x24 --spp 2
expect 0 '' render cornell -o c.exr --resolution 16x24 --spp 2 --quiet
expect 0 '' render cornell -o t.exr --resolution 32x24 --time 0.2 --quiet

# How rays are traced, and by which kernels, does not change the image.
for how in '--traversal single' '--traversal packet8-coherent' '--traversal streamnm' --general; do
  expect 0 '' render cornell -o d.exr --resolution 32x24 --spp 2 --quiet $how
  expect 0 '^rmse +0$' metrics b.exr d.exr
done
expect 2 'packet4' render cornell -o d.exr --traversal packet3

# What a scene consists of.
expect 0 '^  triangles +36  72 vertices$' info cornell
expect 0 '^  as --camera +origin=0,1,3.6:target=0,1,' info cornell
expect 0 '"triangles": 36,' info cornell --json

# Another camera and environment. The scene's own camera gives the scene's image.
own=$("$program" info cornell | sed -n 's/^  as --camera *//p')
echo '{"origin": [0, 1, 3.6], "target": [0, 1, 0]}' >view.json
for camera in "$own" view.json; do
  expect 0 '' render cornell -o d.exr --resolution 32x24 --spp 2 --quiet --camera "$camera"
  expect 0 '^rmse +(0|[0-9.]+e-0[3-9]|0\.00[0-9]+)$' metrics b.exr d.exr
done
expect 0 '' render cornell -o d.exr $small --camera origin=0.5,1,3:fov=30 --stats d.json \
  --environment 0.5,0.5,1 --environment-scale 0.5 --resume
has d.json '"camera": "origin=0.5,1,3:fov=30"'
has d.json '"environment": "0.5,0.5,1"'
has d.json '"environment_scale": "0.5"'
grep -aq 'origin=0.5,1,3:fov=30' d.exr || fail "the image's header lacks its camera"
for change in '--camera origin=0.5,1,3:fov=31' '--environment none'; do
  expect 1 'other settings|d.exr.state' render cornell -o d.exr $small --resume $change
done

# A profile.
expect 2 'no weight' profile cornell -o prof --sampler owen
expect 2 '0 to 1' profile cornell -o prof --weights 0,2
expect 2 "'4:' is no map" profile cornell -o prof --maps 4:
expect 0 'best mode' profile cornell -o prof --weights 0,1 --maps 4:0.02 --lanes 4x4x1,1x1x16 --spp 2 \
  --depth 2 --repeats 1 --reference-spp 4 --seeds 1 --resolution 32x24 --quiet
has prof/profile.csv '^cornell,rcs,1,1x1x16,bounce,1,single,'
has prof/profile.csv '^cornell,rcs,0,4x4x1,shadow,0,auto,'
[ "$(wc -l <prof/renders.csv)" = 7 ] || fail "renders.csv has $(wc -l <prof/renders.csv) lines, not 7"
has prof/coherence.csv '^cornell,rcs,c=4 t=0.02,4x4x1,bounce,1,'
has prof/errors.csv '^cornell,rcs,0,equal_time,'
has prof/profile.html 'id="data"'

# A viewer that is not there is one warning.
expect 2 'no port' render cornell -o v.exr --display localhost:x
expect 0 'v.exr: 1 spp' render cornell -o v.exr --spp 1 --resolution 8x8 --display 127.0.0.1:1
[ "$(grep -c 'warning: --display' stderr)" = 1 ] || fail "--display: $(cat stderr)"

# Extreme cases.
expect 2 'output' stress
expect 2 'no case matches' stress -o stress --case nosuch
expect 0 'no-light' stress --list
expect 0 '2 cases: 1 right, 1 unsupported, 0 vague, 0 wrong' stress -o stress --quick --quiet \
  --case 'no*light' --threads 2
has stress/stress.csv '^no-light,light,[^,]+,16,strata,0,0,'
has stress/stress.html 'nothing to render'

# Metrics.
expect 0 '^rmse +0$' metrics a.exr a.exr
expect 0 '"relmse_trimmed": ' metrics a.exr b.exr --json
expect 0 '"spectrum": ' metrics a.exr b.exr --json --maps maps
for map in flip_ldr.png flip_hdr.png flip_hdr_exposure.png yee.png error.exr; do
  [ -s "maps/$map" ] || fail "no maps/$map"
done
expect 0 '^luminance_ratio +1$' metrics a.exr a.exr
expect 1 '32x24.*16x24' metrics a.exr c.exr

# A comparison.
expect 0 'report.html' compare cornell --samplers 'random,rcs:c=2,t=0.01,cpt' --spp 2,8 --seeds 2 \
  --reference-spp 32 --resolution 32x24 -o out --quiet
[ "$(wc -l <out/errors.csv)" = 13 ] || fail "errors.csv has $(wc -l <out/errors.csv) lines, not 13"
has out/errors.csv '^scene,sampler,seed,spp,cpu_seconds,wall_seconds,rmse,relmse,relmse_trimmed'
has out/errors.csv '^cornell,"rcs:c=2,t=0.01",1,8,'
has out/spectra.csv '^cornell,[0-9]+,random,8,'
has out/summary.json '"verdicts"'
has out/summary.json '"equal_time"'
has out/report.html 'cornell-reference.png'

# A comparison that is killed at any moment goes on with --resume, to the same errors and images.
again="compare cornell --samplers random,cpt --spp 1,2,4 --seeds 3 --reference-spp 64 --resolution 24x24
  --threads 1 --timing-repeats 0 --quiet"
untimed() { cut -d, -f1-4,7-20,23 "$1/errors.csv"; }
expect 0 '' $again -o whole
for delay in 0.05 0.15 0.3 0.6; do
  "$program" $again -o killed --resume >/dev/null 2>&1 &
  sleep $delay
  kill -KILL $! 2>/dev/null
  wait $! 2>/dev/null
done
expect 0 '' $again -o killed --resume
[ "$(untimed killed)" = "$(untimed whole)" ] || fail "a killed comparison has other errors"
for file in spectra.csv cornell-random-4spp.png cornell-cpt-1spp.png cornell-reference.png; do
  cmp -s killed/$file whole/$file || fail "a killed comparison has another $file"
done

# A signal finishes the render under way, writes the report and says how to go on.
"$program" compare cornell --samplers random,cpt --spp 1,2,4 --seeds 10000 --reference-spp 64 \
  --resolution 24x24 --quiet -o signal >stdout 2>stderr &
for i in $(seq 200); do
  [ -s signal/errors.csv ] && [ "$(wc -l <signal/errors.csv)" -gt 3 ] && break
  sleep 0.1
done
kill -INT $!
wait $!
[ $? = 1 ] || fail "an interrupted comparison does not end with status 1"
grep -q '^lockstep: stopped by the user; .*--resume' stderr || fail "interrupted: $(cat stderr)"
has signal/summary.json '"complete": false'
has signal/report.html 'cornell-reference.png'
expect 0 'signal .* stopped +[0-9]+/60000 +cornell: random,cpt' runs .
expect 0 '"state": "complete"' runs whole --json
expect 1 'nosuch' runs nosuch

# A disk that is full: one error, and what was written stays.
(ulimit -f 24 && "$program" $again -o full >stdout 2>stderr)
[ $? = 1 ] || fail "a full disk does not end with status 1"
grep -q "journal.jsonl: cannot be written: File too large" stderr || fail "a full disk: $(cat stderr)"
[ "$(wc -l <stderr)" = 1 ] || fail "a full disk is not one line: $(cat stderr)"
expect 0 '' $again -o full --resume
[ "$(untimed full)" = "$(untimed whole)" ] || fail "a comparison on a full disk has other errors"

# Experiments as files: the command line overrides them, mistakes have their line.
cat >e.toml <<'TOML'
scenes = "cornell"
samplers = ["random", "cpt"]
spp = [1, 4]
seeds = 2
resolution = "24x24"
reference_spp = 64
time_budgets = [1e-9]
quiet = true
output = "toml"
TOML
expect 0 'nothing is extrapolated' compare e.toml --seeds 1
[ "$(wc -l <toml/errors.csv)" = 5 ] || fail "the command line does not override the file"
has toml/experiment.toml '^seeds = 1$'
has toml/summary.json 'spp = \[1, 4\]'
expect 0 '' compare toml/experiment.toml --resume
for mistake in 'sede = 4:no key .sede.' 'seeds = 0:not a whole number from 1' 'seeds = "x":a number is expected' \
  'threads = 1.5:threads' 'samplers = 4:text in quotes' 'spp = [1,:error|expected|end'; do
  { echo; echo "${mistake%%:*}"; } >bad.toml
  expect 1 "bad.toml:[2-4]: .*(${mistake#*:})" compare bad.toml -o bad
done
expect 1 'none.toml' compare none.toml
expect 1 'none.pbrt.*--scenes-dir' compare none.pbrt --samplers random -o bad --scenes-dir .
expect 2 'flip_ldr' compare cornell --samplers random -o bad --targets nosuch=1
expect 2 'targets' compare cornell --samplers random -o bad --targets rmse
expect 2 'time-budgets' compare cornell --samplers random -o bad --time-budgets 1,-2
expect 2 'depth' compare cornell --samplers random -o bad --depth 1,x
expect 2 'SCENE' compare --samplers random -o bad
expect 2 'output' compare cornell --samplers random
[ -e bad ] && fail "a mistake left a folder"

finish
