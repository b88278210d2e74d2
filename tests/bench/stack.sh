#!/usr/bin/env bash
# chicane-stack: a run with solve times that were recorded is the same bit for bit, and other times are another run.
#
#   stack.sh PROGRAM FOLDER
set -euo pipefail
program=$1 folder=$2
mkdir -p "$folder"
run() { "$program" --preset sixty-mph --set time_limit_s=6 "$@" || [ $? -eq 1 ]; }  # 1: no lap in 6 s
hash_of() { sed -E 's/.*"state_hash":"([0-9a-f]{16})".*/\1/'; }
recorded=$(run --record "$folder/times.txt" | hash_of)
replayed=$(run --times "$folder/times.txt" | hash_of)
yes 0.08 | head -n 100 >"$folder/slow.txt" || true
slow=$(run --times "$folder/slow.txt" | hash_of)
[ "$recorded" = "$replayed" ] || { echo "not the same run: $recorded, $replayed" >&2; exit 1; }
[ "$recorded" != "$slow" ] || { echo "80 ms for each solve make no difference" >&2; exit 1; }
[ "$(wc -l <"$folder/times.txt")" -gt 20 ]
if "$program" --preset sixty-mph 2>/dev/null; then echo "took no file" >&2; exit 1; fi
if "$program" --times "$folder/none" 2>/dev/null; then echo "took a file that is not there" >&2; exit 1; fi
