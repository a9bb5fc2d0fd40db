#!/bin/bash
# Many scenes, each a comparison of its own on one machine: no MPI, and no machine waits for another.
#   sbatch --array=0-11 docs/slurm/array.sh EXPERIMENT.toml SCENES.txt DIR [OPTION...]
# SCENES.txt has a scene on each line; task N takes line N + 1 and writes to DIR/N-SCENE. Tasks that
# failed are given again alone (--array=3,7) and go on. `lockstep runs DIR` tells how far all are.
#SBATCH --job-name=lockstep
#SBATCH --nodes=1
#SBATCH --ntasks=1
#SBATCH --exclusive
#SBATCH --time=04:00:00
#SBATCH --requeue
#SBATCH --open-mode=append
set -euo pipefail
[ $# -ge 3 ] || { echo "usage: array.sh EXPERIMENT.toml SCENES.txt DIR [OPTION...]" >&2; exit 2; }
experiment=$1 scenes=$2 folder=$3
shift 3
task=${SLURM_ARRAY_TASK_ID:?submit it with --array}
scene=$(sed -n "$((task + 1))p" "$scenes")
[ -n "$scene" ] || { echo "array.sh: $scenes has no line $((task + 1))" >&2; exit 1; }
name=$(basename "${scene%.*}")
srun -n 1 lockstep compare "$experiment" "$scene" -o "$folder/$task-$name" --resume "$@"
