#!/usr/bin/env bash
# The table of docs/tracking.md: flying laps of the default preset with both cars on all tracks. Usage: tools/lap_table.sh [chicane options]
set -euo pipefail
cd "$(dirname "$0")/.."
program=${CHICANE:-build/release/apps/chicane/chicane}
tracks=(lakeside ../shared/tracks/udacity/lake_scene.csv oval hairpins speedway)
printf '%-16s %-9s %9s %8s %10s %6s\n' track car 'lap [s]' 'top mph' 'edge [m]' off
for track in "${tracks[@]}"; do
  if [[ $track == */* && ! -f $track ]]; then
    echo "$track: not here, skipped"
    continue
  fi
  for car in udacity road-car; do
    "$program" drive --fast --car "$car" --track "$track" --laps 3 --json "$@" 2>/dev/null |
      python3 -c '
import json, sys
run = json.load(sys.stdin)
laps = run["laps"]
print("%-16s %-9s %9.2f %8.1f %10.2f %6d" % (
    run["track"], run["car"], laps[-1]["lap_time_s"] if laps else float("nan"),
    max((lap["top_speed_mph"] for lap in laps), default=float("nan")),
    min((lap["min_edge_distance_m"] for lap in laps), default=float("nan")), run["off_track_events"]))' || true
  done
done
