#!/usr/bin/env bash
# A batch as an array job of Slurm. Each task runs its share of the manifest, and all write one folder.
#
#     job=$(sbatch --parsable --array=1-16 slurm.sh MANIFEST PIPELINE FOLDER [OPTION OF toile batch...])
#     sbatch --dependency=afterany:$job slurm.sh MANIFEST PIPELINE FOLDER [THE SAME OPTIONS...]
#
# The second job has no array, and so the whole manifest: it runs what a lost task left and writes the results of all.
# Take as many tasks as give each some hundreds of garments. Numbers of the array follow each other (1-16, 0-15).
#SBATCH --job-name=toile
#SBATCH --cpus-per-task=8
#SBATCH --mem=16G
#SBATCH --time=04:00:00
# A minute before the time is over the program is told to stop. What is done by then is kept.
#SBATCH --signal=TERM@60
# A task whose node goes down is started again, and goes on where it was.
#SBATCH --requeue
#SBATCH --open-mode=append
set -euo pipefail

manifest=$1 pipeline=$2 folder=$3
shift 3

share=()
if [ -n "${SLURM_ARRAY_TASK_ID:-}" ]; then
    share=(--shard "$((SLURM_ARRAY_TASK_ID - SLURM_ARRAY_TASK_MIN + 1))/$SLURM_ARRAY_TASK_COUNT")
fi
memory=()
if [ -n "${SLURM_MEM_PER_NODE:-}" ]; then
    memory=(--memory "$((SLURM_MEM_PER_NODE * 9 / 10)) MB")
fi

code=0
srun --ntasks=1 --cpus-per-task="$SLURM_CPUS_PER_TASK" \
    toile batch "$manifest" --pipeline "$pipeline" --out "$folder" --jobs "$SLURM_CPUS_PER_TASK" \
    "${share[@]}" "${memory[@]}" "$@" || code=$?
# 4: some garments have a fault. That is a result, and no reason to run the task again.
if [ "$code" -eq 4 ]; then code=0; fi
exit "$code"
