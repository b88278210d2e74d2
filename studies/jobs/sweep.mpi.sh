#!/usr/bin/env bash
# A sweep on the ranks of MPI: each drives its part of the plan into a file of its own, and they say nothing to each other. Further
# words before the plan go to mpirun.
#
#   studies/jobs/sweep.mpi.sh -n 64 --hostfile hosts plan.yaml results.jsonl
#   chicane merge results.*-of-64.jsonl -o results.jsonl
set -euo pipefail
[ $# -ge 2 ] || { sed -n '2,8s/^# \{0,1\}//p' "$0" >&2; exit 2; }
results=${*: -1} plan=${*: -2:1}
exec mpirun "${@:1:$#-2}" "${CHICANE:-chicane}" sweep "$plan" --output "$results" --jobs 1
