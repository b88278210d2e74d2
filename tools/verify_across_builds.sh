#!/usr/bin/env bash
# Records runs with each of several builds of the program and verifies each recording with all builds: compilers and build
# types compute the same bits. The last line has the counts.
#
#   tools/verify_across_builds.sh build/gcc/apps/chicane/chicane build/clang/apps/chicane/chicane ...
#
# Exit code 1 when any step of any recording differs in any build, or was not computed again.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/usage.sh"
if [ $# -lt 1 ]; then
  sed -n '2,7s/^# \{0,1\}//p' "$0" >&2
  exit 2
fi

runs=(
  "--preset default"
  "--preset measured-latency"
  "--preset weighted"
  "--preset stanley"
  "--preset default --car road-car --set sensor.position_noise_m=0.05"
)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

builds=("$@")
for i in "${!builds[@]}"; do
  for j in "${!runs[@]}"; do
    # Exit code 1 says that the lap was not finished, or not clean; only the recording is used here.
    # shellcheck disable=SC2086  # the options are words
    "${builds[$i]}" drive --fast --laps 1 --set time_limit_s=40 ${runs[$j]} --record "$folder/$i-$j.mcap" >"$folder/out" 2>&1 ||
      [ $? -eq 1 ] || { cat "$folder/out" >&2; exit 1; }
  done
done

status=0 verifications=0 steps=0 identical=0
for recorder in "${!builds[@]}"; do
  for verifier in "${!builds[@]}"; do
    for j in "${!runs[@]}"; do
      result=$("${builds[$verifier]}" replay "$folder/$recorder-$j.mcap" --verify) || status=1
      printf '%s, recorded by %s, verified by %s: %s\n' "${runs[$j]}" "${builds[$recorder]}" "${builds[$verifier]}" \
        "$(head -n 1 <<<"$result")"
      if [[ $result =~ ([0-9]+)\ of\ ([0-9]+)\ commands ]]; then
        identical=$((identical + BASH_REMATCH[1])) steps=$((steps + BASH_REMATCH[2]))
      else
        status=1
      fi
      verifications=$((verifications + 1))
    done
  done
done
printf '%d builds, %d runs, %d verifications: %d of %d steps identical\n' "${#builds[@]}" "${#runs[@]}" "$verifications" "$identical" "$steps"
exit $status
