#!/usr/bin/env python3
"""Drives the laps of README's table of numbers and writes it. All runs are in virtual time: the same on every machine with the same arithmetic.

    tools/measure.py [PROGRAM]          writes the table between the markers in README.md
    tools/measure.py --check [PROGRAM]  compares; exit code 1 and the lines that differ when the table is out of date

PROGRAM is build/release/apps/chicane/chicane when left out.
"""
import json
import os
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
BEGIN, END = "<!-- numbers: tools/measure.py -->\n", "<!-- /numbers -->\n"
PRESETS = ("measured-latency", "fast-short-step", "sixty-mph", "weighted", "delay-in-model", "pid", "pure-pursuit", "stanley")
RUNS = [
    *(("udacity", "lakeside", preset) for preset in ("default", *PRESETS)),
    *(("udacity", track, "default") for track in ("oval", "hairpins", "speedway")),
    *(("road-car", track, "default") for track in ("lakeside", "oval", "hairpins", "speedway")),
]


def row(program, run):
    """One line of the table: what `chicane drive` reports about the last of three laps."""
    car, track, preset = run
    command = f"drive --fast --car {car} --track {track} --preset {preset} --laps 3 --latency-ms 100 --set guard.mode=off"
    result = subprocess.run([program, *command.split(), "--json"], capture_output=True, text=True, cwd=ROOT)
    report = json.loads(result.stdout)
    laps = report["laps"]
    if not report["completed"]:
        return f"| {car} | {track} | `{preset}` | did not finish | | | | {report['off_track_events']} |\n"
    last = laps[-1]
    return (f"| {car} | {track} | `{preset}` | {last['lap_time_s']:.2f} | {last['mean_speed_mps'] / 0.44704:.1f} "
            f"| {last['top_speed_mph']:.1f} | {min(lap['min_edge_distance_m'] for lap in laps):.2f} "
            f"| {report['off_track_events']} |\n")


def table(program):
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        rows = list(pool.map(lambda run: row(program, run), RUNS))
    return ("| car | track | preset | flying lap [s] | mean [mph] | top [mph] | tyre to edge, least [m] | times off the road |\n"
            "|---|---|---|--:|--:|--:|--:|--:|\n" + "".join(rows))


def main():
    readme = ROOT / "README.md"
    text = readme.read_text(encoding="utf-8")
    head, rest = text.split(BEGIN)
    old, tail = rest.split(END)
    programs = [a for a in sys.argv[1:] if a != "--check"]
    new = table(programs[0] if programs else ROOT / "build/release/apps/chicane/chicane")
    if "--check" in sys.argv:
        for was, now in zip(old.splitlines(), new.splitlines()):
            if was != now:
                print(f"README.md: got {was}\n     expected {now}")
        return 0 if old == new else 1
    readme.write_text(head + BEGIN + new + END + tail, encoding="utf-8")
    print(new, end="")
    return 0


if __name__ == "__main__":
    sys.exit(main())
