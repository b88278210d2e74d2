#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Prints the table of docs/measured/limit.md in Markdown: what takes how much of the gap between `race` and the limit, for each corner.

    studies/tables/gap_table.py --compute hairpins berlin.csv > gaps.jsonl    drives each track with udacity (10 to 60 s)
    studies/tables/gap_table.py gaps.jsonl                                    the table

tools/check_figures compares it with the page, and writes it. The program is `chicane` on the path."""
import argparse
import json
import subprocess
from pathlib import Path


def compute(tracks):
    for track in tracks:
        done = subprocess.run(["chicane", "drive", "--fast", "--preset", "race", "--car", "udacity", "--track", track, "--laps", "3",
                               "--limit", "--explain", "--json"], check=True, capture_output=True, text=True)
        print(json.dumps(json.loads(done.stdout)), flush=True)


def cells(limit, plan, lap, without):
    taken = [lap - time for time in without]
    return [f"{limit:.2f}", f"{plan:.2f}", f"{lap:.2f}", *(f"{time:+.2f}" for time in (lap - limit, *taken, lap - limit - sum(taken)))]


def rows_of(run):
    best = min(run["laps"], key=lambda lap: lap["lap_time_s"])
    planned = run["planned_corner_times_s"]
    for i, corner in enumerate(run["corners"]):
        name = f"{i + 1} {'left' if corner['turn_deg'] > 0 else 'right'}"
        yield name, cells(run["limit"]["corner_times_s"][i], planned[i], best["corner_times_s"][i],
                          [each["corner_times_s"][i] for each in run["without"]])
    yield "lap", cells(run["limit"]["lap_time_s"], sum(planned), best["lap_time_s"], [each["lap_time_s"] for each in run["without"]])


def table(runs):
    causes = [each["cause"] for each in runs[0]["without"]]
    print(f"| track, corner | limit | plan | lap | gap | {' | '.join(causes)} | rest |\n|---|{'--:|' * (5 + len(causes))}")
    for run in runs:
        for name, row in rows_of(run):
            print(f"| {run['track']}, {name} | {' | '.join(row)} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--compute", nargs="+", metavar="TRACK", help="tracks to drive")
    parser.add_argument("gaps", nargs="?", help="what --compute has printed")
    options = parser.parse_args()
    if bool(options.compute) == bool(options.gaps):
        parser.error("expected --compute, or its results")
    if options.compute:
        compute(options.compute)
    else:
        table([json.loads(line) for line in Path(options.gaps).read_text(encoding="utf-8").splitlines()])


if __name__ == "__main__":
    main()
