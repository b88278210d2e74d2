#!/usr/bin/env python3
"""Tunes each of the five presets by two optimisers, and prints the table of docs/measured/racing.md: by hand, and what was found.

    studies/tables/tune_presets.py LOGS [--evaluations N] [--presets NAME,...] [--program PROGRAM]

LOGS is a folder for the searches' logs: a campaign that was ended goes on, and one that is over only prints the table. Deterministic. PROGRAM is
build/release/apps/chicane/chicane when left out.
"""
import argparse
import json
import subprocess
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
OPTIMIZERS = ("sbplx", "crs")


def tuned(program, preset, optimizer, options):
    """What `chicane tune` says in JSON. Its exit code is 1 where it has found nothing better."""
    log = Path(options.logs) / f"{preset}.{optimizer}.jsonl"
    command = [program, "tune", "--preset", preset, "--optimizer", optimizer, "--evaluations", str(options.evaluations),
               "--jobs", "1", "--log", str(log), "--json"]
    done = subprocess.run(command, cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
    if done.returncode not in (0, 1):
        raise SystemExit(f"{' '.join(command)}: exit code {done.returncode}")
    return json.loads(done.stdout)


def widest(log, by_hand):
    """Of the tunings that passed all trials and are at least as fast as by hand: the one with the most margin."""
    tried = [json.loads(line) for line in Path(log).read_text(encoding="utf-8").splitlines()[1:]]
    passed = [each for each in tried if each["passed"] == by_hand["driven"] and each["lap_time_s"] <= by_hand["lap_time_s"]]
    return max(passed, key=lambda each: each["margin_m"], default=None)


def print_row(preset, name, verdict, tuning):
    lap = f"{verdict['lap_time_s']:.2f}" if verdict["lap_time_s"] is not None else "–"
    counts = f"{tuning['evaluations']} | {tuning['runs']}" if tuning else " | "
    print(f"| {preset} | {name} | {lap} | {verdict['margin_m']:.3f} | {verdict['steering_rate_radps']:.3f} | {counts} |", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("logs")
    parser.add_argument("--evaluations", type=int, default=2000)
    parser.add_argument("--presets", default="measured-latency,fast-short-step,sixty-mph,weighted,delay-in-model")
    parser.add_argument("--program", default=str(ROOT / "build/release/apps/chicane/chicane"))
    options = parser.parse_args()
    Path(options.logs).mkdir(parents=True, exist_ok=True)
    print("| preset | tuning | flying lap [s] | margin [m] | steering [rad/s] | evaluations | runs |\n|---|---|--:|--:|--:|--:|--:|")
    for preset in options.presets.split(","):
        for optimizer in OPTIMIZERS:
            tuning = tuned(options.program, preset, optimizer, options)
            if optimizer == OPTIMIZERS[0]:
                print_row(f"`{preset}`", "by hand", tuning["by_hand"], None)
            print_row("", f"`{optimizer}`, the fastest" if tuning["is_better"] else f"`{optimizer}`: none better", tuning["found"], tuning)
            wide = widest(Path(options.logs) / f"{preset}.{optimizer}.jsonl", tuning["by_hand"])
            if wide:
                print_row("", f"`{optimizer}`, the most margin", wide, None)


if __name__ == "__main__":
    main()
