#!/bin/bash
# Runs the built program on 2 and 4 ranks: bytes are those of one process, and what was measured
# stays when ranks are killed or stop answering. The job scripts of docs/slurm are run with a
# stand-in for srun.
# Usage: mpi_test.sh PROGRAM
slurm=$(cd "$(dirname "$0")/../../docs/slurm" && pwd)
source "$(dirname "$0")/checks.sh"

command -v mpirun >/dev/null || { echo "skipped: no mpirun"; exit 77; }
export OMPI_MCA_rmaps_base_oversubscribe=1 OMPI_MCA_btl_vader_single_copy_mechanism=none
[ "$(id -u)" = 0 ] && export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
timeout 60 mpirun -n 2 --bind-to none "$program" scenes >stdout 2>stderr && fail "scenes on 2 ranks"
if grep -q 'compiled without MPI\|is for one process' stderr; then
  timeout 60 mpirun -n 2 --bind-to none "$program" render cornell -o t.exr --resolution 8x8 --spp 1 \
    --quiet >stdout 2>stderr
  if grep -q 'compiled without MPI' stderr; then echo "skipped: compiled without MPI"; exit 77; fi
else
  echo "skipped: mpirun does not start here: $(head -c 300 stderr)"
  exit 77
fi

ranks() { local n=$1; shift; timeout 120 mpirun -n "$n" --bind-to none "$program" "$@"; }

# same_pixels A B: but for the header, whose times differ.
same_pixels() {
  local size; size=$(($(stat -c %s "$1") - 4000))
  [ "$size" -gt 20000 ] || fail "$1 is too small to compare"
  cmp -s <(tail -c $size "$1") <(tail -c $size "$2")
}

# Pilots and images of more than one block of samples, weights, and a film that begins within one.
for sampler in rcs:pilot=70 zsobol; do
  image="render cornell --resolution 150x110 --spp 150 --seed 3 --depth 3 --threads 1 --sampler $sampler"
  "$program" $image -o one.exr --quiet || fail "render"
  for n in 2 4; do
    ranks $n $image -o many.exr --stats stats.json --quiet || fail "render on $n ranks"
    same_pixels one.exr many.exr || fail "$sampler: $n ranks give another image"
    grep -q "\"ranks\": $n" stats.json || fail "no ranks in the statistics"
  done
done
image="render cornell --resolution 150x110 --seed 3 --threads 1 --sampler owen --quiet"
ranks 2 $image --spp 40 -o many.exr --resume || fail "render, first part"
ranks 4 $image --spp 150 -o many.exr --resume || fail "render, second part"
"$program" $image --spp 150 -o one.exr || fail "render"
same_pixels one.exr many.exr || fail "a render in two parts is another"
ranks 2 $image --time 0.5 -o many.exr || fail "render for a time"

# What is wrong is said once.
ranks 3 render cornell -o x.exr --spp 0 2>stderr && fail "renders no samples"
[ "$(grep -c '^lockstep: ' stderr)" = 1 ] || fail "not one line: $(cat stderr)"
ranks 2 render nowhere.pbrt -o x.exr 2>stderr && fail "renders a scene that is not there"
grep -q '^lockstep: .*nowhere.pbrt' stderr || fail "$(cat stderr)"

compare="compare cornell --samplers random,owen,rcs --spp 2,8 --reference-spp 200 --depth 1,3
  --resolution 96x72 --threads 1 --timing-spread 0 --quiet"
