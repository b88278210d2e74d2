#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Drives `chicane serve` by `chicane simulate` in real time, over a socket, on a busy machine: presets, tracks, and how often.

    tools/wire_runs.py PROGRAM --laps 1 --runs 20 -o runs.jsonl --table   # goes on where a file ends; prints the table
    tools/wire_runs.py PROGRAM --for-s 25 --check                         # exit code 1 where the guard intervened, a tyre left the
                                                                          # road, a lap is missing, or the car hardly moved
    tools/wire_runs.py -o runs.jsonl --table                              # the table of a file

Beside the runs --load processes for each core compute without end, at the same priority. Interventions are control steps whose command
is not the controller's, those with less drive apart; stops are braking by the car's side, which got no command in time. A run begins at rest.
"""
import argparse
import concurrent.futures
import json
import os
import re
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

PRESETS = ["default", "measured-latency", "fast-short-step", "sixty-mph", "weighted", "delay-in-model"]
TRACKS = ["lakeside", "original-lake"]
MOVES_MPS = 8.0  # slower in the mean: the car hardly moves
NOTICE = re.compile(r"^ *\d+\.\d s: |the car is stopped|commands again|the car stands|no answer for")
# Ends with the program that started it, also where that is killed.
BUSY = "import os\nparent = os.getppid()\nwhile os.getppid() == parent:\n  for _ in range(1000000): pass"


class Load:
    """Processes that keep the machine busy."""

    def __init__(self, per_core):
        self.count = round(per_core * os.cpu_count())

    def __enter__(self):
        self.processes = [subprocess.Popen([sys.executable, "-c", BUSY]) for _ in range(self.count)]

    def __exit__(self, *_):
        for process in self.processes:
            process.kill()
            process.wait()


class Server:
    """`chicane serve` on a free port."""

    def __init__(self, program, words):
        self.said = tempfile.NamedTemporaryFile("w+")
        self.process = subprocess.Popen([program, "serve", "--port", "0", "--json", *words], stdout=subprocess.PIPE, stderr=self.said, text=True)
        self.port = None
        try:
            self.port = self.find_port()
        except Exception:
            self.end()
            raise

    def find_port(self):
        end = time.monotonic() + 120
        while time.monotonic() < end and self.process.poll() is None:
            found = re.search(r"port (\d+)", self.text())
            if found:
                return int(found[1])
            time.sleep(0.05)
        raise RuntimeError(f"no server: {self.text()}")

    def text(self):
        return Path(self.said.name).read_text(errors="replace")

    def end(self):
        """Its report, and what it said."""
        self.process.send_signal(signal.SIGINT)
        out, _ = self.process.communicate(timeout=120)
        said = self.text()
        self.said.close()
        return out, said


def settings(options, preset):
    return ["--preset", preset, *(word for setting in options.set for word in ("--set", setting))]


def drive(options, preset, track, run):
    """One run: what both ends report of it."""
    known = ["--track", track] if options.known_road else []
    server = Server(options.program, settings(options, preset) + known)
    duration = ["--laps", str(options.laps)] if options.laps else ["--laps", "1", "--set", f"time_limit_s={options.for_s:g}"]
    try:
        client = subprocess.run([options.program, "simulate", "--connect", f"ws://127.0.0.1:{server.port}", "--track", track, "--json",
                                 "--seed", str(run), *duration], capture_output=True, text=True, timeout=1200)
    finally:
        out, said = server.end()
    if client.returncode not in (0, 1):
        raise RuntimeError(client.stderr)
    seen, served = json.loads(client.stdout), json.loads(out)
    answer = seen["step_time_us"]
    return {"preset": preset, "track": track, "run": run, "laps_wanted": options.laps, "laps": [round(lap["lap_time_s"], 2) for lap in seen["laps"]],
            "guard": served["guard"]["mode"], "load": options.load, "cores": os.cpu_count(), "at_once": options.at_once,
            "interventions": served["fallbacks"], "stops": client.stderr.count("no command in time: the car is stopped"), "guard_reasons": served["guard_reasons"], "gate_interventions": served["gate_interventions"],
            "off_track_events": seen["off_track_events"], "duration_s": round(seen["total"]["lap_time_s"], 2),
            "mean_speed_mps": round(seen["total"]["mean_speed_mps"], 2), "min_edge_distance_m": round(seen["total"]["min_edge_distance_m"], 2),
            "answer_ms": [round(1e-3 * answer["p50"]), round(1e-3 * answer["max"])],
            "end_reason": seen["end_reason"], "notices": [line for line in (said + client.stderr).splitlines() if NOTICE.search(line)]}


def faults_of(run):
    """What --check rejects; empty: nothing."""
    faults = []
    if run["interventions"]:
        reasons = ", ".join(f"{name} {count}" for name, count in run["guard_reasons"].items())
        faults.append(f"{run['interventions']} interventions ({reasons})")
    if run["stops"]:
        faults.append(f"{run['stops']} stops without a command in time")
    if run["off_track_events"]:
        faults.append(f"a tyre left the road {run['off_track_events']} times")
    if len(run["laps"]) < run["laps_wanted"]:
        faults.append(f"{len(run['laps'])} of {run['laps_wanted']} laps: {run['end_reason']}")
    if run["mean_speed_mps"] < MOVES_MPS:
        faults.append(f"{run['mean_speed_mps']} m/s in the mean")
    return faults


def line_of(run):
    laps = ", ".join(f"{lap:.2f} s" for lap in run["laps"]) or f"{run['mean_speed_mps']} m/s in the mean of {run['duration_s']} s"
    return f"{run['preset']}, {run['track']}, run {run['run']}: {laps}; {'; '.join(faults_of(run)) or 'clean'}"


def kept(file):
    return [json.loads(line) for line in file.read_text().splitlines()] if file and file.exists() else []


def drive_all(options):
    """The runs that a file does not have yet, some at once."""
    done = kept(options.output)
    known = {(run["preset"], run["track"], run["run"]) for run in done}
    wanted = [(preset, track, run) for run in range(1, options.runs + 1) for preset in options.presets for track in options.tracks]
    with Load(options.load), concurrent.futures.ThreadPoolExecutor(options.at_once) as pool:
        futures = [pool.submit(drive, options, *case) for case in wanted if case not in known]
        for future in concurrent.futures.as_completed(futures):
            run = future.result()
            done.append(run)
            print(line_of(run), file=sys.stderr, flush=True)
            if options.output:
                with options.output.open("a") as file:
                    file.write(json.dumps(run) + "\n")
    return done


def table(runs):
    """A row for each preset and track."""
    lines = ["| preset | track | runs | laps | lap [s] | answers after [ms] | interventions | less drive | stops | tyre off the road | tyre to edge, least [m] |",
             "|---|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|"]
    for preset, track in dict.fromkeys((run["preset"], run["track"]) for run in sorted(runs, key=lambda run: (PRESETS + [run["preset"]]).index(run["preset"]))):
        these = [run for run in runs if (run["preset"], run["track"]) == (preset, track)]
        laps = [lap for run in these for lap in run["laps"]]
        answers = [run["answer_ms"] for run in these]
        lines.append(f"| `{preset}` | {track} | {len(these)} | {len(laps)} | {f'{min(laps):.2f} to {max(laps):.2f}' if laps else 'none'} | "
                     f"{min(a[0] for a in answers)} to {max(a[1] for a in answers)} | {sum(run['interventions'] for run in these)} | "
                     f"{sum(run['guard_reasons'].get('too_fast_for_silence', 0) for run in these)} | "
                     f"{sum(run['stops'] for run in these)} | {sum(run['off_track_events'] for run in these)} | {min(run['min_edge_distance_m'] for run in these):.2f} |")
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", nargs="?", help="chicane; none: nothing is driven")
    parser.add_argument("--presets", type=lambda text: text.split(","), default=PRESETS)
    parser.add_argument("--tracks", type=lambda text: text.split(","), default=TRACKS)
    parser.add_argument("--runs", type=int, default=1, help="of each preset on each track")
    parser.add_argument("--laps", type=int, default=0, help="of a run")
    parser.add_argument("--for-s", type=float, default=25.0, help="length of a run without --laps")
    parser.add_argument("--at-once", type=int, default=12, help="runs at the same time")
    parser.add_argument("--load", type=float, default=2.0, help="busy processes for each core")
    parser.add_argument("--known-road", action="store_true", help="the server has the track; else it sees waypoints only")
    parser.add_argument("--set", action="append", default=[], help="KEY=VALUE of the server")
    parser.add_argument("-o", "--output", type=Path, help="results, a line each; a file that is there is completed")
    parser.add_argument("--table", action="store_true", help="prints Markdown")
    parser.add_argument("--check", action="store_true", help="exit code 1 where a run is not clean")
    options = parser.parse_args()
    runs = drive_all(options) if options.program else kept(options.output)
    if options.table:
        print(table(runs))
    sys.exit(1 if options.check and any(faults_of(run) for run in runs) else 0)


if __name__ == "__main__":
    main()
