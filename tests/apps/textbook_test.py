# SPDX-License-Identifier: MIT
"""The two textbook programs of examples/ drive the original's lake at 40 and 60 mph: `textbook_test.py PROGRAM CHICANE`.

Laps are driven in virtual time: this test is the simulator that both talk to, and answers act 100 ms after telemetry. `chicane simulate`
drives both in real time, too: for 12 s at 60 mph, with CHICANE_SLOW_TESTS for two laps at each speed."""
import json
import math
import os
import socket
import subprocess
import sys
import time
import unittest
from pathlib import Path

import chicane as ch
from edge_sockets import WebSocket

CHICANE = sys.argv.pop(2)
TEXTBOOK = sys.argv.pop(1)
EXAMPLES = Path(__file__).resolve().parents[2] / "examples"
PROGRAMS = {"C++": [TEXTBOOK], "Python": [sys.executable, str(EXAMPLES / "textbook_mpc.py")]}
MOST_LINES = {"00_textbook_mpc.cpp": 200, "textbook_mpc.py": 120}
MPS_PER_MPH = 0.44704


class Program:
    """One of the two on a free port, until the end of the block."""

    def __init__(self, name, mph, sleep_ms):
        self.name = name
        with socket.create_server(("127.0.0.1", 0)) as free:
            self.port = free.getsockname()[1]
        self.process = subprocess.Popen([*PROGRAMS[name], str(self.port), str(mph), str(sleep_ms)])

    def connect(self):
        for _ in range(300):
            try:
                return WebSocket(self.port)
            except ConnectionRefusedError:
                time.sleep(0.1)
        raise AssertionError("the program does not listen")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.kill()
        self.process.wait()


class Wire(ch.Controller):
    """Asks a program over its socket, as the simulator does."""

    def __init__(self, simulator):
        self.simulator = simulator
        self.least_points = 100

    def step(self, seen):
        car = {"ptsx": list(seen.waypoints[:, 0]), "ptsy": list(seen.waypoints[:, 1]), "psi": seen.yaw % (2 * math.pi), "x": seen.x, "y": seen.y,
               "steering_angle": -seen.steer, "throttle": max(0.0, seen.throttle), "speed": seen.speed / MPS_PER_MPH}
        self.simulator.send("42" + json.dumps(["telemetry", car]))
        event, answer = json.loads(self.simulator.receive()[2:])
        assert event == "steer" and len(answer["mpc_x"]) == len(answer["mpc_y"]) and len(answer["next_x"]) == len(answer["next_y"])
        self.least_points = min(self.least_points, len(answer["mpc_x"]), len(answer["next_x"]))
        return -answer["steering_angle"] * math.radians(25), answer["throttle"]


class Textbook(unittest.TestCase):
    def test_both_are_as_short_as_a_textbook(self):
        for name, most in MOST_LINES.items():
            self.assertLessEqual(len((EXAMPLES / name).read_text(encoding="utf-8").splitlines()), most, name)

    def test_the_original_s_lake_at_40_and_60_mph_in_virtual_time(self):
        laps = {}
        for name in PROGRAMS:
            for mph, slowest_s in ((40, 70), (60, 47)):
                with self.subTest(program=name, mph=mph), Program(name, mph, 0) as program, program.connect() as simulator:
                    wire = Wire(simulator)
                    run = ch.drive("original-lake", controller=wire, laps=2, latency_ms=100, settings={"control_period_ms": 120, "guard.mode": "off"})
                    self.assertEqual((run.error, run["completed"], run["off_track_events"]), (None, True, 0))
                    self.assertGreaterEqual(wire.least_points, 10)
                    laps[name, mph] = [lap["lap_time_s"] for lap in run.laps]
                    edge = min(lap["min_edge_distance_m"] for lap in run.laps)
                    print(f"{name}, {mph} mph: {laps[name, mph][0]:.2f} s, {laps[name, mph][1]:.2f} s, tyre to edge {edge:.2f} m")
                    self.assertLess(laps[name, mph][1], slowest_s)
                    self.assertGreater(edge, 1.0)
        for mph in (40, 60):
            self.assertAlmostEqual(laps["C++", mph][1], laps["Python", mph][1], delta=0.05, msg="twins drive alike")

    def test_both_drive_under_chicane_simulate_in_real_time(self):
        is_whole = "CHICANE_SLOW_TESTS" in os.environ
        for mph in (40, 60) if is_whole else (60,):
            with Program("C++", mph, 100) as ours, Program("Python", mph, 100) as twin:
                for name, program, run in [(program.name, program, simulate(program, is_whole)) for program in (ours, twin)]:
                    with self.subTest(program=name, mph=mph):
                        report = json.loads(run.communicate()[0])
                        print(f"{name}, {mph} mph, real time: {[round(lap['lap_time_s'], 2) for lap in report['laps']]}")
                        self.assertEqual((report["laps_completed"], report["off_track_events"]), (2 if is_whole else 0, 0))
                        self.assertGreater(report["total"]["top_speed_mph"], 20)


def simulate(program, is_whole):
    """`chicane simulate`, started: two laps, or 12 s of the first one."""
    program.connect().close()
    words = ["--laps", "2"] if is_whole else ["--laps", "0", "--set", "time_limit_s=12"]
    address = f"ws://127.0.0.1:{program.port}/socket.io/?EIO=4&transport=websocket"
    return subprocess.Popen([CHICANE, "simulate", "--connect", address, "--track", "original-lake", "--json", *words], stdout=subprocess.PIPE, text=True)


if __name__ == "__main__":
    unittest.main()
