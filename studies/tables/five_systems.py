#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Prints the table of docs/the_five_systems.md: flying laps of the five presets [s] (mean [mph]), and verdicts on the write-ups' statements.

    chicane sweep studies/plans/effects.yaml -o runs.jsonl
    studies/tables/five_systems.py runs.jsonl

The laps are those of studies/plans/effects.yaml, the verdicts those of docs/measured/claims.md, which `chicane claims --check` compares."""
import argparse
import json
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
LETTERS = {"measured-latency": "A", "fast-short-step": "B", "sixty-mph": "C", "weighted": "D", "delay-in-model": "E"}
MPH = 0.44704
ORDER = ("true", "works", "depends", "partly", "not reproduced", "false", "not so")


def lap(runs, preset, track):
    """'68.18 (37.4)': time of the last lap and its mean speed, and how often a tyre left the road."""
    for line in runs.read_text(encoding="utf-8").splitlines():
        run = json.loads(line)
        if run.get("settings", {}).get("run", "") == f"presets: {preset}, {track}" and "error" not in run:
            off = run["off_track_events"]
            return f"{run['lap_time_s']:.2f} ({run['lap_mean_speeds_mps'][-1] / MPH:.1f})" + (f", {off} times off the road" if off else "")
    return "–"


def verdicts(letter):
    """How many statements have each verdict."""
    found = dict.fromkeys(ORDER, 0)
    for line in (ROOT / "docs/measured/claims.md").read_text(encoding="utf-8").splitlines():
        row = re.match(rf"\| {letter}\d+ \| .*? \| ([^|]*) \|", line)
        if row:
            found[next(word for word in ORDER if row[1].strip().strip("*").startswith(word))] += 1
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("runs", type=Path, help="results of studies/plans/effects.yaml")
    arguments = parser.parse_args()
    print(f"| write-up, preset | lakeside | original lake | {' | '.join(ORDER)} |")
    print("|---|--:|--:|" + len(ORDER) * "--:|")
    for preset, letter in LETTERS.items():
        laps = " | ".join(lap(arguments.runs, preset, track) for track in ("lakeside", "original-lake"))
        print(f"| {letter}, `{preset}` | {laps} | {' | '.join(map(str, verdicts(letter).values()))} |")
    return 0


if __name__ == "__main__":
    sys.exit(main())
