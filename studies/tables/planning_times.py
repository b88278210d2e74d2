#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Processor time until `race` has its plan, for each car on each track, as a table for docs/measured/racing.md.

Every plan is computed again, on one core, for the configured grip; a run that has it ends after one cycle.
Prints Markdown. `--maps` plans the car f1tenth on the maps of tests/data/maps, `--circuits FOLDER` two cars on real
circuits, too.
"""
import argparse
import pathlib
import resource
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
CARS = ["udacity", "road-car", "bmw-320i", "vw-vanagon", "tum-1200", "formula-student", "indy", "f1tenth", "orca-1-43"]
MODEL_CARS = ["f1tenth", "orca-1-43"]  # bring tracks to their scale by themselves
TRACKS = ["lakeside", "original-lake", "oval", "hairpins", "speedway", "crossover", "stage"]


def planning_time(program, car, track, settings):
    """Seconds of processor time, and whether a plan was found."""
    command = [program, "drive", "--fast", "--no-cache", "--preset", "race", "--car", car, "--track", str(track), "--laps", "1"]
    for setting in ["time_limit_s=0.04", "tracking_mpc.learn_grip=false", *settings]:
        command += ["--set", setting]
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    run = subprocess.run(command, capture_output=True, text=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    why = [line for line in run.stderr.splitlines() if "plan" in line and "without" in line or "error" in line.lower()]
    return seconds, why[0] if why or run.returncode == 2 else ""


def row(program, name, cars, track, settings=()):
    cells = []
    for car in cars:
        seconds, why = planning_time(program, car, track, settings)
        if why:
            print(f"{name}, {car}: {why}", file=sys.stderr)
        cells.append(f"{seconds:.1f}" + (" (none)" if why else ""))
    print(f"| {name} | " + " | ".join(cells) + " |", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", help="chicane")
    parser.add_argument("--circuits", type=pathlib.Path, help="folder of tracks to plan for udacity and road-car")
    parser.add_argument("--maps", action="store_true", help="the maps of tests/data/maps for f1tenth")
    parser.add_argument("--cars", default=",".join(CARS), help="of the shipped tracks")
    options = parser.parse_args()
    cars = options.cars.split(",")
    print("| track | " + " | ".join(f"`{car}`" for car in cars) + " |")
    print("|---|" + "--:|" * len(cars), flush=True)
    for track in TRACKS:
        row(options.program, track, cars, track)
    if options.circuits:
        print("\n| circuit | `udacity` | `road-car` |\n|---|--:|--:|")
        for track in sorted(options.circuits.glob("*.csv")):
            row(options.program, track.stem, ["udacity", "road-car"], track)
    if options.maps:
        print("\n| map | `f1tenth` |\n|---|--:|")
        for track in sorted((ROOT / "tests/data/maps").glob("*.yaml")):
            row(options.program, track.stem, ["f1tenth"], track)


if __name__ == "__main__":
    main()
