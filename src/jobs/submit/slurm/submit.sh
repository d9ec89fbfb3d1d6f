#!/bin/bash
# Submits render.sbatch and, for when all its tasks are done, merge.sbatch. Again after a failure it costs little: parts
# that are finished stay. Options of sbatch may be added, as in: submit.sh --partition=NAME
set -euo pipefail

cd "$(dirname "$0")"
if [[ $PWD == *[%\\]* ]]; then
  echo "submit.sh: Slurm cannot write logs below a folder with % or \\ in its name: $PWD" >&2
  exit 1
fi
mkdir -p parts logs # Slurm itself makes no folder, and a job whose log cannot be opened fails without a word.
unset SLURM_RESTART_COUNT # If this runs in a job itself, sbatch would hand that job's down.
array=$(sbatch --parsable "$@" render.sbatch)
array=${array%%;*} # "ID;CLUSTER" where there are several
merge=$(sbatch --parsable --dependency="afterok:$array" --kill-on-invalid-dep=yes "$@" merge.sbatch)
echo "array job $array, then merge job ${merge%%;*}"
