#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Prints the tables of docs/measured/limit.md in Markdown: bound and witness of two cars on four tracks, and the laps of `race` and `default`.

    studies/tables/limit_tables.py --compute > limits.jsonl          drives `chicane limit` for each (two minutes)
    studies/tables/limit_tables.py limits.jsonl                      table 1
    studies/tables/limit_tables.py limits.jsonl runs.jsonl           table 2; runs: results of studies/plans/racing.yaml

tools/check_figures compares them with the page, and writes them. The program is `chicane` on the path."""
import argparse
import json
import subprocess
import sys
from pathlib import Path

CARS = ("udacity", "road-car")
TRACKS = ("lakeside", "oval", "hairpins", "speedway")


def limit(car, track):
    done = subprocess.run(["chicane", "limit", "--car", car, "--track", track, "--json"], check=True, capture_output=True, text=True)
    return json.loads(done.stdout)


def compute():
    for car in CARS:
        for track in TRACKS:
            found = limit(car, track)
            print(json.dumps({"car": car, "track": track, "bound": found["lap_time_s"], "witness": found["witness"]["lap_time_s"],
                              "bracket": found["bracket_percent"]}), flush=True)


def lines_of(path):
    return [json.loads(line) for line in Path(path).read_text(encoding="utf-8").splitlines()]


def bounds(limits):
    print("| car | track | bound | witness | bracket |\n|---|---|--:|--:|--:|")
    for row in limits:
        print(f"| {row['car']} | {row['track']} | {row['bound']:.3f} | {row['witness']:.3f} | {row['bracket']:.2f} % |")


def gaps(limits, runs):
    laps = {tuple(run["settings"][key] for key in ("car", "track", "preset")): run["lap_time_s"] for run in runs
            if "run" in run and run["settings"]["guard.mode"] == "on"}
    print("| car | track | bound | `race` | gap | `default` | gap |\n|---|---|--:|--:|--:|--:|--:|")
    for row in limits:
        found = [laps[row["car"], row["track"], preset] for preset in ("race", "default")]
        cells = " | ".join(f"{lap:.2f} | {100.0 * (lap / row['bound'] - 1.0):.1f} %" for lap in found)
        print(f"| {row['car']} | {row['track']} | {row['bound']:.2f} | {cells} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("limits", nargs="?", help="what --compute has printed")
    parser.add_argument("runs", nargs="?", help="results of studies/plans/racing.yaml")
    parser.add_argument("--compute", action="store_true")
    options = parser.parse_args()
    if options.compute == bool(options.limits):
        parser.error("expected --compute, or its results")
    if options.compute:
        compute()
    elif options.runs:
        gaps(lines_of(options.limits), lines_of(options.runs))
    else:
        bounds(lines_of(options.limits))
    return 0


if __name__ == "__main__":
    sys.exit(main())
