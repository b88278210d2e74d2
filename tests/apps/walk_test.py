# SPDX-License-Identifier: MIT
"""The walk of docs/tracks.md as a team takes it, from a map and a bag to a race lap: `walk_test.py PROGRAM`.

The team's cars (tests/apps/walk) are like no shipped one. A simulation of them drives, and of that only odometry and commands are kept,
as a bag of ROS 2, and the map is drawn here. The commands are those of the page, word for word.
"""
import json
import os
import re
import shlex
import struct
import subprocess
import sys
import tempfile
import unittest
import zlib
from pathlib import Path

from program import ROOT, InFolder, run

HERE = ROOT / "tests/apps"
EDGE_M = 0.02  # by which a car that is raced by a model found from a bag may leave its road
PAGE = ROOT / "docs/tracks.md"
MODEL = {"car": "team-1-10", "start": "f1tenth", "cell": 0.05, "width": 1.9, "laps": "3", "grip_share": "1",
         "corners": [(0, 0), (5, 0), (9, 2), (9, 6), (6, 8), (3, 6.2), (0, 6.2), (-3, 8), (-6, 6), (-6, 2), (-3, 0)],
         "noise": ("--position-noise-m", "0.005", "--heading-noise-deg", "0.2", "--speed-noise-mps", "0.02")}
FULL = {"car": "team-coupe", "start": "road-car", "cell": 0.25, "width": 9.0, "laps": "2", "grip_share": "1",
        "corners": [(0, 0), (55, 0), (85, 18), (70, 45), (95, 70), (70, 95), (30, 80), (5, 95), (-35, 85), (-45, 45), (-25, 5)],
        "noise": ("--position-noise-m", "0.03", "--heading-noise-deg", "0.2", "--speed-noise-mps", "0.05")}


def smooth(corners, parts=60):
    """Closed Catmull-Rom line through the corners."""
    line = []
    for i in range(len(corners)):
        a, b, c, d = (corners[(i + k) % len(corners)] for k in (-1, 0, 1, 2))
        for n in range(parts):
            t = n / parts
            line.append(tuple(0.5 * (2 * b[k] + (c[k] - a[k]) * t + (2 * a[k] - 5 * b[k] + 4 * c[k] - d[k]) * t * t +
                                     (3 * b[k] - a[k] - 3 * c[k] + d[k]) * t**3) for k in (0, 1)))
    return line


def draw_map(folder, road):
    """map.yaml and map.png as map_server keeps them: free within half the width of the line, walls around, the rest unknown."""
    cell, half = road["cell"], 0.5 * road["width"]
    line = smooth(road["corners"])
    wall = half + 2.5 * cell
    low = [min(p[k] for p in line) - half - 10 * cell for k in (0, 1)]
    columns, rows = (int((max(p[k] for p in line) + half + 10 * cell - low[k]) / cell) for k in (0, 1))
    image = [bytearray([205]) * columns for _ in range(rows)]
    for reach, shade in ((wall, 0), (half, 254)):
        for x, y in line:
            for row in range(int((y - reach - low[1]) / cell), int((y + reach - low[1]) / cell) + 1):
                rest = reach**2 - (low[1] + (row + 0.5) * cell - y)**2
                if rest <= 0.0:
                    continue
                first, last = (int((x + side * rest**0.5 - low[0]) / cell) for side in (-1, 1))
                image[rows - 1 - row][first:last] = bytes([shade]) * (last - first)

    def chunk(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))

    (folder / "map.png").write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", columns, rows, 8, 0, 0, 0, 0)) +
                                     chunk(b"IDAT", zlib.compress(b"".join(b"\0" + bytes(row) for row in image))) + chunk(b"IEND", b""))
    (folder / "map.yaml").write_text(f"image: map.png\nresolution: {cell}\norigin: [{low[0]:.3f}, {low[1]:.3f}, 0.0]\nnegate: 0\n"
                                     "occupied_thresh: 0.65\nfree_thresh: 0.196\n")


def make_bag(*words):
    done = subprocess.run([sys.executable, "-B", ROOT / "tools/make_bag.py", *map(str, words)], capture_output=True, text=True, timeout=120)
    if done.returncode != 0:
        raise AssertionError(done.stderr)


def record_bag(folder, road, *more):
    """The team drives its car, and keeps odometry and commands."""
    with tempfile.TemporaryDirectory(suffix=f".{os.getpid()}") as away:
        recording = Path(away) / "run.mcap"
        code, out, err = run("drive", "--fast", "--car", HERE / "walk" / f"{road['car']}.yaml", "--track", "map.yaml", "--laps", road["laps"],
                             "--set", "tracking_mpc.grip_share=" + road["grip_share"], "--record", recording, "--json", *more, cwd=folder)
        if code not in (0, 1):
            raise AssertionError(err)
        make_bag(recording, folder / "bag", *road["noise"])
        return json.loads(out)


def commands_of_the_page():
    section = PAGE.read_text().split("## From a map and a bag to a race lap", 1)[1]
    return [shlex.split(line)[1:] for line in re.findall(r"^    (chicane .*)$", section.split("\n\n", 2)[1], re.M)]


def settings_of(car):
    """--set words for the model that a car file has."""
    words, group = [], ""
    for line in car.read_text().splitlines():
        line = line.split("#")[0].rstrip()
        key, _, value = line.strip().partition(": ")
        if line.endswith(":") and not line.startswith(" "):
            group = line[:-1]
        elif line.startswith("  ") and group == "vehicle" and key != "name":
            words += ["--set", f"vehicle.{key}={value}"]
        elif key == "friction_low":
            words += ["--set", f"{key}={value}"]
    return words


