#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Tables in docs/measured/ and figures of docs/effects.md from the results of studies/plans/effects.yaml, whose runs are
named TABLE: ROW.

    chicane sweep studies/plans/effects.yaml -o runs.jsonl
    studies/tables/experiments.py runs.jsonl TABLE          prints one table in Markdown
    studies/tables/experiments.py runs.jsonl --draw FOLDER  draws the figures (matplotlib)

tools/check_figures compares all of it with the pages, and writes it. All runs are in virtual time: the same on every machine with the same
arithmetic."""
import argparse
import json
import sys
from pathlib import Path

MPH = 0.44704
NUMBERS = ("flying lap [s]", "mean [mph]", "top [mph]", "rms lateral error [m]", "tyre to edge, least [m]", "off the road")
# table: what its first column is called
EFFECTS = {
    "known": "latency, compensated [ms]", "own_steps": "N", "steps": "N", "steps_measured": "N",
    "own_length": "dt [s]", "length": "dt [s]", "preview": "N, dt [s]", "higher": "N, dt [s]",
    "own_lateral": "weight_lateral", "knob": "w_a", "speed": "w_v", "product": "w_vδ", "unit": "`speed_in_mph`",
    "friction_udacity": "grip of the road", "friction_road_car": "grip of the road", "grip_share": "grip_share",
}
# figure: its axis, whether it is logarithmic, and the name and table of each curve
FIGURES = {
    "horizon": ("steps of the horizon, N", True, {"default": "own_steps", "fast-short-step, dt = 0.025 s": "steps"}),
    "step_length": ("step length [s]", True, {"default, N dt = 2 s": "own_length", "fast-short-step, N = 25": "length"}),
    "weights": ("weight", True, {"default, weight_lateral": "own_lateral", "fast-short-step, weight_throttle": "knob"}),
    "friction": ("grip of the road over that of the model", False,
                 {"udacity": "friction_udacity", "road-car": "friction_road_car", "road-car, road 0.7, over grip_share": "grip_share"}),
}


def tables_of(lines):
    """{table: {row: run}}, in the order of the plan. Runs that could not be driven are left out."""
    runs = sorted((run for run in map(json.loads, lines.splitlines()) if "run" in run), key=lambda run: run["run"])
    tables = {}
    for run in runs:
        if "error" not in run:
            table, row = run["settings"]["run"].split(": ", 1)
            tables.setdefault(table, {})[row] = run
    return tables


def is_off(run):
    return bool(run["off_track_events"]) or not run["completed"]


def outcome(run):
    """How a run went, in a few characters."""
    return f"**off** ({run['off_track_events']})" if is_off(run) else f"{run['rms_lateral_error_m']:.2f}"


def markdown(head, rows, numbers):
    """A table whose last columns are numbers."""
    rule = ["---"] * (len(head) - numbers) + ["--:"] * numbers
    line = ("| " + " | ".join(head) + " |\n").replace("|  |", "| |") + "|" + "|".join(rule) + "|\n"
    return line + "".join("| " + " | ".join(row) + " |\n" for row in rows)


def effect_table(rows, what):
    def cells(run):
        lap = f"{run['lap_time_s']:.2f}" if run["completed"] else "did not finish"
        return [lap, f"{run['mean_speed_mps'] / MPH:.1f}", f"{run['top_speed_mps'] / MPH:.1f}", f"{run['rms_lateral_error_m']:.2f}",
                f"{run['min_edge_distance_m']:.2f}", str(run["off_track_events"])]
    return markdown((what, *NUMBERS), [[name, *cells(run)] for name, run in rows.items()], len(NUMBERS))


def preset_table(rows):
    """The flying lap of each preset, on both lakes."""
    lines = []
    for name, run in rows.items():
        preset, track = name.split(", ")
        lines.append([f"`{preset}`", track, f"{run['lap_time_s']:.2f}", f"{run['lap_mean_speeds_mps'][-1] / MPH:.1f}",
                      f"{run['lap_top_speeds_mps'][-1] / MPH:.1f}", f"{run['lap_rms_lateral_errors_m'][-1]:.2f}",
                      f"{run['min_edge_distance_m']:.2f}", str(run["off_track_events"])])
    return markdown(("preset", "track", *NUMBERS), lines, len(NUMBERS))


def by_latency(rows):
    """{method: {latency [ms]: run}}"""
    methods = {}
    for name, run in rows.items():
        method, latency = name.removesuffix(" ms").rsplit(", ", 1)
        methods.setdefault(method, {})[int(latency)] = run
    return methods


def latency_table(rows):
    methods = by_latency(rows)
    latencies = list(next(iter(methods.values())))
    lines = [["`" + method.replace(", ", "`, ", 1) + ("" if ", " in method else "`"), *map(outcome, runs.values())]
             for method, runs in methods.items()]
    return markdown(("", *(f"{latency} ms" for latency in latencies)), lines, len(latencies))


def cure_table(rows):
    """Each preset with and without its own compensation."""
    lines = []
    for name, own in rows.items():
        preset, method = name.split(", ")
        if method != "without":
            none = rows[f"{preset}, without"]
            lines.append([f"`{preset}`", f"`{method}`", outcome(own), outcome(none),
                          *(f"{run['steering_rate_rms_radps']:.2f}" for run in (own, none))])
    head = ("preset", "its method", "rms lateral error with it", "without", "steering rate with it", "without")
    return markdown(head, lines, 4)


def plotting():
    import matplotlib
    matplotlib.use("svg")
    matplotlib.rcParams["svg.hashsalt"] = "chicane"  # the same bytes each time
    import matplotlib.pyplot as plt
    return plt


def draw(axes, name, runs):
    """rms lateral error over the numbers of `runs`; a cross where a tyre left the road."""
    errors = {number: min(run["rms_lateral_error_m"], 6.0) for number, run in runs.items()}
    off = [number for number, run in runs.items() if is_off(run)]
    (curve,) = axes.plot(list(errors), list(errors.values()), marker="o", label=name)
    axes.plot(off, [errors[number] for number in off], "x", color=curve.get_color(), markersize=11, markeredgewidth=2.5)


def save(figure, folder, name):
    figure.tight_layout()
    figure.savefig(folder / f"{name}.svg", metadata={"Date": None, "Creator": None})


def draw_effect(tables, folder, name):
    """Flying lap above, rms lateral error below."""
    label, is_logarithmic, curves = FIGURES[name]
    figure, (above, below) = plotting().subplots(2, 1, figsize=(9.5, 6.5), sharex=True)
    for curve, table in curves.items():
        runs = {float(row): run for row, run in tables[table].items()}
        laps = [run["lap_time_s"] if run["completed"] else float("nan") for run in runs.values()]
        above.plot(list(runs), laps, marker="o", label=curve)
        draw(below, curve, runs)
    above.set_ylabel("flying lap [s]")
    below.set_ylabel("rms lateral error [m], at most 6 drawn")
    below.set_xlabel(label)
    above.set_title("lakeside, 100 ms of latency: a cross is a run with a tyre off the road")
    for axes in (above, below):
        axes.grid(alpha=0.3)
        if is_logarithmic:
            axes.set_xscale("log")
    above.legend(loc="center left", bbox_to_anchor=(1.0, 0.5))
    save(figure, folder, name)


def draw_latency(rows, folder):
    figure, axes = plotting().subplots(figsize=(9.5, 4.5))
    for method, runs in by_latency(rows).items():
        draw(axes, method, runs)
    axes.set_xlabel("latency [ms]")
    axes.set_ylabel("rms lateral error [m], at most 6 drawn")
    axes.set_title("lakeside at 40 mph: a cross is a run with a tyre off the road")
    axes.grid(alpha=0.3)
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5))
    save(figure, folder, "latency")


def table_named(tables, name):
    """The Markdown of one table."""
    if name == "presets":
        return preset_table(tables[name])
    if name in ("latency", "fast"):
        return latency_table(tables[name])
    return cure_table(tables[name]) if name == "cure" else effect_table(tables[name], EFFECTS[name])


def main():
    names = ["presets", "latency", "fast", "cure", *EFFECTS]
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("runs", type=Path, help="results of studies/plans/effects.yaml")
    parser.add_argument("table", nargs="?", choices=names, metavar="TABLE", help=", ".join(names))
    parser.add_argument("--draw", type=Path, metavar="FOLDER", help="draw the figures into this folder")
    arguments = parser.parse_args()
    if bool(arguments.table) == bool(arguments.draw):
        parser.error("expected a table, or --draw FOLDER")
    tables = tables_of(arguments.runs.read_text(encoding="utf-8"))
    if arguments.table:
        sys.stdout.write(table_named(tables, arguments.table))
        return 0
    for name in FIGURES:
        draw_effect(tables, arguments.draw, name)
    draw_latency(tables["latency"], arguments.draw)
    print("drawn")
    return 0


if __name__ == "__main__":
    sys.exit(main())
