# SPDX-License-Identifier: MIT
"""Situations from public files and bug reports, against the program as users start it: `edge_cases_test.py PROGRAM`. Each case is one
that once ended in a wrong guess or in a message that did not help. Inputs that are not made here lie in tests/apps/edges (made up, like
files of the wild)."""
import csv
import functools
import os
import re
import signal
import sqlite3
import subprocess
import tempfile
import time
import unittest
import urllib.error
import urllib.request
from pathlib import Path

import program
from edge_sockets import Bicycle, Controller, WebSocket, steering_of, telemetry
from program import ENVIRONMENT, PROGRAM

DATA = program.ROOT / "tests/apps/edges"
run = functools.partial(program.run, cwd=DATA)
MODEL = ["--car", "f1tenth"]


class Serving:
    """`chicane serve` on a free port; `said()`: its messages so far."""

    def __init__(self, *words, address="127.0.0.1", latency_ms=0):
        self.file = tempfile.NamedTemporaryFile("w+", suffix=f".{os.getpid()}", delete=False)
        self.process = subprocess.Popen([PROGRAM, "serve", "--latency-ms", str(latency_ms), "--port", "0", "--address", address, *words],
                                        cwd=DATA, env=ENVIRONMENT, stdout=subprocess.DEVNULL, stderr=self.file)
        self.wait_for("waits for")
        self.port = int(re.search(r"port (\d+)", self.said())[1])

    def said(self):
        return Path(self.file.name).read_text(errors="replace")

    def wait_for(self, words, seconds=30):
        end = time.monotonic() + seconds
        while words not in self.said():
            if time.monotonic() > end or self.process.poll() is not None:
                raise AssertionError(f"did not say {words!r}: {self.said()}")
            time.sleep(0.02)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.send_signal(signal.SIGINT)
        self.process.wait(30)
        self.file.close()
        os.unlink(self.file.name)


def ring(rows, radius=60.0, count=40):
    from math import cos, pi, sin
    return "\n".join(rows(radius * cos(2 * pi * i / count), radius * sin(2 * pi * i / count)) for i in range(count)) + "\n"


def stadium(radius, length=6.0, step=0.1, half_width=0.55):
    """Two straights and two half circles, with widths."""
    from math import cos, pi, sin
    bend = max(8, int(pi * radius / step))
    points = [(i * step, -radius) for i in range(int(length / step))]
    points += [(length + radius * sin(pi * i / bend), -radius * cos(pi * i / bend)) for i in range(bend)]
    points += [(length - i * step, radius) for i in range(int(length / step))]
    points += [(-radius * sin(pi * i / bend), radius * cos(pi * i / bend)) for i in range(bend)]
    return "x_m,y_m,w_tr_right_m,w_tr_left_m\n" + "".join(f"{x:.4f},{y:.4f},{half_width},{half_width}\n" for x, y in points)


