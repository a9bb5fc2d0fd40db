#!/bin/bash
# One image on several machines, one rank on each.
#   sbatch --nodes=8 docs/slurm/render.sh SCENE IMAGE.exr [OPTION...]
# The film is kept beside the image; the same line goes on from there.
#SBATCH --job-name=lockstep
#SBATCH --nodes=2
#SBATCH --ntasks-per-node=1
#SBATCH --exclusive
#SBATCH --time=04:00:00
#SBATCH --requeue
#SBATCH --open-mode=append
set -euo pipefail
[ $# -ge 2 ] || { echo "usage: render.sh SCENE IMAGE.exr [OPTION...]" >&2; exit 2; }
scene=$1 image=$2
shift 2
srun --mpi=pmix --cpu-bind=none lockstep render "$scene" -o "$image" --resume "$@"
