#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Kills or stops `chicane serve` at random moments while `chicane simulate` drives, and prints where the car came to
stand. In real time: some 25 s for each moment. Exits with 1 when a car left the road or drove on."""
import argparse
import concurrent.futures
import json
import random
import re
import signal
import socket
import subprocess
import sys
import threading
import time


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class Simulator:
    """`chicane simulate`, and the lines it has logged."""

    def __init__(self, arguments, port):
        command = [arguments.program, "simulate", "--json", "--laps", "0", "--set", "time_limit_s=1000000"]
        command += ["--connect", f"ws://127.0.0.1:{port}", "--set", f"guard.receiver={arguments.receiver}"]
        self.process = subprocess.Popen(command + arguments.simulate.split(), text=True, stdout=subprocess.PIPE,
                                        stderr=subprocess.PIPE)
        self.lines = []
        threading.Thread(target=self.listen, daemon=True).start()

    def listen(self):
        for line in self.process.stderr:
            self.lines.append(line.strip())

    def wait_for(self, pattern, since, patience):
        end = time.monotonic() + patience
        while time.monotonic() < end and self.process.poll() is None:
            for line in self.lines[since:]:
                if found := re.search(pattern, line):
                    return found
            time.sleep(0.05)
        return None

    def finish(self):
        self.process.send_signal(signal.SIGINT)
        return json.loads(self.process.stdout.read())


def serve(arguments, port):
    command = [arguments.program, "serve", "--port", str(port)] + arguments.serve.split()
    return subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def outcome(simulator, since):
    stopped = simulator.wait_for(r"stopped from ([\d.]+) m/s", since, 10)
    if not stopped:
        return None, None
    stands = simulator.wait_for(r"stands, its outermost wheel ([\d.]+) m (inside|beyond)", since, 15)
    if not stands:
        return float(stopped[1]), None
    return float(stopped[1]), float(stands[1]) * (1 if stands[2] == "inside" else -1)


def drive(arguments, number, moments):
    """One simulator for some moments. Its rows: what was done, when, speed then, edge where the car stood."""
    chance = random.Random(arguments.seed * 1000 + number)
    port = free_port()
    simulator = Simulator(arguments, port)
    controller = serve(arguments, port)
    rows = []
    for _ in range(moments):
        pause = chance.uniform(arguments.least, arguments.most)
        time.sleep(pause)
        if simulator.process.poll() is not None:
            break
        since = len(simulator.lines)
        if arguments.stop and chance.random() < arguments.stop:
            silence = chance.uniform(0.5, 5.0)
            controller.send_signal(signal.SIGSTOP)
            time.sleep(silence)
            controller.send_signal(signal.SIGCONT)
            found = simulator.wait_for(r"stopped from ([\d.]+) m/s", since, 0.5)
            rows.append((f"SIGSTOP {silence:.1f} s", pause, float(found[1]) if found else None, None))
            continue
        controller.kill()
        controller.wait()
        rows.append(("kill -9", pause, *outcome(simulator, since)))
        controller = serve(arguments, port)
    time.sleep(8)
    run = simulator.finish()
    controller.kill()
    controller.wait()
    return rows, run, simulator.lines


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", default="build/release/apps/chicane/chicane")
    parser.add_argument("--moments", type=int, default=24)
    parser.add_argument("--each", type=int, default=6, help="moments with one simulator")
    parser.add_argument("--jobs", type=int, default=4)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--stop", type=float, default=0.3, help="share of SIGSTOP for 0.5 to 5 s; the rest is kill -9")
    parser.add_argument("--least", type=float, default=7.0, help="seconds of driving before a moment, at least")
    parser.add_argument("--most", type=float, default=25.0)
    parser.add_argument("--receiver", default="stop-plan")
    parser.add_argument("--serve", default="", help="further arguments of serve")
    parser.add_argument("--simulate", default="", help="further arguments of simulate")
    parser.add_argument("--verbose", action="store_true", help="what the simulators logged, too")
    arguments = parser.parse_args()
    runs = -(-arguments.moments // arguments.each)
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        results = list(pool.map(lambda i: drive(arguments, i, arguments.each), range(runs)))
    off = rolling = count = 0
    for rows, run, lines in results:
        for what, pause, speed, edge in rows:
            count += 1
            rolling += what == "kill -9" and edge is None
            at = "no stop" if speed is None else f"from {speed:4.1f} m/s"
            print(f"{what:14} after {pause:4.1f} s: {at}" + ("" if edge is None else f", stands {edge:+.2f} m from the edge"))
        total = run["total"]
        off += run["off_track_events"]
        print(f"  off the road {run['off_track_events']} times, least edge {total['min_edge_distance_m']:.2f} m, "
              f"{run['laps_completed']} laps, {run['end_reason']}")
        if arguments.verbose:
            print("\n".join("    " + line for line in lines))
    print(f"{count} moments: {off} times off the road, {rolling} times no standstill seen")
    sys.exit(1 if off or rolling else 0)


if __name__ == "__main__":
    main()
