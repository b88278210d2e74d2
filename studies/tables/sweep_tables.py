#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Prints a table of a page in Markdown, from the results of the sweep that drives its runs.

    chicane sweep studies/plans/numbers.yaml -o runs.jsonl
    studies/tables/sweep_tables.py runs.jsonl numbers    README: controllers on the same car, track and seed (studies/plans/numbers.yaml)
    studies/tables/sweep_tables.py runs.jsonl pid        docs/measured/effects.md: presets by speed (studies/plans/pid.yaml)
    studies/tables/sweep_tables.py runs.jsonl cars       docs/measured/racing.md: cars by track (studies/plans/cars.yaml)
    studies/tables/sweep_tables.py runs.jsonl sensors    docs/measured/effects.md: presets by latency of the sensors (studies/plans/sensor-latency.yaml)
    studies/tables/sweep_tables.py runs.jsonl race       docs/measured/racing.md: `race` with the guard on and off, and `default` (studies/plans/racing.yaml)
    studies/tables/sweep_tables.py runs.jsonl race_cars  docs/measured/racing.md: `race` with the other cars (studies/plans/racing-cars.yaml)
    studies/tables/sweep_tables.py runs.jsonl waypoints  docs/measured/racing.md: laps from waypoints alone (studies/plans/racing-waypoints.yaml)
    studies/tables/sweep_tables.py runs.jsonl otherwise  docs/measured/racing.md: another grip, mass, latency (studies/plans/racing-otherwise.yaml)
    studies/tables/sweep_tables.py runs.jsonl noise      docs/measured/racing.md: noisy sensors (studies/plans/racing-noise.yaml)
    studies/tables/sweep_tables.py runs.jsonl maps       docs/measured/racing.md: a model car on maps (studies/plans/racing-maps.yaml)
    studies/tables/sweep_tables.py runs.jsonl guard      docs/measured/safety.md: presets with the guard on beside off (studies/plans/guard-presets.yaml)