class Files(program.InFolder):
    def file(self, name, text):
        path = self.at / name
        path.write_text(text)
        return path

    def assert_said(self, code, file, *parts, words=()):
        """What `check` says of a file, with these parts; its warnings."""
        got, out, err = run("check", file, *words)
        self.assertEqual(got, code, f"{out}{err}")
        for part in parts:
            self.assertIn(part, err if code else out + err)
        return err

    # 7. Warnings of readers reach people, by each command and as JSON.
    def test_warnings_are_told_by_drive(self):
        code, out, err = run("drive", "--fast", "--set", "time_limit_s=0.1", "--json", "--track", "01_total_width.csv")
        self.assertEqual(code, 1, err)
        for text in (out, err):
            self.assertIn("width: of the whole road, half of it to each side", text)
        self.assertIn('"notices": [', out)

    def test_settings_without_effect_are_told(self):
        code, _, err = run("check", "--set", "pid.proportional_gain=0.1", "--preset", "default")
        self.assertEqual(code, 0, err)
        self.assertIn("pid.proportional_gain: has no effect: tracking-mpc drives, not pid", err)
        self.assertEqual(run("check", "--set", "pid.proportional_gain=0.1", "--controller", "pid")[2], "")
        scenario = self.file("run.yaml", "controller: pid\ncubic_mpc:\n  horizon_steps: 12\n")
        self.assertIn("run.yaml:3: cubic_mpc.horizon_steps: has no effect", run("check", scenario)[2])

    def test_a_wrong_key_is_completed_to_one_that_has_an_effect(self):
        for controller in ("tracking-mpc", "cubic-mpc"):
            err = run("check", "--controller", controller, "--set", "horizon_step=12")[2]
            self.assertIn(f"(did you mean {controller.replace('-', '_')}.horizon_steps?)", err)

    # 8. Guesses.
    def test_cone_maps_are_named(self):
        self.assert_said(2, "07_cones.csv", "07_cones.csv: cones: got sides that cross each other, expected a course between them")
        self.assert_said(0, "07_timestamped.csv", "stamp: unknown column, ignored")
        self.assert_said(2, self.file("cones.csv", "x,y,color\n" + ring(lambda x, y: f"{x},{y},big_orange")), "cones: got 0 of the left side and 0 of the right one, expected at least 3 of each")

    # 10. Lengths of model scale.
    def test_a_file_has_the_size_that_it_says(self):
        self.assertEqual(self.assert_said(0, "28_rect_0.7.csv", "at least 2.00 m wide", words=MODEL), "", "nothing was assumed")
        self.assert_said(2, "28_rect_0.7.csv", "a road of model size needs a model car: --car f1tenth")
        code, _, err = run("check", "--car", "f1tenth", "--track", "28_rect_0.7.csv", "--set", "track_scale=0.1")
        self.assertEqual(code, 2)
        self.assertIn("track_scale: got 0.1 with the file", err)

    def test_noise_is_assumed_in_the_roads_scale(self):
        for name in ("28_rect_0.7.csv", "28_rect_0.7_s.csv"):
            _, out, err = run("check", name, *MODEL)
            radius = float(re.search(r"tightest radius ([\d.]+) m", out + err)[1])
            self.assertAlmostEqual(radius, 0.7, delta=0.08)
        file = self.file("ring.csv", "x,y\n" + ring(lambda x, y: f"{0.1 * x},{0.1 * y}"))
        self.assert_said(0, file, "0.45 m left and 0.45 m right assumed", words=MODEL)

    def test_more_room_leaves_no_smaller_radius(self):
        for room in (3, 6, 10, 20):
            words = [*MODEL, "--set", f"tracking_mpc.assumed_half_width_m={room}"]
            for file in ("23_rect_0.6.csv", self.file("u.csv", stadium(0.6)), self.file("wide.csv", stadium(0.7, half_width=0.65))):
                self.assert_said(0, file, "ok", words=words)

    def test_a_parked_car_is_named(self):
        for file in ("22_hair_0.75.csv", self.file("tight.csv", stadium(0.65)), self.file("open.csv", stadium(0.9))):
            code, out, _ = run("drive", "--fast", "--laps", "1", *MODEL, "--set", "time_limit_s=15", "--track", file)
            drives = code == 0 or "0.0 mph" not in out
            self.assertTrue(drives or "time limit reached: the car stood for the last" in out, out)

    # 11. Nothing is no success.
    def test_bags_of_other_programs(self):
        page = self.at / "page.html"
        for words in (("report", "24_foreign.mcap", "-o", page), ("replay", "--port", "0", "24_foreign.mcap")):
            code, _, err = run(*words)
            self.assertEqual(code, 2, err)
            self.assertIn("24_foreign.mcap: got no control step, expected a recording of ours", err)
        self.assertFalse(page.exists())

    def test_bags_without_a_way(self):
        inertial = self.at / "inertial.db3"
        with sqlite3.connect(inertial) as bag:
            bag.executescript("""
                create table topics(id integer primary key, name text, type text, serialization_format text, offered_qos_profiles text);
                create table messages(id integer primary key, topic_id integer, timestamp integer, data blob);
                insert into topics values(1, '/imu', 'sensor_msgs/msg/Imu', 'cdr', '');
                insert into messages values(1, 1, 1000000000, x'0001');""")
        begun = self.at / "begun.mcap"
        begun.write_bytes((DATA / "24_foreign.mcap").read_bytes()[:300])
        page = self.at / "page.html"
        for bag, why in ((inertial, "got the topics none of nav_msgs/msg/Odometry, expected one"),
                         (begun, "got a file that was cut in its first chunk, expected a recording of ours, or a bag")):
            for words in (("report", bag, "-o", page), ("replay", "--port", "0", bag)):
                code, _, err = run(*words)
                self.assertEqual(code, 2, err)
                self.assertIn(f"{bag.name}: {why}", err)
        self.assertFalse(page.exists())

    def assert_ended_while_planning(self, how, *words):
        process = subprocess.Popen([PROGRAM, *map(str, words)], cwd=DATA, env=ENVIRONMENT, stdout=subprocess.DEVNULL,
                                   stderr=subprocess.DEVNULL, preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_IGN))
        time.sleep(0.3)
        process.send_signal(how)
        process.wait(10)
        self.assertNotEqual(process.returncode, 0)

    def test_a_run_with_a_dashboard_goes_on_until_it_is_stopped(self):
        process = subprocess.Popen([PROGRAM, "drive", "--port", "0", "--track", "oval", "--preset", "pid"], cwd=DATA, text=True, stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE, env={**ENVIRONMENT, "CHICANE_COMMAND": "./run.sh"})
        said = ""
        while "dashboard at" not in said:
            said = process.stderr.readline()
        page = re.search(r"http://\S+/", said)[0]
        with urllib.request.urlopen(f"{page}command.txt") as answer:
            self.assertEqual(answer.read(), b"./run.sh")
        process.send_signal(signal.SIGINT)
        self.assertIn("laps until stopped", process.communicate(timeout=30)[0])

    def test_a_scenario_with_laps_ends_where_nobody_watches(self):
        code, out, _ = run("drive", self.file("one_lap.yaml", "track: oval\nlaps: 1\n"), "--port", "0", "--pace", "20")
        self.assertEqual((code, out.splitlines()[-1][:11]), (0, "1 of 1 laps"))

    def test_ctrl_c_ends_planning(self):
        race = ("drive", "--fast", "--laps", "1", "--preset", "race")
        self.assert_ended_while_planning(signal.SIGINT, *race, "--track", "speedway")
        self.assert_ended_while_planning(signal.SIGINT, *race, *MODEL, "--no-cache", "--track", self.file("u.csv", stadium(0.8)))
        self.assert_ended_while_planning(signal.SIGTERM, "limit", "--no-cache", "speedway")


