#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Prints what docs/the_five_systems.md says of one preset in numbers: its flying laps, and the verdicts on its write-up's statements.

    chicane sweep studies/plans/effects.yaml -o runs.jsonl
    studies/tables/five_systems.py runs.jsonl measured-latency

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


def laps(runs, preset):
    """'68.18 s at 37.4 mph on lakeside, ...'"""
    found = []
    for line in runs.read_text(encoding="utf-8").splitlines():
        run = json.loads(line)
        name = run.get("settings", {}).get("run", "")
        if not name.startswith(f"presets: {preset}, ") or "error" in run:
            continue
        off = run["off_track_events"]
        found.append((run["run"], f"{run['lap_time_s']:.2f} s on {name.rsplit(', ', 1)[1]} (mean {run['lap_mean_speeds_mps'][-1] / MPH:.1f} mph, "
                                  f"{'no tyre off the road' if off == 0 else f'{off} times off the road'})"))
    return "; ".join(text for _, text in sorted(found))


def verdicts(letter):
    """The ids of the statements, by verdict."""
    found = {}
    for line in (ROOT / "docs/measured/claims.md").read_text(encoding="utf-8").splitlines():
        row = re.match(rf"\| ({letter}\d+) \| .*? \| ([^|]*) \|", line)
        if row:
            word = next(word for word in ORDER if row[2].strip().strip("*").startswith(word))
            found.setdefault(word, []).append(row[1])
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("runs", type=Path, help="results of studies/plans/effects.yaml")
    parser.add_argument("preset", choices=LETTERS)
    arguments = parser.parse_args()
    letter = LETTERS[arguments.preset]
    found = verdicts(letter)
    print("| | |")
    print("|---|---|")
    print(f"| flying lap | {laps(arguments.runs, arguments.preset)} |")
    for word in ORDER:
        if word in found:
            means = "depends on the reading of speed, or on the lake" if word == "depends" else word
            print(f"| {means}: {len(found[word])} | {', '.join(found[word])} |")
    return 0


if __name__ == "__main__":
    sys.exit(main())