again="$compare --seeds 4 --timing-repeats 1"
"$program" $again -o one >/dev/null || fail "compare"
# All that does not depend on time.
untimed() { cut -d, -f1-4,7-20,23 "$1/errors.csv"; }
same_results() {
  [ "$(untimed "$1")" = "$(untimed one)" ] || fail "$1: other errors"
  cmp "$1/spectra.csv" one/spectra.csv || fail "$1: other spectra"
  for file in one/*.png one/reference-*.exr; do
    cmp "$file" "$1/${file#one/}" || fail "$1: another ${file#one/}"
  done
  for file in one/cornell-*spp.exr; do
    same_pixels "$file" "$1/${file#one/}" || fail "$1: another ${file#one/}"
  done
  [ "$(grep -c '"repeat"' "$1/journal.jsonl")" = "$(grep -c '"repeat"' one/journal.jsonl)" ] ||
    fail "$1: other repeats"
}
for n in 2 4; do
  ranks $n $again -o many$n >/dev/null || fail "compare on $n ranks"
  same_results many$n
done
grep -q '"ranks":4' many4/journal.jsonl || fail "the journal does not know the ranks"

# in_the_middle FOLDER: begins a comparison on 3 ranks, and waits until it has measured some.
in_the_middle() {
  ranks 3 $again -o "$1" --rank-timeout 2 >stdout 2>stderr &
  launcher=$!
  for i in $(seq 600); do
    [ "$(grep -c '"run"' "$1/journal.jsonl" 2>/dev/null)" -ge 4 ] 2>/dev/null && break
    sleep 0.05
  done
}
# pid_of RANK: of that launcher's.
pid_of() {
  local pid
  for pid in $(pgrep -x "$(basename "$program" | head -c 15)"); do
    tr '\0' '\n' <"/proc/$pid/environ" 2>/dev/null | grep -qx "OMPI_COMM_WORLD_RANK=$1" &&
      tr '\0' '\n' <"/proc/$pid/environ" | grep -qx "PWD=$folder" && echo "$pid"
  done | head -1
}
again="$compare --seeds 8 --timing-repeats 0"
"$program" $again -o one >/dev/null || fail "compare"

# A rank is killed, the one that keeps the journal, too: the rest is done when it is run again.
for victim in 2 0; do
  in_the_middle killed$victim
  kill -KILL "$(pid_of $victim)" || fail "no rank $victim"
  wait $launcher && fail "a killed rank $victim is no failure"
  grep '"run"' killed$victim/journal.jsonl >before
  [ "$(wc -l <before)" -ge 4 ] && [ "$(wc -l <before)" -lt 96 ] || fail "killed after $(wc -l <before)"
  ranks 2 $again -o killed$victim --resume >/dev/null || fail "does not go on"
  same_results killed$victim
  grep '"run"' killed$victim/journal.jsonl | head -$(wc -l <before) | cmp -s - before ||
    fail "what was measured has changed"
done

# A rank hangs: the others do its work, and the end says so.
in_the_middle hung
hung=$(pid_of 1)
kill -STOP "$hung" || fail "no rank 1"
wait $launcher && fail "a rank that hangs is no failure"
grep -q 'rank 1 .* has sent nothing .* others get its work' stderr || fail "$(cat stderr)"
grep -q 'all results are written, but rank 1 .* did not answer' stderr || fail "$(cat stderr)"
kill -KILL "$hung" 2>/dev/null
same_results hung

# A render that is killed goes on from its state.
image="render cornell --resolution 300x220 --seed 3 --spp 192 --threads 1 --sampler owen --quiet"
ranks 3 $image -o killed.exr --resume 2>stderr &
launcher=$!
for i in $(seq 600); do [ -e killed.exr.state ] && break; sleep 0.05; done
kill -KILL "$(pid_of 1)" || fail "no rank 1"
wait $launcher && fail "a killed rank is no failure"
ranks 2 $image -o killed.exr --resume || fail "does not go on"
"$program" $image -o one.exr || fail "render"
same_pixels killed.exr one.exr || fail "a render that was killed is another"

# Job scripts.
mkdir bin
cat >bin/srun <<'SRUN'
#!/bin/bash
# As srun within a job: as many tasks as the job has, or as -n says.
tasks=${SLURM_NTASKS:-1}
while [ "${1#-}" != "$1" ]; do
  case $1 in
    -n) tasks=$2; shift 2 ;;
    --*) shift ;;
    *) echo "srun: $1 is not known here" >&2; exit 1 ;;
  esac
done
[ "$tasks" = 1 ] && exec "$@"
exec mpirun -n "$tasks" --bind-to none "$@"
SRUN
chmod +x bin/srun
ln -s "$program" bin/lockstep
cat >experiment.toml <<'TOML'
scenes = ["cornell"]
samplers = ["random", "owen"]
spp = [2, 4]
seeds = 2
reference_spp = 16
resolution = "24x24"
threads = 1
quiet = true
TOML
for script in "$slurm"/*.sh; do bash -n "$script" || fail "$script"; done
in_job() { env PATH="$folder/bin:$PATH" "$@" >stdout 2>stderr; }
in_job SLURM_NTASKS=2 bash "$slurm/compare.sh" experiment.toml job || fail "compare.sh: $(cat stderr)"
grep -q '"ranks":2' job/journal.jsonl && [ -s job/report.html ] || fail "compare.sh: no report"
in_job SLURM_NTASKS=2 bash "$slurm/render.sh" cornell job.exr --spp 4 --resolution 32x32 ||
  fail "render.sh: $(cat stderr)"
[ -s job.exr ] || fail "render.sh: no image"
printf 'cornell\nmeadow\n' >scenes.txt
for task in 0 1; do
  in_job SLURM_ARRAY_TASK_ID=$task bash "$slurm/array.sh" experiment.toml scenes.txt jobs ||
    fail "array.sh: $(cat stderr)"
done
[ -s jobs/0-cornell/report.html ] && [ -s jobs/1-meadow/report.html ] || fail "array.sh: $(ls jobs)"
in_job SLURM_ARRAY_TASK_ID=2 bash "$slurm/array.sh" experiment.toml scenes.txt jobs &&
  fail "array.sh: a scene too many"

finish
