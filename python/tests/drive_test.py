# SPDX-License-Identifier: MIT
"""Runs driven from Python: the same as the program's, told in full, refused in words."""
import json
import os
import pickle
import signal
import subprocess
import tempfile
import threading
import time
import unittest
from pathlib import Path

import numpy as np
import pandas  # noqa: F401  before an interrupt comes while it is being imported

import chicane as ch

PROGRAM = os.environ["CHICANE_PROGRAM"]


class Drive(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.file = str(Path(cls.folder.name) / "run.mcap")
        cls.driven = ch.drive("oval", car="road-car", laps=1, faults=["half_grip@4+2"], record=cls.file)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_equals_the_program(self):
        told = subprocess.run(
            [PROGRAM, "drive", "--fast", "--json", "--track", "oval", "--car", "road-car", "--laps", "1", "--fault", "half_grip@4+2"],
            capture_output=True, text=True).stdout
        report = json.loads(told)
        clocks = {"step_time_us", "solve_time_us", "wall_time_s", "deadline_misses", "why_no_limit"}
        self.assertEqual({key: self.driven[key] for key in report if key not in clocks},
                         {key: value for key, value in report.items() if key not in clocks})

    def test_tells_laps_and_frames(self):
        self.assertEqual(len(self.driven.laps), 1)
        self.assertEqual(self.driven.best_lap_s, self.driven["laps"][0]["lap_time_s"])
        frames = self.driven.frames
        self.assertEqual(frames.cycles, self.driven["cycles"])
        self.assertEqual(frames["speed_mps"].dtype, np.float64)
        self.assertEqual(frames["is_off_track"].dtype, np.bool_)
        self.assertEqual({column.shape for column in frames.values()}, {(frames.cycles,)})
        self.assertAlmostEqual(frames["speed_mps"].max(), self.driven["total"]["top_speed_mps"], delta=0.5)
        self.assertEqual(set(frames) - set(ch.frame_fields()), set())
        table = frames.to_pandas()
        self.assertEqual(table.index.name, "time_s")
        self.assertEqual(len(table), frames.cycles)
        sentences = [each["sentence"] for each in self.driven.situations]
        self.assertEqual(sentences[0], "The car stands")
        self.assertTrue(any(text.startswith("Grip: ") for text in sentences), sentences)
        self.assertTrue(all(len(text.split()) <= 6 for text in sentences))
        with self.assertRaisesRegex(KeyError, "got 'speed', expected one of cycle, "):
            frames["speed"]

    def test_is_pickled_and_shown(self):
        copy = pickle.loads(pickle.dumps(self.driven))
        self.assertEqual(dict(copy), dict(self.driven))
        np.testing.assert_array_equal(copy.frames["x_m"], self.driven.frames["x_m"])
        self.assertRegex(repr(self.driven), r"<Run: road-car on oval, default: 1 laps, the best \d+\.\d{3} s, off the road \d+ times>")
        self.assertIn("<svg", self.driven._repr_html_())
        self.assertIn("lap", self.driven.table())

    def test_recording_holds_the_same_frames(self):
        recording = ch.read(self.file)
        for name, column in self.driven.frames.items():
            np.testing.assert_array_equal(recording.frames[name], column.astype(float), err_msg=name)
        self.assertEqual(recording.head["track"], "oval")
        self.assertEqual(recording.laps[0]["lap_time_s"], self.driven.best_lap_s)
        np.testing.assert_allclose(recording.road["left"], self.driven.road["left"])
        self.assertTrue(ch.verify(self.file)["is_verified"])

    def test_is_shown_in_the_dashboard(self):
        page = str(Path(self.folder.name) / "run.html")
        shown = ch.report(self.driven, page)
        self.assertEqual(shown.file, page)
        self.assertIn("run.mcap", Path(page).read_text(encoding="utf-8"))
        self.assertIn("<iframe", shown._repr_html_())

    def test_replaces_a_recording_and_nothing_else(self):
        file = Path(self.folder.name) / "again.mcap"
        for preset in ("default", "pid"):
            run = ch.drive("oval", preset=preset, laps=0, settings={"time_limit_s": 1}, record=file, frames=False)
            self.assertEqual(run["preset"], preset)
        file.write_text("not a recording", encoding="utf-8")
        with self.assertRaisesRegex(ValueError, "again.mcap: .*exists"):
            ch.drive("oval", laps=0, settings={"time_limit_s": 1}, record=file)
        self.assertEqual(file.read_text(encoding="utf-8"), "not a recording")

    def test_refuses_with_the_text_of_the_program(self):
        for arguments, message in (
                ({"settings": {"lpas": 1}}, r"lpas: got an unknown key, .*did you mean laps"),
                ({"track": "ovl"}, r"track: got \"ovl\", expected a file or one of .*did you mean oval"),
                ({"latency_ms": 900}, r"latency_ms: got 900, expected a number in \[0, 500\] ms"),
                ({"controller": "mpc"}, "controller: got mpc, expected one of tracking-mpc"),
                ({"faults": "ice"}, "got ice, expected one of"),
                ({"track": "hairpins", "car": "indy"}, "track: hairpins is not for the car indy"),
                ({"record": "/nowhere/x.mcap"}, "/nowhere/x.mcap: .*No such file")):
            with self.subTest(message), self.assertRaisesRegex(ValueError, message):
                ch.drive(**{"track": "oval", **arguments})
        with self.assertRaisesRegex(ValueError, "nowhere.mcap"):
            ch.read("nowhere.mcap")

    def test_ends_at_an_interrupt(self):
        for work in (lambda: ch.drive("lakeside", laps=1000, frames=False), lambda: ch.sweep({"seed": range(1000)}, jobs=2)):
            threading.Timer(0.2, os.kill, (os.getpid(), signal.SIGINT)).start()
            began = time.monotonic()
            with self.assertRaises(KeyboardInterrupt):
                work()
            self.assertLess(time.monotonic() - began, 30.0)

    def test_lists_what_ships(self):
        self.assertIn("lakeside", ch.tracks())
        self.assertIn("f1tenth", ch.cars())
        self.assertIn("race", ch.presets())
        self.assertIn("half_grip", ch.faults())
        self.assertEqual(ch.parameters()["latency_ms"][0], "ms")


class Limit(unittest.TestCase):
    def test_is_that_of_the_program(self):
        limit = ch.limit("oval", witness=False)
        told = subprocess.run([PROGRAM, "limit", "--track", "oval", "--json"], capture_output=True, text=True).stdout
        self.assertEqual(limit.bound_s, json.loads(told)["lap_time_s"])
        self.assertEqual(limit.line["xy_m"].shape, (len(limit.line["s_m"]), 2))
        with self.assertRaisesRegex(ValueError, "limit: got the model car f1tenth, expected one in full size"):
            ch.limit("oval", car="f1tenth")


if __name__ == "__main__":
    unittest.main()
