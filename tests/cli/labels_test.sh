#!/bin/bash
# Runs the built program where its image is not simply right: samples that are not finite are located,
# clamped images are labelled wherever they go.
# Usage: labels_test.sh PROGRAM
source "$(dirname "$0")/checks.sh"

run() { timeout 60 "$program" "$@" >stdout 2>stderr </dev/null || fail "lockstep $*: $(cat stderr)"; }
has() { grep -aqE -- "$2" "$1" || fail "no '$2' in $1: $(head -c 600 "$1")"; }
lacks() { grep -aqE -- "$2" "$1" && fail "'$2' in $1"; }

# A white wall under so many bright lights that what it sends on leaves float's range.
cat >bright.pbrt <<PBRT
LookAt 0 0 2  0 0 0  0 1 0
Camera "perspective" "float fov" 40
Film "image" "integer xresolution" 8 "integer yresolution" 6
WorldBegin
$(for i in $(seq 16); do
  echo 'LightSource "distant" "point from" [0 0 1] "point to" [0 0 0] "rgb L" [1e38 1e38 1e38]'
done)
Material "matte" "rgb Kd" [1 1 1]
Shape "trianglemesh" "point P" [-1 -1 0  1 -1 0  1 1 0] "integer indices" [0 1 2]
PBRT
run render bright.pbrt -o bright.exr --spp 4 --depth 2 --seed 9 --threads 1 --stats bright.json
grep -oE 'not finite: pixel \([0-9]+, [0-9]+\), sample [0-9]+, seed 9; again with: lockstep render bright.pbrt -o bright.exr --spp 4' stderr >found
[ "$(wc -l <found)" = 8 ] || fail "samples that are not finite: $(cat stderr)"
has stderr '[0-9]+ samples were not finite and were left out'
has bright.json '"nonfinite": [1-9]'
has bright.json '"seed": 9$'
has bright.json '"sample": [0-3]'
has bright.json '"command": "lockstep render bright.pbrt -o bright.exr --spp 4'
run compare bright.pbrt --samplers random,owen --spp 2 --seeds 1 --depth 2 --reference-spp 2 --threads 1 -o out --quiet
has stderr 'bright.pbrt: [0-9]+ samples were not finite'
has stderr 'again with: lockstep render bright.pbrt --depth 2 .*--sampler (random|owen) --spp 2 --seed 0'
has out/summary.json '"nonfinite_samples"'
has out/summary.json '"command": "lockstep render bright.pbrt --depth 2'

# Clamped, and not.
small="--resolution 32x24 --spp 4 --threads 1"
run render cornell -o free.exr $small --stats free.json
lacks free.exr 'clamp'
lacks stdout 'biased'
has free.json '"clamp": null'
has free.json '"clamped": 0'
has free.json '"biased": false'
run render cornell -o clamped.exr $small --stats clamped.json --clamp 0.25
has stdout 'biased: clamped at 0.25: [1-9][0-9]* of 3072 samples'
has clamped.exr 'biased: clamped at 0.25'
has clamped.exr 'clamped_samples'
has clamped.json '"biased": true'
has clamped.json '"bias": "biased: clamped at 0.25"'
has clamped.json '"clamp": 0.25'
has clamped.json '"clamped": [1-9]'
run metrics free.exr clamped.exr
has stdout '^luminance_ratio +0\.[0-9]+'

# A film that was clamped is not continued without it.
run render cornell -o r.exr $small --clamp 0.25 --resume
timeout 60 "$program" render cornell -o r.exr $small --resume 2>stderr && fail "resumes a clamped film"
has stderr 'other settings'

# A comparison is labelled in all that it writes; its reference is not clamped.
run compare cornell --samplers random,owen --spp 2,4 --seeds 1 --reference-spp 16 --resolution 32x24 \
  --threads 1 --clamp 0.25 -o clamped
has stdout 'All renders are biased: clamped at 0.25'
has stderr 'warning: cornell: all renders are biased: clamped at 0.25'
has clamped/summary.json '"clamp": 0.25'
has clamped/summary.json '"clamped": [1-9]'
has clamped/summary.json 'render_command.*--clamp 0.25'
has clamped/experiment.toml '^clamp = 0.25'
has clamped/report.html 'biased: clamped at 0.25'
has clamped/cornell-owen-4spp.exr 'biased: clamped at 0.25'
has clamped/journal.jsonl 'clamped at 0.25'
for reference in clamped/reference-*.exr; do lacks "$reference" 'clamp'; done
run compare clamped/experiment.toml --resume
timeout 60 "$program" compare cornell --samplers random,owen --spp 2,4 --seeds 1 --reference-spp 16 \
  --resolution 32x24 --threads 1 --clamp 0.5 -o clamped --resume >stdout 2>stderr && fail "resumes another clamp"
has stderr 'other conditions'

finish
