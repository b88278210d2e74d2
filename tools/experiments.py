#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Runs the experiments of docs/problem.md and of the pages on effects (latency, horizon, step_length, weights, friction), and
writes their tables and figures.

    /usr/bin/python3 tools/experiments.py [PROGRAM]

PROGRAM is build/release/apps/chicane/chicane when left out. All runs are in virtual time: the same on every machine with the same arithmetic.
"""
import json
import os
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
LAKE = "../shared/tracks/udacity/lake_scene.csv"
LATENCIES = (0, 50, 100, 150, 200, 300)
MPH = 0.44704


class Runs:
    """Drives each command once, a few at a time."""

    def __init__(self, program):
        self.program = program
        self.pool = ThreadPoolExecutor(os.cpu_count())
        self.started = {}

    def start(self, command):
        if command not in self.started:
            self.started[command] = self.pool.submit(self.drive, command)
        return self.started[command]

    def drive(self, command):
        result = subprocess.run([self.program, *command.split(), "--json"], capture_output=True, text=True, cwd=ROOT)
        if not result.stdout:
            raise RuntimeError(f"{command}: {result.stderr}")
        return json.loads(result.stdout)


def command(preset, *settings, track="lakeside", laps=2, latency=100, mph=None, seconds=200, car=None):
    """The command as a reader can type it. Measurements come as from the original: 20 ms after the last command arrived."""
    period = [] if any(setting.startswith("control_period_ms=") for setting in settings) else [f"control_period_ms={latency + 20}"]
    text = f"drive --fast --preset {preset} --track {track} --laps {laps} --latency-ms {latency}"
    if car:
        text += f" --car {car}"
    if mph:
        text += f" --speed-mph {mph}"
    for setting in (*period, f"time_limit_s={seconds}", *settings):
        text += f" --set {setting}"
    return text


def outcome(report):
    """How a run went, in a few characters."""
    total = report["total"]
    if report["off_track_events"] or not report["completed"]:
        return f"**off** ({report['off_track_events']})"
    return f"{total['rms_lateral_error_m']:.2f}"


def handling_settings(handling, latency):
    if handling == "inside-model":  # one step is the delay; the shortest one is 20 ms
        step = max(latency, 20)
        return [f"cubic_mpc.latency_handling={handling}", f"cubic_mpc.latency_ms={step}", f"cubic_mpc.step_length_s={step / 1000}"]
    return [f"cubic_mpc.latency_handling={handling}", f"cubic_mpc.latency_ms={latency}"]


HANDLINGS = ("none", "position-only", "roll-forward", "measured", "inside-model")
TRACKING = {"`tracking-mpc`, delay ignored": "false", "`tracking-mpc`, commands replayed": "true"}


def latency_commands():
    """(row, latency) -> command, for the table of docs/latency.md."""
    rows = {}
    for latency in LATENCIES:
        for handling in HANDLINGS:
            rows[f"`{handling}`", latency] = command("weighted", *handling_settings(handling, latency), latency=latency, mph=40)
        for name, value in TRACKING.items():
            rows[name, latency] = command("default", f"tracking_mpc.compensate_delay={value}", latency=latency, mph=40)
    return rows


def fast_commands():
    """The same for our own controller at its own speed."""
    return {(name, latency): command("default", f"tracking_mpc.compensate_delay={value}", latency=latency)
            for latency in LATENCIES for name, value in TRACKING.items()}


def latency_table(runs, commands):
    reports = {key: runs.start(line) for key, line in commands.items()}
    names = dict.fromkeys(name for name, _ in reports)
    text = "| | " + " | ".join(f"{latency} ms" for latency in LATENCIES) + " |\n|---|" + "--:|" * len(LATENCIES) + "\n"
    for name in names:
        cells = [outcome(reports[name, latency].result()) for latency in LATENCIES]
        text += f"| {name} | " + " | ".join(cells) + " |\n"
    return text


OWN = {"measured-latency": "measured", "fast-short-step": "roll-forward", "sixty-mph": "position-only", "weighted": "roll-forward",
       "delay-in-model": "inside-model"}


def cure_table(runs):
    """Each preset with and without its own compensation."""
    text = "| preset | its method | rms lateral error with it | without | steering rate with it | without |\n|---|---|--:|--:|--:|--:|\n"
    pairs = {preset: (runs.start(command(preset)), runs.start(command(preset, "cubic_mpc.latency_handling=none"))) for preset in OWN}
    for preset, (own, none) in pairs.items():
        own, none = own.result(), none.result()
        errors = [outcome(own), outcome(none)]
        rates = [f"{r['total']['steering_rate_rms_radps']:.2f}" for r in (own, none)]
        text += f"| `{preset}` | `{OWN[preset]}` | {errors[0]} | {errors[1]} | {rates[0]} | {rates[1]} |\n"
    return text


def preset_table(runs):
    text = ("| preset | track | flying lap [s] | mean [mph] | top [mph] | rms lateral error [m] | tyre to edge, least [m] | off the road |\n"
            "|---|---|--:|--:|--:|--:|--:|--:|\n")
    tracks = ["lakeside"] + ([LAKE] if (ROOT / LAKE).exists() else [])
    lines = [(preset, track) for preset in OWN for track in tracks]
    started = [runs.start(f"drive --fast --preset {preset} --car udacity --track {track} --laps 3 --latency-ms 100") for preset, track in lines]
    for (preset, _), started_run in zip(lines, started):
        report = started_run.result()
        lap, total = report["laps"][-1], report["total"]
        text += (f"| `{preset}` | {report['track']} | {lap['lap_time_s']:.2f} | {lap['mean_speed_mps'] / MPH:.1f} | {lap['top_speed_mph']:.1f} "
                 f"| {lap['rms_lateral_error_m']:.2f} | {total['min_edge_distance_m']:.2f} | {report['off_track_events']} |\n")
    return text


def sweep_table(runs, preset, what, values, **options):
    """One line for each value of a setting, or of several that go together."""
    text = (f"| {what} | flying lap [s] | mean [mph] | top [mph] | rms lateral error [m] | tyre to edge, least [m] | off the road |\n"
            "|---|--:|--:|--:|--:|--:|--:|\n")
    started = {name: runs.start(command(preset, *settings, laps=3, seconds=400, **options)) for name, settings in values.items()}
    for name, run in started.items():
        report = run.result()
        lap = f"{report['laps'][-1]['lap_time_s']:.2f}" if report["completed"] else "did not finish"
        total = report["total"]
        text += (f"| {name} | {lap} | {total['mean_speed_mps'] / MPH:.1f} | {total['top_speed_mph']:.1f} "
                 f"| {total['rms_lateral_error_m']:.2f} | {total['min_edge_distance_m']:.2f} | {report['off_track_events']} |\n")
    return text


def values(key, numbers, of="cubic_mpc", *more):
    return {f"{number}": [f"{of}.{key}={number}", *more] for number in numbers}


def steps_and_lengths(pairs, of="cubic_mpc", *more):
    return {f"{steps}, {length}": [f"{of}.horizon_steps={steps}", f"{of}.step_length_s={length}", *more] for steps, length in pairs}


def draw_sweeps(runs, path, label, curves, logarithmic=False):
    """Flying lap above, rms lateral error below, one curve for each (name, preset, {number: settings}, options); a cross where a tyre left the road."""
    plt = plotting()
    figure, (above, below) = plt.subplots(2, 1, figsize=(9.5, 6.5), sharex=True)
    for name, preset, sweep, options in curves:
        reports = {number: runs.start(command(preset, *settings, laps=3, seconds=400, **options)).result() for number, settings in sweep.items()}
        numbers = list(reports)
        laps = [r["laps"][-1]["lap_time_s"] if r["completed"] else float("nan") for r in reports.values()]
        errors = [min(r["total"]["rms_lateral_error_m"], 6.0) for r in reports.values()]
        off = [number for number, r in reports.items() if r["off_track_events"] or not r["completed"]]
        above.plot(numbers, laps, marker="o", label=name)
        (curve,) = below.plot(numbers, errors, marker="o", label=name)
        below.plot(off, [errors[numbers.index(number)] for number in off], "x", color=curve.get_color(), markersize=11, markeredgewidth=2.5)
    above.set_ylabel("flying lap [s]")
    below.set_ylabel("rms lateral error [m], at most 6 drawn")
    below.set_xlabel(label)
    above.set_title("lakeside, 100 ms of latency: a cross is a run with a tyre off the road")
    for axes in (above, below):
        axes.grid(alpha=0.3)
        if logarithmic:
            axes.set_xscale("log")
    above.legend(loc="center left", bbox_to_anchor=(1.0, 0.5))
    figure.tight_layout()
    figure.savefig(path, metadata={"Date": None, "Creator": None})


def plotting():
    import matplotlib
    matplotlib.use("svg")
    matplotlib.rcParams["svg.hashsalt"] = "chicane"  # the same bytes each time
    import matplotlib.pyplot as plt
    return plt


def draw_latency(runs, path):
    """rms lateral error over latency, one curve for each method; a cross where a tyre left the road."""
    plt = plotting()
    figure, axes = plt.subplots(figsize=(9.5, 4.5))
    reports = {key: runs.start(line).result() for key, line in latency_commands().items()}
    for name in dict.fromkeys(name for name, _ in reports):
        errors = [min(reports[name, latency]["total"]["rms_lateral_error_m"], 6.0) for latency in LATENCIES]
        off = [latency for latency in LATENCIES if outcome(reports[name, latency]).startswith("**")]
        (curve,) = axes.plot(LATENCIES, errors, marker="o", label=name.replace("`", ""))
        axes.plot(off, [errors[LATENCIES.index(latency)] for latency in off], "x", color=curve.get_color(), markersize=11, markeredgewidth=2.5)
    axes.set_xlabel("latency [ms]")
    axes.set_ylabel("rms lateral error [m], at most 6 drawn")
    axes.set_title("lakeside at 40 mph: a cross is a run with a tyre off the road")
    axes.grid(alpha=0.3)
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5))
    figure.tight_layout()
    figure.savefig(path, metadata={"Date": None, "Creator": None})


def write(page, marker, table):
    """Replaces what stands between <!-- marker: ... --> and <!-- /marker -->."""
    path = ROOT / "docs" / page
    text = path.read_text(encoding="utf-8")
    begin, end = f"<!-- {marker}: tools/experiments.py -->\n", f"<!-- /{marker} -->"
    head, rest = text.split(begin)
    path.write_text(head + begin + table + end + rest.split(end, 1)[1], encoding="utf-8")


def effects(runs):
    """One page for each effect."""
    fast, weighted, own = "fast-short-step", "weighted", "default"
    often = "control_period_ms=40"
    steps = {n: [f"tracking_mpc.horizon_steps={n}", often] for n in (5, 8, 12, 20, 30, 40, 60, 100)}
    lengths = {2.0 / n: [f"tracking_mpc.horizon_steps={n}", f"tracking_mpc.step_length_s={2.0 / n}", often] for n in (100, 80, 50, 40, 25, 20, 10)}
    laterals = {w: [f"tracking_mpc.weight_lateral={w}", often] for w in (0.01, 0.03, 0.1, 0.3, 1, 3, 10)}
    frictions = {f: [f"plant_options.friction_scale={f}", often] for f in (0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1, 1.1, 1.3)}
    shares = {g: [f"tracking_mpc.grip_share={g}", "plant_options.friction_scale=0.7", often] for g in (0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9)}
    cubic_steps = {n: [f"cubic_mpc.horizon_steps={n}"] for n in (5, 7, 10, 20, 50, 100)}
    cubic_lengths = {dt: [f"cubic_mpc.step_length_s={dt}"] for dt in (0.005, 0.01, 0.025, 0.05, 0.1, 0.2)}
    throttles = {w: [f"cubic_mpc.weight_throttle={w}"] for w in (160, 80, 64, 48, 32)}
    road_car = {"car": "road-car"}
    pages = {
        "horizon.md": {
            "own_steps": sweep_table(runs, own, "N", steps),
            "steps": sweep_table(runs, weighted, "N", values("horizon_steps", (5, 7, 10, 20, 50, 100)), mph=80),
            "steps_measured": sweep_table(runs, "measured-latency", "N", values("horizon_steps", (5, 7, 10, 20, 50))),
        },
        "step_length.md": {
            "own_length": sweep_table(runs, own, "dt [s]", lengths),
            "length": sweep_table(runs, fast, "dt [s]", values("step_length_s", (0.005, 0.01, 0.025, 0.05, 0.1, 0.2))),
            "preview": sweep_table(runs, fast, "N, dt [s]", steps_and_lengths([(125, 0.005), (62, 0.01), (25, 0.025), (12, 0.05), (6, 0.1)])),
            "higher": sweep_table(runs, "measured-latency", "N, dt [s]", steps_and_lengths([(20, 0.1), (10, 0.2), (10, 0.5)]), mph=60),
        },
        "weights.md": {
            "own_lateral": sweep_table(runs, own, "weight_lateral", laterals),
            "knob": sweep_table(runs, fast, "w_a", values("weight_throttle", (160, 80, 64, 48, 32))),
            "speed": sweep_table(runs, weighted, "w_v", values("weight_speed", (0.02, 0.05, 0.1, 0.5, 1)), mph=60),
            "product": sweep_table(runs, "delay-in-model", "w_vδ", values("weight_speed_steer", (0, 10, 30, 100, 300))),
            "unit": sweep_table(runs, weighted, "`speed_in_mph`", values("speed_in_mph", ("false", "true")), mph=40),
        },
        "friction.md": {
            "friction_udacity": sweep_table(runs, own, "grip of the road", frictions),
            "friction_road_car": sweep_table(runs, own, "grip of the road", frictions, **road_car),
            "grip_share": sweep_table(runs, own, "grip_share", shares, **road_car),
        },
    }
    for page, tables in pages.items():
        for marker, table in tables.items():
            write(page, marker, table)
    figures = ROOT / "docs/figures"
    draw_sweeps(runs, figures / "horizon.svg", "steps of the horizon, N",
                [("default", own, steps, {}), ("weighted, 80 mph", weighted, cubic_steps, {"mph": 80})], logarithmic=True)
    draw_sweeps(runs, figures / "step_length.svg", "step length [s]",
                [("default, N dt = 2 s", own, lengths, {}), ("fast-short-step, N = 25", fast, cubic_lengths, {})], logarithmic=True)
    draw_sweeps(runs, figures / "weights.svg", "weight",
                [("default, weight_lateral", own, laterals, {}), ("fast-short-step, weight_throttle", fast, throttles, {})], logarithmic=True)
    draw_sweeps(runs, figures / "friction.svg", "grip of the road over that of the model",
                [("udacity", own, frictions, {}), ("road-car", own, frictions, road_car),
                 ("road-car, road 0.7, over grip_share", own, shares, road_car)])


def main():
    if len(sys.argv) > 1 and sys.argv[1] in ("-h", "--help"):
        print(__doc__)
        return 0
    runs = Runs(sys.argv[1] if len(sys.argv) > 1 else ROOT / "build/release/apps/chicane/chicane")
    write("problem.md", "presets", preset_table(runs))
    write("latency.md", "latency", latency_table(runs, latency_commands()))
    write("latency.md", "fast", latency_table(runs, fast_commands()))
    write("latency.md", "cure", cure_table(runs))
    draw_latency(runs, ROOT / "docs/figures/latency.svg")
    effects(runs)
    return 0


if __name__ == "__main__":
    sys.exit(main())
