# SPDX-License-Identifier: MIT
"""What the program does for Python: roads, cars from logs, leagues."""
import os
import tempfile
import unittest
from pathlib import Path
from unittest import mock

import numpy as np

import chicane as ch

MAP = Path(__file__).resolve().parents[2] / "tests/data/maps/clover.yaml"


class Program(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def file(self, name):
        return str(Path(self.folder.name) / name)

    def test_imports_a_road_with_its_remarks(self):
        angle = np.linspace(0, 2 * np.pi, 60, endpoint=False)
        np.savetxt(self.file("ring.csv"), 40 * np.column_stack([np.cos(angle), np.sin(angle)]), delimiter=",", header="x_m,y_m")
        road = ch.road(self.file("ring.csv"), self.file("road.csv"), width_m=8)
        self.assertTrue(road.numbers["is_closed"])
        self.assertAlmostEqual(road.numbers["length_m"], 80 * np.pi, delta=0.5)
        self.assertTrue(any("width" in remark for remark in road.remarks), road.remarks)
        self.assertEqual(road.file, self.file("road.csv"))
        run = ch.drive(road, laps=0, settings={"time_limit_s": 1})
        self.assertGreater(len(run.road["centre"]), 100)

    def test_refuses_in_the_words_of_the_program(self):
        Path(self.file("bad.csv")).write_text("1,2\n3,4\n", encoding="utf-8")
        for call, message in ((lambda: ch.road(self.file("bad.csv")), "bad.csv: "), (lambda: ch.road("no.yaml"), "no.yaml"),
                              (lambda: ch.road(MAP, width_m=1000), "--width-m"), (lambda: ch.road(MAP, colour="red"), "--colour"),
                              (lambda: ch.identify(self.file("bad.csv")), "bad.csv")):
            with self.subTest(message), self.assertRaisesRegex(ValueError, message):
                call()
        with mock.patch.dict(os.environ, {"CHICANE_PROGRAM": self.file("none")}), self.assertRaises(RuntimeError):
            ch.road(MAP)

    def test_identifies_a_car(self):
        ch.drive("hairpins", car="road-car", laps=1, record=self.file("run.mcap"), frames=False)
        found = ch.identify(self.file("run.mcap"), self.file("mine.yaml"), car="road-car", budget_s=2)
        delay = next(each for each in found["estimates"] if each["key"] == "latency_ms")
        self.assertLess(delay["low"], delay["value"])
        self.assertTrue(ch.drive("oval", car=self.file("mine.yaml"), laps=1, frames=False)["completed"])

    def test_compares_controllers(self):
        league = {"name": "two", "settings": {"laps": 1}, "search": {"speed_mps": {"from": 8, "to": 10}}, "tracks": ["oval"], "cars": ["udacity"],
                  "entries": {"pid": {"preset": "pid"}, "stanley": {"preset": "stanley"}}}
        table = ch.league(league, no_cache=True, jobs=1)
        self.assertEqual(len(table), 2)
        self.assertTrue(np.isfinite(table.select_dtypes("number").to_numpy(float)).any())


if __name__ == "__main__":
    unittest.main()