class Walk(InFolder):
    def race(self, *words):
        code, out, err = run("drive", "--fast", "--laps", "2", "--preset", "race", "--json", *words, cwd=self.at)
        self.assertIn(code, (0, 1), err)
        result = json.loads(out)
        edge = min((lap["min_edge_distance_m"] for lap in result["laps"]), default=-1.0)
        return len(result["laps"]) == 2 and edge > -EDGE_M, result["laps"][-1]["lap_time_s"] if result["laps"] else None

    def walk(self, road):
        draw_map(self.at, road)
        record_bag(self.at, road)
        before = {each.name for each in self.at.iterdir()}
        self.assertEqual(before, {"map.yaml", "map.png", "bag"})
        commands = commands_of_the_page()
        self.assertEqual(len(commands), 5)
        for words in commands[:4]:
            with self.subTest(" ".join(words)):
                code, out, err = run(*words, cwd=self.at)
                self.assertEqual(code, 0, out + err)
        self.assertIn("2 of 2 laps, completed, all tyres on the road", out)
        self.assertIn("friction_low: the race is planned with a friction of", err)
        page = (self.at / "mine.html").read_text()
        for words in ("chicane drive --car mine.yaml --preset race", "Predicted against measured", "Correlations", "Slip covered"):
            self.assertIn(words, page)
        self.assertEqual(commands[4][-2:], ["--preset", "race"])
        # The team's own car, of which the program has seen a bag alone, driven by what was found.
        its_own = ("--track", "hall.csv", "--car", HERE / "walk" / f"{road['car']}.yaml")
        is_clean, lap = self.race(*its_own, *settings_of(self.at / "mine.yaml"))
        knows, informed = self.race(*its_own)
        print(f"{road['car']}: second lap {lap} s by the car found, {informed} s by the true one", file=sys.stderr)
        self.assertTrue(is_clean and knows)
        self.assertLess(lap, 1.15 * informed)  # a bag tells nothing of the pedal: drive and brakes are those of a shelf car

    def test_a_model_car(self):
        self.walk(MODEL)

    @unittest.skipUnless(os.environ.get("CHICANE_SLOW_TESTS"), "takes half a minute: ./test.sh --all")
    def test_a_car_in_full_size(self):
        self.walk(FULL)

    @unittest.skipUnless(os.environ.get("CHICANE_SLOW_TESTS"), "fits three logs: ./test.sh --all")
    def test_a_recording_and_bags_of_it_tell_the_same(self):
        recording = self.at / "run.mcap"
        code, _, err = run("drive", "--fast", "--car", "road-car", "--track", "hairpins", "--laps", "1", "--record", recording, cwd=self.at)
        self.assertEqual(code, 0, err)
        make_bag(recording, self.at / "bag")
        make_bag(recording, self.at / "older", "--storage", "sqlite3")
        found = []
        for log in ("run.mcap", "bag", "older"):
            code, out, err = run("identify", log, "--car", "road-car", "--hold-out", "0.4", "--json", cwd=self.at)
            self.assertEqual(code, 0, err)
            found.append({each["key"]: each for each in json.loads(out)["estimates"]})
        self.assertEqual(found[1], found[2])
        for key in ("latency_ms", "steer_lag_ms", "steer_offset_deg", "wheelbase_m", "cornering_front", "cornering_rear"):
            with self.subTest(key):  # a bag has no pedal, and its place is the rear axle's: less is known
                self.assertLess(found[1][key]["low"], found[0][key]["high"])
                self.assertLess(found[0][key]["low"], found[1][key]["high"])
        self.assertAlmostEqual(found[0]["wheelbase_m"]["value"], 2.7, delta=0.1)
        self.assertAlmostEqual(found[1]["wheelbase_m"]["value"], 2.7, delta=0.15)

    def test_a_log_of_straight_driving_is_no_car_to_race(self):
        rows = [f"{0.05 * i:.2f},{20 * 0.05 * i:.3f},0,0,20,0,0.1" for i in range(800)]
        (self.at / "log.csv").write_text("time,x,y,psi,speed,steer,throttle\n" + "\n".join(rows) + "\n")
        code, out, err = run("identify", "log.csv", "--car", "road-car", "-o", "mine.yaml", cwd=self.at)
        self.assertEqual(code, 0, err)
        self.assertIn("grip is not known, and race refuses", " ".join(out.split()))
        self.assertNotIn("--preset race", out)
        self.assertIn("\nfriction_low: 0 ", (self.at / "mine.yaml").read_text())
        code, out, err = run("drive", "--fast", "--preset", "race", "--car", "mine.yaml", cwd=self.at)
        self.assertEqual((code, out), (2, ""))
        self.assertRegex(err, r"^mine\.yaml:\d+: friction_low: got 0, .* \(--set friction_low=NUMBER\)\n$")
        code, out, err = run("drive", "--fast", "--preset", "race", "--car", "mine.yaml", "--track", "oval", "--laps", "1",
                             "--set", "friction_low=0.7", cwd=self.at)
        self.assertEqual(code, 0, err)
        self.assertIn("planned with a friction of 0.7", err)


if __name__ == "__main__":
    unittest.main()
