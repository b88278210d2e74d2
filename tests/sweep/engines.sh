#!/usr/bin/env bash
# One sweep, driven by what others use to start many processes: the merged results are byte for byte those of one thread.
#
#   engines.sh parallel|mpi|slurm PROGRAM
#
# Exit code 77 (skipped) where the engine is not installed.
set -euo pipefail
engine=$1 program=$(realpath "$2")
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd -P)
cd "$root"
folder=$(mktemp -d)
children=()
cleanup() {
  local child
  for child in "${children[@]}"; do kill "$child" 2>/dev/null || true; done
  wait 2>/dev/null || true
  rm -rf "$folder"
}
trap cleanup EXIT
needs() { command -v "$1" >/dev/null || { echo "$1 is not installed: not tested"; exit 77; }; }
export CHICANE=$program

cat >"$folder/plan.yaml" <<'PLAN'
settings: {laps: 0, time_limit_s: 20, preset: weighted, sensor.position_noise_m: 0.05}
axes:
  - seed: {from: 1, to: 8}
  - latency_ms: {from: 60, to: 120, count: 4}
PLAN
plan=$folder/plan.yaml
unset SLURM_ARRAY_TASK_ID OMPI_COMM_WORLD_RANK PMI_RANK SLURM_PROCID || true
"$program" sweep "$plan" -o "$folder/alone.jsonl" --jobs 1 2>/dev/null
"$program" merge "$folder/alone.jsonl" -o "$folder/expected.jsonl" 2>/dev/null

# Starts part 2 of $1 and kills it as hard as can be once it has driven something.
kill_a_part() {
  "$program" sweep "$plan" -o "$folder/part.jsonl" --shard "2/$1" --jobs 1 2>/dev/null &
  local victim=$! file="$folder/part.2-of-$1.jsonl"
  until [ -s "$file" ] && [ "$(wc -l <"$file")" -ge 2 ]; do kill -0 "$victim" 2>/dev/null || break; sleep 0.01; done
  kill -9 "$victim" 2>/dev/null || true
  wait "$victim" 2>/dev/null || true
  printf '{"run":1,"settings' >>"$file"  # and was writing a line
}

compare() {
  "$program" merge "$folder"/part.*-of-*.jsonl -o "$folder/merged.jsonl"
  cmp "$folder/expected.jsonl" "$folder/merged.jsonl"
  echo "$engine: the same bytes"
}

case $engine in
  parallel)
    needs parallel
    kill_a_part 7
    parallel --will-cite --jobs 2 "$program" sweep "$plan" -o "$folder/part.jsonl" --jobs 1 --shard '{}/7' ::: 1 2 3 4 5 6 7
    ;;
  mpi)
    needs mpirun
    kill_a_part 3
    [ "$(id -u)" -ne 0 ] || export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
    studies/jobs/sweep.mpi.sh --oversubscribe -n 3 "$plan" "$folder/part.jsonl"
    ;;
  slurm)
    needs sbatch; needs slurmctld; needs slurmd; needs munged
    kill_a_part 5
    "$root/tests/sweep/slurm_node.sh" "$folder/slurm" >"$folder/node.log" 2>&1 &
    children+=($!)
    export SLURM_CONF=$folder/slurm/slurm.conf
    for _ in $(seq 300); do
      sinfo -h -o %T 2>/dev/null | grep -q idle && break
      sleep 0.2
    done
    sbatch --wait --array=1-5 --output="$folder/slurm/%a.log" studies/jobs/sweep.sbatch "$plan" "$folder/part.jsonl" || { cat "$folder"/slurm/*.log; exit 1; }
    # And the tasks of a step.
    srun --overcommit --ntasks=3 "$program" sweep "$plan" -o "$folder/step.jsonl" --jobs 1 2>/dev/null
    "$program" merge "$folder"/step.*-of-3.jsonl -o "$folder/step.jsonl"
    cmp "$folder/expected.jsonl" "$folder/step.jsonl"
    ;;
esac
compare
