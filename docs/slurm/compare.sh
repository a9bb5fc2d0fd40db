#!/bin/bash
# One comparison on several machines, one rank on each.
#   sbatch --nodes=8 docs/slurm/compare.sh EXPERIMENT.toml DIR [OPTION...]
# DIR lies where all machines see it. A job that ran out of its time, or lost a machine, goes on
# from where it was when the same line is given again.
#SBATCH --job-name=lockstep
#SBATCH --nodes=2
#SBATCH --ntasks-per-node=1
#SBATCH --exclusive
#SBATCH --time=04:00:00
#SBATCH --requeue
#SBATCH --open-mode=append
set -euo pipefail
[ $# -ge 2 ] || { echo "usage: compare.sh EXPERIMENT.toml DIR [OPTION...]" >&2; exit 2; }
experiment=$1 folder=$2
shift 2
srun --mpi=pmix --cpu-bind=none lockstep compare "$experiment" -o "$folder" --resume "$@"
