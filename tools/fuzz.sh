#!/usr/bin/env bash
# Runs the fuzzers of tests/fuzz with the address and undefined behaviour sanitizers (needs clang).
#
#   tools/fuzz.sh                    10,000,000 executions of each
#   tools/fuzz.sh 200000             so many
#   tools/fuzz.sh 200000 yaml mcap   of these: telemetry viewer http yaml track map bag log mcap cdr plan
#   tools/fuzz.sh --seconds 60       a minute of each
#
# What they find new stays in build/fuzz/corpus; an input that fails is kept as build/fuzz/NAME-crash-…: mend it, and put it
# into tests/fuzz/corpus/NAME, where ./test.sh reads it again.
set -uo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/usage.sh"
cd "$(dirname "${BASH_SOURCE[0]}")/.." || exit
command -v clang++ >/dev/null || { echo "clang++ is not installed: not fuzzed" >&2; exit 77; }
limit=(-runs=10000000)
case "${1:-}" in
  --seconds) limit=(-max_total_time="$2"); shift 2 ;;
  [0-9]*) limit=(-runs="$1"); shift ;;
esac
names=("$@")
[ $# -gt 0 ] || names=(telemetry viewer http yaml track map bag log mcap cdr plan)

cmake --preset fuzz >/dev/null && cmake --build --preset fuzz --target fuzzers || exit 3
declare -A longest=([telemetry]=8192 [viewer]=4096 [http]=4096 [yaml]=8192 [track]=16384 [map]=16384 [bag]=16384 [log]=8192 [mcap]=65536 [cdr]=2048 [plan]=4096)
failed=()
for name in "${names[@]}"; do
  mkdir -p "build/fuzz/corpus/$name"
  echo "== $name" >&2
  # An input may take a minute under the sanitizers beside other programs (a second without them), and 1 GB.
  "build/fuzz/tests/fuzz/fuzz_$name" "${limit[@]}" -max_len="${longest[$name]}" -timeout=60 -rss_limit_mb=1024 -print_final_stats=1 -verbosity=0 \
    -artifact_prefix="build/fuzz/$name-" "build/fuzz/corpus/$name" "tests/fuzz/corpus/$name" || failed+=("$name")
done
[ ${#failed[@]} -eq 0 ] || { echo "failed: ${failed[*]}" >&2; exit 1; }
