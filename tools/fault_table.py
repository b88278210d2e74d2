#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Drives through every fault with `chicane drive --fast --fault` and prints the table of docs/faults.md."""
import argparse
import concurrent.futures
import json
import subprocess
import sys

DRIVERS = [
    ("`default`, udacity", ["--preset", "default", "--car", "udacity"]),
    ("`default`, road-car", ["--preset", "default", "--car", "road-car"]),
    ("`weighted`, udacity", ["--preset", "weighted", "--car", "udacity"]),
    ("`weighted`, road-car", ["--preset", "weighted", "--car", "road-car"]),
]


def faults(program):
    lines = subprocess.run([program, "list", "faults"], capture_output=True, text=True, check=True).stdout
    return [line.split()[0] for line in lines.splitlines() if line]


def outcome(program, fault, options):
    """Two laps with the fault 14 s after the start: distance to the edge, laps, and how many steps fell back."""
    command = [program, "drive", "--fast", "--json", "--laps", "2", "--fault", f"{fault}@14", *options]
    run = json.loads(subprocess.run(command, capture_output=True, text=True).stdout)
    edge = run["total"]["min_edge_distance_m"]
    laps = "" if run["completed"] else f", {run['laps_completed']} of 2 laps"
    fallbacks = f" ({run['fallbacks']})" if run["fallbacks"] else ""
    return f"{edge:.2f}{laps}{fallbacks}"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program", nargs="?", default="build/release/apps/chicane/chicane")
    program = parser.parse_args().program
    print("| fault | " + " | ".join(name for name, _ in DRIVERS) + " |")
    print("|---" * (1 + len(DRIVERS)) + "|")
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        rows = [
            (fault, [pool.submit(outcome, program, fault, options) for _, options in DRIVERS])
            for fault in faults(program)
        ]
        for fault, cells in rows:
            print(f"| `{fault}` | " + " | ".join(cell.result() for cell in cells) + " |")
    return 0


if __name__ == "__main__":
    sys.exit(main())