class Wire(unittest.TestCase):
    def answer(self, port, **values):
        with WebSocket(port) as simulator:
            simulator.send("2")
            for _ in range(12):
                simulator.send(telemetry(**values))
                answer = steering_of(simulator.receive())
        return answer

    def test_two_waypoints_are_enough(self):
        road = dict(x=0.0, y=0.0, psi=0.0, speed=30.0)
        with Serving() as server:
            answer = self.answer(server.port, ptsx=[-5.0, 10.0], ptsy=[0.0, 0.0], **road)
            self.assertGreater(answer["plan"], 0, server.said())
            self.assertGreater(self.answer(server.port, ptsx=[-5.0, 10.0, 25.0], ptsy=[0.0] * 3, **road)["plan"], 0)
            across = dict(x=-820.0, y=440.0, psi=2.2, speed=12.0)
            self.assertGreater(self.answer(server.port, ptsx=[-817.0, -826.0], ptsy=[436.0, 448.0], **across)["plan"], 0)
            self.assertGreater(self.answer(server.port, ptsx=[0.0, 0.0], ptsy=[-2.0, 40.0], x=0.3, y=0.0, psi=1.57, speed=0.0)["plan"], 0)
        code, out, _ = run("drive", "--fast", "--laps", "1", "--track", "oval", "--set", "waypoints_sent=2", "--set", "time_limit_s=12")
        self.assertNotIn("no_answer: ", out)
        self.assertIn(code, (0, 1))

    def test_a_car_put_back_to_the_start_drives_on(self):
        with open(DATA / "11_wp_stad.csv", encoding="utf-8") as file:
            road = [(float(row["x"]), float(row["y"])) for row in csv.DictReader(file)]
        with Serving(latency_ms=100) as server, WebSocket(server.port) as simulator:
            simulator.send("2")
            car = Bicycle(road)
            car.drive(simulator, lambda: car.time >= 10.0)
            self.assertGreater(car.speed, 15.0)
            car.put(0)
            car.drive(simulator, lambda: car.speed > 10.0 or car.time >= 25.0)
            self.assertGreater(car.speed, 10.0, server.said())

    def test_a_car_that_stands_is_told_once(self):
        with Serving() as server, WebSocket(server.port) as simulator:
            end = time.monotonic() + 4.0
            while time.monotonic() < end:
                simulator.send(telemetry(speed=0.0))
                simulator.receive()
                time.sleep(0.04)
            server.wait_for("Reset the simulator, or drive there by hand")
            self.assertEqual(server.said().count("Reset the simulator"), 1)

    def test_a_car_that_another_controller_lets_stand_is_told(self):
        self.assertIn("3.0 s: The car stands and should drive: the controller gives no throttle", self.simulate("rest", 4)[2])

    def test_polling_is_refused_with_the_remedy(self):
        with Serving() as server:
            for _ in range(3):
                with self.assertRaises(urllib.error.HTTPError) as refused:
                    urllib.request.urlopen(f"http://127.0.0.1:{server.port}/socket.io/?EIO=4&transport=polling", timeout=10)
                self.assertEqual(refused.exception.code, 400)
                self.assertIn('transports: ["websocket"]', refused.exception.read().decode())
            server.wait_for("refused 127.0.0.1: Socket.IO by polling is not served: use transport=websocket")
            self.assertEqual(server.said().count("polling is not served"), 1)

    def test_foreign_host_names(self):
        for words, is_let_in in (((), False), (("--allow-host", "car.local"), True)):
            with Serving(*words) as server:
                simulator = WebSocket(server.port, host="car.local")
                self.assertEqual(simulator.is_open, is_let_in, server.said())
                simulator.close()
                if not is_let_in:
                    server.wait_for("host 'car.local:", 5)
                    self.assertIn("--allow-host car.local", server.said())

    def test_the_link_leads_to_the_address(self):
        addresses = ["127.0.0.2", "127.0.0.1", "127.0.0.3"]
        if Path("/proc/net/if_inet6").exists() and Path("/proc/net/if_inet6").read_text():
            addresses.append("::1")
        for address in addresses:
            with Serving("--no-token", address=address) as server:
                link = re.search(r"dashboard at (\S+)", server.said())[1]
                asked = urllib.request.Request(link, headers={"Accept-Encoding": "gzip"})
                with urllib.request.urlopen(asked, timeout=10) as page:
                    self.assertEqual(page.status, 200)

    def simulate(self, mode, seconds=2):
        with Controller(mode) as controller:
            return run("simulate", "--connect", f"ws://127.0.0.1:{controller.port}", "--track", "oval", "--laps", "1", "--set",
                       f"time_limit_s={seconds}")

    def test_answers_in_degrees(self):
        _, out, err = self.simulate("degrees")
        self.assertIn("steering_angle: got 12.5, expected a number in [-1, 1]: clamped", err)
        self.assertIn("not degrees", err)
        self.assertIn("round trip", out)
        self.assertNotIn("control step", out)

    def test_answers_that_are_no_numbers(self):
        self.assertIn("broken answer: steering_angle: got NaN, expected a number", self.simulate("nan", 1)[2])


if __name__ == "__main__":
    unittest.main()