tools/check_figures compares them with the pages, and writes them."""
import argparse
import json
import sys
from pathlib import Path

MPH = 0.44704


def runs_of(path):
    """The runs of a sweep, in the order of its plan."""
    lines = (json.loads(line) for line in path.read_text(encoding="utf-8").splitlines())
    return sorted((line for line in lines if "run" in line), key=lambda run: run["run"])


def markdown(head, rows, numbers):
    """A table whose last columns are numbers."""
    rule = ["---"] * (len(head) - numbers) + ["--:"] * numbers
    return "".join("| " + " | ".join(row) + " |\n" for row in (head, *rows)).replace("\n", "\n|" + "|".join(rule) + "|\n", 1)


def is_clean(run):
    return "error" not in run and run["completed"] and not run["off_track_events"]


def setting(run, key):
    value = run["settings"][key]
    return str(value).lower() if isinstance(value, bool) else str(value)


def lap(run):
    return f"{run['lap_time_s']:.2f}" if run["completed"] else "did not finish"


def numbers(runs):
    """The last of three laps; distance and times off the road of all three."""
    head = ("car", "track", "preset", "flying lap [s]", "mean [mph]", "top [mph]", "tyre to edge, least [m]", "times off the road",
            "lap with the guard on [s]")
    guarded = {tuple(setting(run, key) for key in ("car", "track", "preset")): run for run in runs if setting(run, "guard.mode") == "on"}
    rows = []
    for run in runs:
        if setting(run, "guard.mode") == "on":
            continue
        key = tuple(setting(run, key) for key in ("car", "track", "preset"))
        figures = [lap(run)]
        if run["completed"]:
            figures += [f"{run['lap_mean_speeds_mps'][-1] / MPH:.1f}", f"{run['lap_top_speeds_mps'][-1] / MPH:.1f}",
                        f"{min(run['lap_min_edge_distances_m']):.2f}"]
        figures += [""] * (4 - len(figures))
        rows.append([key[0], key[1], f"`{key[2]}`", *figures, str(run["off_track_events"]), lap(guarded[key])])
    return markdown(head, rows, 6)


def pivot(runs, row, column, cell, heads):
    """A row for each value of one setting, a column for each of another."""
    columns = list(dict.fromkeys(column(run) for run in runs))
    cells = {}
    for run in runs:
        cells.setdefault(row(run), {})[column(run)] = cell(run)
    rows = [[name, *(found.get(each, "") for each in columns)] for name, found in cells.items()]
    return markdown((heads[0], *(heads[1].format(each) for each in columns)), rows, len(columns))


def pid(runs):
    def cell(run):
        return f"{run['rms_lateral_error_m']:.2f}" if is_clean(run) else f"**off** ({run['off_track_events']})"

    def row(run):
        period = setting(run, "control_period_ms")
        return f"`{setting(run, 'preset')}`" + ("" if period == "120" else f", an answer every {period} ms")
    return pivot(runs, row, lambda run: setting(run, "speed_mph"), cell, ("preset", "{} mph"))


def cars(runs):
    def cell(run):
        return "refused" if "error" in run else lap(run) if is_clean(run) else "off"
    return pivot(runs, lambda run: f"`{setting(run, 'car')}`", lambda run: Path(setting(run, "track")).stem, cell, ("car", "{}"))


def sensors(runs):
    def cell(run):
        return f"{run['rms_lateral_error_m']:.2f} ({run['min_edge_distance_m']:.2f})" if is_clean(run) else "**off**"
    return pivot(runs, lambda run: f"`{setting(run, 'preset')}`", lambda run: setting(run, "sensor.latency_ms"), cell, ("preset", "{} ms"))


KERBS_M = {"hairpins": 0.5}  # drivable for the judge, no road for the guard


def guard(runs):
    """Runs that keep off kerbs and on the road without the guard; the same ones with it."""
    keys = ("preset", "track", "latency_ms", "latency_jitter_ms")
    off = {tuple(setting(run, key) for key in keys): run for run in runs if setting(run, "guard.mode") == "off"}
    rows = {}
    for run in runs:
        alone = off.get(tuple(setting(run, key) for key in keys))
        if setting(run, "guard.mode") != "on" or not is_clean(alone) or alone["min_edge_distance_m"] < KERBS_M.get(road(run), 0.0):
            continue
        row = rows.setdefault(setting(run, "preset"), {"runs": 0, "touched": 0, "steps": 0, "off": 0, "worst": 0.0, "slower": 0})
        steps = sum(run["guard_reasons"].values()) + max(run["gate_interventions"] - alone["gate_interventions"], 0)
        differs = max((abs(a / b - 1.0) for a, b in zip(run["lap_times_s"], alone["lap_times_s"])), default=0.0) if run["completed"] else 1.0
        row["runs"] += 1
        row["touched"] += steps > 0
        row["steps"] += steps
        row["off"] += run["off_track_events"] > 0
        row["slower"] += differs > 0.005
        row["worst"] = max(row["worst"], differs)
    return markdown(("preset", "runs", "touched", "steps", "laps differ by 0.5 %", "worst lap", "off the road"),
                    [[f"`{name}`", *(str(row[key]) for key in ("runs", "touched", "steps", "slower")), f"{100 * row['worst']:.1f} %",
                      str(row["off"])] for name, row in rows.items()], 6)


def road(run):
    return Path(setting(run, "track")).stem


def lap_and_edge(run):
    """The last lap, and how near the edge a tyre came in all of them."""
    if "error" in run:
        return "refused"
    return f"{lap(run)} ({run['min_edge_distance_m']:.2f})" if is_clean(run) else f"off ({run['min_edge_distance_m']:.1f})"


def race(runs):
    def name(run):
        return "`default`" if setting(run, "preset") == "default" else f"`race`, guard {setting(run, 'guard.mode')}"
    return pivot(runs, lambda run: f"`{setting(run, 'car')}`, {road(run)}", name, lap_and_edge, ("car, track", "{}"))


def lap_and_millimetres(run):
    """As lap_and_edge, for roads of model cars, too."""
    if "error" in run:
        return "refused"
    return f"{lap(run)} ({run['min_edge_distance_m']:.3f})" if is_clean(run) else "off"


def maps(runs):
    return pivot(runs, road, lambda run: f"`{setting(run, 'preset')}`", lap_and_millimetres, ("map", "{}"))


def race_cars(runs):
    return pivot(runs, lambda run: f"`{setting(run, 'car')}`", road, lap_and_millimetres, ("car", "{}"))


def waypoints(runs):
    def cell(run):
        laps = ", ".join(f"{time:.2f}" for time in run["lap_times_s"])
        return f"{laps} ({run['min_edge_distance_m']:.2f})" if is_clean(run) else f"off ({run['min_edge_distance_m']:.1f})"
    return pivot(runs, lambda run: f"`{setting(run, 'car')}`, {road(run)}", lambda run: setting(run, "guard.mode"), cell,
                 ("car, track", "guard {}"))


def otherwise(runs):
    def what(run):
        names = {"plant_options.friction_scale": "grip", "plant_options.mass_scale": "mass"}
        found = [f"{name} {float(setting(run, key)):g}" for key, name in names.items() if float(setting(run, key)) != 1.0]
        late = float(setting(run, "latency_ms")) - 100.0
        jitter = float(setting(run, "latency_jitter_ms"))
        found += [f"latency +{late:g} ms"] if late else []
        return ", ".join(found + ([f"jitter {jitter:g} ms"] if jitter else [])) or "as assumed"

    return pivot(runs, lambda run: f"`{setting(run, 'car')}`, {what(run)}", road, lap_and_edge, ("car, what is otherwise", "{}"))


def noise(runs):
    """Of several seeds: the mean of the last laps, the least distance to the edge, and how many leave the road."""
    found = {}
    for run in runs:
        key = f"`{setting(run, 'car')}`, {road(run)}", setting(run, "tracking_mpc.learn_grip")
        found.setdefault(key[0], {}).setdefault(key[1], []).append(run)

    def cell(seeds):
        clean = [run["lap_time_s"] for run in seeds if is_clean(run)]
        mean = f"{sum(clean) / len(clean):.2f}" if clean else "–"
        return f"{mean} ({min(run['min_edge_distance_m'] for run in seeds):.2f}), off {len(seeds) - len(clean)} of {len(seeds)}"
    rows = [[name, *(cell(by_learning[learns]) for learns in ("true", "false"))] for name, by_learning in found.items()]
    return markdown(("car, track", "learns the grip", "does not"), rows, 2)


TABLES = {"numbers": numbers, "pid": pid, "cars": cars, "sensors": sensors, "race": race,
          "waypoints": waypoints, "otherwise": otherwise, "noise": noise, "maps": maps, "guard": guard,
          "race_cars": race_cars}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("runs", type=Path, help="results of `chicane sweep`")
    parser.add_argument("table", choices=TABLES)
    arguments = parser.parse_args()
    sys.stdout.write(TABLES[arguments.table](runs_of(arguments.runs)))
    return 0


if __name__ == "__main__":
    sys.exit(main())
