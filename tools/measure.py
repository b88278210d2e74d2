#!/usr/bin/env python3
"""Drives the laps of README's table of numbers and writes it. All runs are in virtual time: the same on every machine with the same arithmetic.

    tools/measure.py [PROGRAM]          writes the table between the markers in README.md
    tools/measure.py --check [PROGRAM]  compares; exit code 1 and the lines that differ when the table is out of date

PROGRAM is build/release/apps/chicane/chicane when left out.
"""
import json
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
MPH = 0.44704
BEGIN, END = "<!-- numbers: tools/measure.py -->\n", "<!-- /numbers -->\n"
PLAN = "plans/numbers.yaml"


def row(run):
    """One line of the table: the last of three laps, the least distance to the edge of all."""
    car, track, preset = (run["settings"][key] for key in ("car", "track", "preset"))
    if not run["completed"]:
        return f"| {car} | {track} | `{preset}` | did not finish | | | | {run['off_track_events']} |\n"
    return (f"| {car} | {track} | `{preset}` | {run['lap_time_s']:.2f} | {run['lap_mean_speeds_mps'][-1] / MPH:.1f} "
            f"| {run['lap_top_speeds_mps'][-1] / MPH:.1f} | {min(run['lap_min_edge_distances_m']):.2f} "
            f"| {run['off_track_events']} |\n")


def table(program):
    with tempfile.TemporaryDirectory() as folder:
        driven, results = f"{folder}/driven.jsonl", f"{folder}/results.jsonl"
        for command in (["sweep", PLAN, "--jobs", "0", "-o", driven], ["merge", driven, "-o", results]):
            subprocess.run([program, *command], check=True, stderr=subprocess.DEVNULL, cwd=ROOT)
        runs = [json.loads(line) for line in Path(results).read_text(encoding="utf-8").splitlines()[1:]]
    return ("| car | track | preset | flying lap [s] | mean [mph] | top [mph] | tyre to edge, least [m] | times off the road |\n"
            "|---|---|---|--:|--:|--:|--:|--:|\n" + "".join(map(row, runs)))


def main():
    readme = ROOT / "README.md"
    text = readme.read_text(encoding="utf-8")
    head, rest = text.split(BEGIN)
    old, tail = rest.split(END)
    programs = [a for a in sys.argv[1:] if a != "--check"]
    new = table(Path(programs[0]).resolve() if programs else ROOT / "build/release/apps/chicane/chicane")
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
